/* reset_words.c: why the processor starts, in words. */
#include "reset_words.h"

#include "core/packed_words.h"
#include "hal/reset.h"

static const char *words_of(hal_reset what) {
    switch (what) {
    case HAL_RESET_POWER_ON: return WH_WORDS("power on");
    case HAL_RESET_WATCHDOG: return WH_WORDS("watchdog");
    case HAL_RESET_OTHER: return WH_WORDS("other");
    case HAL_RESET_FAULT: return WH_WORDS("fault:");
    case HAL_RESET_SUPPLY: return WH_WORDS("supply");
    }
    return "";
}

unsigned hal_reset_words(char *words, unsigned room) {
    wh_text text;
    wh_text_start(&text, words, room);
    const hal_reset what = hal_reset_cause();
    wh_text_add_words(&text, words_of(what));
    if (what == HAL_RESET_FAULT) {
        const board_fault_when when = board_fault_told(&text);
        wh_text_add_words(&text, WH_WORDS(", tick "));
        wh_text_add_unsigned(&text, when.ticks);
        wh_text_add_words(&text, WH_WORDS(", state "));
        wh_text_add_unsigned(&text, when.state);
        wh_text_add_words(&text, WH_WORDS(", faults "));
        wh_text_add_unsigned(&text, when.faults);
    }
    return text.length;
}
