/* reset.h: the cause of the processor's start, and data that survive a reset.
 *
 * Pins float in a reset: the drive stage is off from that instant until the program enables it. All of the program's
 * data are lost except for a few bytes in memory that a reset does not clear, if there is such memory. */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hal_reset {
    HAL_RESET_POWER_ON, /* the supply came on: no data survive */
    HAL_RESET_WATCHDOG, /* the watchdog timed out and reset the processor */
    HAL_RESET_OTHER,    /* a pin, a debugger; or unknown */
    HAL_RESET_FAULT,    /* of the program or the crystal: the motor was switched off first */
    HAL_RESET_SUPPLY    /* a dip of the processor's supply */
} hal_reset;

/* The cause, after hal_clock_start() (clock.h). */
hal_reset hal_reset_cause(void);

/* The cause in words, for consoles: for a fault also its kind, place, time and state. Never empty; at most room - 1
 * bytes and a zero. Returns the length without the zero. */
unsigned hal_reset_words(char *words, unsigned room);

/* The program's stage, as a number of its own: a fault's record contains the last one. One store; every control step. */
void hal_reset_mark(uint32_t state);

/* Bytes that can survive a reset. */
#define HAL_REMEMBER_BYTES 32U

/* From now on these bytes survive a reset, replacing earlier ones; count <= HAL_REMEMBER_BYTES, 0: no bytes. A reset in
 * the middle leaves the earlier ones. Not from an interrupt. */
void hal_remember(const void *bytes, unsigned count);

/* Copy the bytes remembered at the processor's start to bytes[HAL_REMEMBER_BYTES]; returns their number. 0 after a
 * power-on, or if they are corrupt: implementations check a CRC. */
unsigned hal_recall(void *bytes);

#ifdef __cplusplus
}
#endif

#endif
