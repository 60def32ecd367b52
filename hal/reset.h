/* reset.h: why the processor starts, and what it still knows of before.
 *
 * In a reset pins float: the drive stage is off from that instant until the program says otherwise. All that the program
 * knew is lost but for a few bytes in memory that a reset leaves alone, where it has such. */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hal_reset {
    HAL_RESET_POWER_ON, /* the supply came: nothing is remembered */
    HAL_RESET_WATCHDOG, /* the watchdog was not kicked, and resets the processor instead of cutting the drive */
    HAL_RESET_OTHER /* a pin, a dip of the supply, a debugger */
} hal_reset;

/* Why, from hal_clock_start() (clock.h) on. */
hal_reset hal_reset_cause(void);

/* So many bytes can outlive a reset. */
#define HAL_REMEMBER_BYTES 32U

/* From now on these bytes outlive a reset, in place of what did before; count <= HAL_REMEMBER_BYTES, 0: nothing does. */
void hal_remember(const void *bytes, unsigned count);

/* What was remembered when the processor started goes to bytes[HAL_REMEMBER_BYTES]; returns how many there are. 0 after a
 * power-on, and where they are not as they were written: an implementation has to know, by a CRC. */
unsigned hal_recall(void *bytes);

#ifdef __cplusplus
}
#endif

#endif
