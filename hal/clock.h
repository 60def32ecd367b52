/* clock.h: the rig's time, a free-running 1 MHz capture timer.
 *
 * Every time stamp of the rig (slot pulses, load samples, control steps) is a count of this one
 * timer: 32 bits, wrapping every 71.6 minutes. Differences of two stamps less than half of that
 * apart are right whether or not the timer wrapped in between. */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_TICKS_PER_S 1000000U

/* Start the timer, and with it whatever else the rig's hardware needs before its first use. To be
 * called before any other hal_ function. Returns false when the hardware does not answer. */
bool hal_clock_start(void);

/* The timer now, in ticks. */
uint32_t hal_clock_ticks(void);

/* Wait until the timer has reached `ticks` (which must be less than half the timer's range ahead);
 * return at once when it has already. May return late by up to a millisecond. */
void hal_clock_wait_until(uint32_t ticks);

#ifdef __cplusplus
}
#endif

#endif
