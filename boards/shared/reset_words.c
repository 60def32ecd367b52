/* reset_words.c: the cause of the processor's start, in words. */
#include "reset_words.h"

#include "core/text.h"
#include "hal/reset.h"

static const char *words_of(hal_reset what) {
    switch (what) {
    case HAL_RESET_POWER_ON: return "power on";
    case HAL_RESET_WATCHDOG: return "watchdog";
    case HAL_RESET_OTHER: return "other";
    case HAL_RESET_FAULT: return "fault:";
    case HAL_RESET_SUPPLY: return "supply";
    }
    return "";
}

unsigned hal_reset_words(char *words, unsigned room) {
    wh_text text;
    wh_text_start(&text, words, room);
    const hal_reset what = hal_reset_cause();
    wh_text_add(&text, words_of(what));
    if (what == HAL_RESET_FAULT) {
        const board_fault_when when = board_fault_answer(&text);
        wh_text_add(&text, ", tick ");
        wh_text_add_unsigned(&text, when.ticks);
        wh_text_add(&text, ", state ");
        wh_text_add_unsigned(&text, when.state);
        wh_text_add(&text, ", faults ");
        wh_text_add_unsigned(&text, when.faults);
    }
    return text.length;
}
