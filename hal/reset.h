/* reset.h: why the processor starts, and what it still knows of before.
 *
 * In a reset pins float: the drive stage is off from that instant until the program says otherwise. All that the program
 * knew is lost but for a few bytes in memory that a reset leaves alone, where it has such. */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hal_reset {
    HAL_RESET_POWER_ON, /* the supply came: nothing is remembered */
    HAL_RESET_WATCHDOG, /* the watchdog was not kicked, and resets the processor instead of cutting the drive */
    HAL_RESET_OTHER, /* a pin, a debugger; or it is not known */
    HAL_RESET_FAULT, /* the program's own, or the crystal's: the motor went off, then it was noted */
    HAL_RESET_SUPPLY /* a dip of the processor's supply */
} hal_reset;

/* Why, from hal_clock_start() (clock.h) on. */
hal_reset hal_reset_cause(void);

/* Why in words, for consoles: of a fault also what and where, when, and in which state. Never empty; at most room - 1
 * bytes and a zero. Returns how many without it. */
unsigned hal_reset_words(char *words, unsigned room);

/* What the program is at, as a number of its own: a fault's record has the last. One store; every control step. */
void hal_reset_mark(uint32_t state);

/* So many bytes can outlive a reset. */
#define HAL_REMEMBER_BYTES 32U

/* From now on these bytes outlive a reset, in place of what did before; count <= HAL_REMEMBER_BYTES, 0: nothing does. A
 * reset in the middle leaves what was before. Not from an interrupt. */
void hal_remember(const void *bytes, unsigned count);

/* What was remembered when the processor started goes to bytes[HAL_REMEMBER_BYTES]; returns how many there are. 0 after a
 * power-on, and where they are not as they were written: an implementation has to know, by a CRC. */
unsigned hal_recall(void *bytes);

#ifdef __cplusplus
}
#endif

#endif
