/* clock.h: the rig's time, a free-running 1 MHz capture timer.
 *
 * Every time stamp of the rig (slot pulses, load samples, control steps) is a count of this one timer: 32 bits,
 * wrapping every 71.6 minutes. The difference of two stamps is right if they are less than half of that apart, even if
 * the timer wrapped in between.
 *
 * hal_clock_ticks() may be called from anywhere, the other functions not from an interrupt or a fault handler. */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

#define HAL_TICKS_PER_S 1000000U

/* Start the timer and all other hardware of the rig; the motor is off. Call it before every other hal_ function except
 * hal_motor_off(). Returns false if the timer does not count, or if the rig's simulator does not answer: then do not
 * drive the motor. */
bool hal_clock_start(void);

typedef enum hal_clock_source {
    HAL_CLOCK_CRYSTAL,
    HAL_CLOCK_FALLBACK, /* the crystal does not oscillate: too inaccurate for a speed */
    HAL_CLOCK_PLAYED    /* the time comes from a model, or from an emulator */
} hal_clock_source;
hal_clock_source hal_clock_source_now(void);

/* Returns the timer's present count, in ticks. */
uint32_t hal_clock_ticks(void);

/* Wait until the timer reaches `ticks`, less than half of the timer's range ahead. Returns at once if the timer is
 * already past `ticks`. Interrupts or a model's step may delay the return: by at most 0.1 ms on a real board, by 1 ms
 * in simulated time. */
void hal_clock_wait_until(uint32_t ticks);

WH_C_END

#endif
