/* reset.h: the cause of the processor's start, and data that survive a reset. In a reset the pins float, so the drive
 * stage is off from that instant until the program enables it. The program loses all data except a few bytes in memory
 * that a reset does not clear, if the chip has such memory. */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

typedef enum hal_reset {
    HAL_RESET_POWER_ON, /* the supply came on: no data survive */
    HAL_RESET_WATCHDOG, /* the watchdog timed out and reset the processor */
    HAL_RESET_OTHER,    /* a pin or a debugger; or the cause is unknown */
    /* a fault of the program or of the crystal; the handler switched the motor off */
    HAL_RESET_FAULT,
    HAL_RESET_SUPPLY /* a dip of the processor's supply voltage */
} hal_reset;

/* Returns the cause. Call it after hal_clock_start() (clock.h). */
hal_reset hal_reset_cause(void);

/* Writes the cause in words, for consoles; for a fault also its kind, address, time and stage. Writes at most room - 1
 * characters and a zero; the text is never empty. Returns its length without the zero. */
unsigned hal_reset_words(char *words, unsigned room);

/* Sets the program's stage, a number that the program chooses. The record of a fault contains the last stage. The call
 * takes one store instruction, so a program can call it in every control step. */
void hal_reset_mark(uint32_t state);

/* Maximum number of bytes that can survive a reset. */
#define HAL_REMEMBER_BYTES 32U

/* Keeps bytes[count] through a reset, in place of the bytes of earlier calls; count <= HAL_REMEMBER_BYTES, 0 for no
 * bytes. If a reset interrupts the call, the earlier bytes survive. Do not call it from an interrupt. */
void hal_remember(const void *bytes, unsigned count);

/* Copy the bytes that were remembered at the processor's start to bytes[HAL_REMEMBER_BYTES]. Returns their number: 0
 * after a power-on, or if the bytes are corrupt (implementations check a CRC). */
unsigned hal_recall(void *bytes);

WH_C_END

#endif
