/* reset.c: why the chip starts (DS 12.5.1), and what was before (kept.c). */
#include "hal/reset.h"

#include "core/text.h"

#include "atmega.h"

static hal_reset cause;
static bool known;
static atmega_fault_record fault;

/* With the power all flags may be set; a fault resets by the watchdog. No flag at all: there was no reset. */
static hal_reset cause_of(uint8_t flags, bool faulted) {
    if ((flags & _BV(PORF)) != 0) {
        return HAL_RESET_POWER_ON;
    }
    if (flags == 0 || faulted) {
        return HAL_RESET_FAULT;
    }
    if ((flags & _BV(BORF)) != 0) {
        return HAL_RESET_SUPPLY;
    }
    return (flags & _BV(WDRF)) != 0 ? HAL_RESET_WATCHDOG : HAL_RESET_OTHER;
}

hal_reset hal_reset_cause(void) {
    if (!known) {
        known = true;
        const uint8_t flags = atmega_reset_flags();
        if (flags == 0) {
            atmega_keep_fault(ATMEGA_FAULT_RESTART, 0, 0);
        }
        const bool faulted = atmega_take_fault(&fault);
        cause = cause_of(flags, faulted);
    }
    return cause;
}

static const char *words_of_fault(atmega_fault_kind kind) {
    switch (kind) {
    case ATMEGA_FAULT_STRAY: return " an interrupt that nobody takes, PC ";
    case ATMEGA_FAULT_STACK: return " the stack came down to the variables, PC ";
    case ATMEGA_FAULT_RESTART: return " it began anew without a reset, PC ";
    case ATMEGA_FAULT_NONE: break;
    }
    return " unknown, PC ";
}

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
        wh_text_add(&text, words_of_fault((atmega_fault_kind)fault.kind));
        wh_text_add(&text, "0x");
        wh_text_add_hex(&text, fault.at, 5);
        wh_text_add(&text, ", tick ");
        wh_text_add_unsigned(&text, fault.ticks);
        wh_text_add(&text, ", state ");
        wh_text_add_unsigned(&text, fault.state);
        wh_text_add(&text, ", faults ");
        wh_text_add_unsigned(&text, fault.faults);
    }
    return text.length;
}
