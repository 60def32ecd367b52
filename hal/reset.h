/* reset.h: the cause of the processor's start, and bytes that survive a reset. In a reset the pins float, so the drive
 * stage is off until the program enables it. */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

typedef enum hal_reset {
    HAL_RESET_POWER_ON, /* the supply came on: no data survive */
    HAL_RESET_WATCHDOG, /* the watchdog timed out and reset the processor */
    HAL_RESET_OTHER,    /* a pin, a debugger, or unknown */
    /* a fault of the program or of the crystal; the handler switched the motor off */
    HAL_RESET_FAULT,
    HAL_RESET_SUPPLY /* a dip of the processor's supply voltage */
} hal_reset;

/* Call it after hal_clock_start() (clock.h). */
hal_reset hal_reset_cause(void);

/* Writes the cause in words, for consoles. If it is a fault, the words include its kind, address, time and stage.
 * Returns the number of characters before the NUL: 1 to room - 1. */
unsigned hal_reset_words(char *words, unsigned room);

/* Stores the program's stage (any number) for the record of a later fault. It costs one store instruction. */
void hal_reset_mark(uint32_t state);

/* Maximum number of bytes that can survive a reset. */
#define HAL_REMEMBER_BYTES 32U

/* Stores bytes[count] so that they survive a reset; count <= HAL_REMEMBER_BYTES. They replace the bytes of the last
 * call, which survive if a reset interrupts this call. Do not call it from an interrupt. */
void hal_remember(const void *bytes, unsigned count);

/* Copies the bytes that survived the reset to bytes[HAL_REMEMBER_BYTES]; call it before hal_remember(). Returns their
 * number: 0 after a power-on, or if they are corrupt. */
unsigned hal_recall(void *bytes);

WH_C_END

#endif
