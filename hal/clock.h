/* clock.h: the rig's time, a free-running 1 MHz capture timer.
 *
 * Every time stamp of the rig (slot pulses, load samples, control steps) is a count of this one
 * timer: 32 bits, wrapping every 71.6 minutes. Differences of two stamps less than half of that
 * apart are right whether or not the timer wrapped in between.
 *
 * hal_clock_ticks() may be called from anywhere, the others not from an interrupt or a fault's handler. */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_TICKS_PER_S 1000000U

typedef enum hal_start {
    HAL_STARTED,
    HAL_START_NO_PLANT, /* what plays the rig does not */
    HAL_START_NO_TIMER  /* the timer does not count */
} hal_start;

/* Start the timer, and with it whatever else the rig's hardware needs before its first use; the motor is off. To be
 * called before any other hal_ function but hal_motor_off(). Anything but HAL_STARTED: nothing may be driven. */
hal_start hal_clock_start(void);

/* What the timer runs on. */
typedef enum hal_clock_source {
    HAL_CLOCK_CRYSTAL,
    HAL_CLOCK_FALLBACK, /* the crystal does not answer: too inexact for a speed */
    HAL_CLOCK_PLAYED    /* a model's time, or an emulator's */
} hal_clock_source;
hal_clock_source hal_clock_source_now(void);

/* How far it may be off: 100 ppm of a crystal, 10,000 of a fallback; 0: it is the time itself. */
uint32_t hal_clock_tolerance_ppm(void);

/* The timer now, in ticks. */
uint32_t hal_clock_ticks(void);

/* Wait until the timer has reached `ticks` (which must be less than half the timer's range ahead);
 * return at once when it has already. May return late, by what interrupts take, or a model's step: at most 0.1 ms on a
 * board of its own, a millisecond where the time is played. */
void hal_clock_wait_until(uint32_t ticks);

/* The most ticks that a wait has ended late since the last call of this: also those that were late when they were called. */
uint32_t hal_clock_late_ticks(void);

#ifdef __cplusplus
}
#endif

#endif
