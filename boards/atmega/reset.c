/* reset.c: the cause of the chip's start (DS 12.5.1), and the record of a fault before it (kept.c). */
#include "hal/reset.h"

#include "core/text.h"

#include "atmega.h"
#include "boards/shared/reset_words.h"

static hal_reset cause;
static bool known;
static atmega_fault_record fault;

/* The order matters: at power-on, other flags may be set, too, and a fault ends with a reset by the watchdog. */
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
        if (cause == HAL_RESET_POWER_ON) {
            atmega_forget(); /* the record may have survived a short power failure */
        }
    }
    return cause;
}

static const char *words_of_fault(atmega_fault_kind kind) {
    switch (kind) {
    case ATMEGA_FAULT_STRAY: return " an interrupt has no handler, PC ";
    case ATMEGA_FAULT_STACK: return " the stack reached the variables, PC ";
    case ATMEGA_FAULT_RESTART: return " restarted without a reset, PC ";
    case ATMEGA_FAULT_NONE: break;
    }
    return " unknown, PC ";
}

board_fault_when board_fault_answer(wh_text *text) {
    wh_text_add(text, words_of_fault((atmega_fault_kind)fault.kind));
    wh_text_add(text, "0x");
    wh_text_add_hex(text, fault.at, 5);
    return (board_fault_when){.ticks = fault.ticks, .state = fault.state, .faults = fault.faults};
}
