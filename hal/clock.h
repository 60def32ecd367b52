/* clock.h: the rig's time, a free-running 1 MHz capture timer.
 *
 * It stamps slot pulses, load samples and control steps. It has 32 bits and wraps every 71.6 minutes. Differences of
 * stamps up to 35.8 minutes are right, even across a wrap.
 *
 * hal_clock_ticks() may be called from anywhere, the other functions not from an interrupt or a fault handler. */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

#define HAL_TICKS_PER_S 1000000U

/* Starts the timer and all other hardware of the rig; the motor is off. Call it before every other hal_ function except
 * hal_motor_off(). Returns false if the timer does not count, or if the rig's simulator does not answer: then do not
 * drive the motor. */
bool hal_clock_start(void);

typedef enum hal_clock_source {
    HAL_CLOCK_CRYSTAL,
    HAL_CLOCK_FALLBACK, /* after a failure of the crystal; too inaccurate to measure a speed */
    HAL_CLOCK_PLAYED    /* simulated time, from a model or an emulator */
} hal_clock_source;
hal_clock_source hal_clock_source_now(void);

uint32_t hal_clock_ticks(void);

/* Waits until the timer reaches `ticks`, at most 35 minutes ahead. Returns at once if `ticks` has passed. An interrupt
 * may delay the return by up to 0.1 ms. A model may return up to 1 ms of simulated time late. */
void hal_clock_wait_until(uint32_t ticks);

WH_C_END

#endif
