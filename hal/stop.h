/* stop.h: the stop input: a button, or a chain of contacts, that a person at the rig opens. The next control step
 * switches the motor off; a separate circuit may cut the drive, too. These functions may be called from anywhere. */
#ifndef HAL_STOP_H
#define HAL_STOP_H

#include <stdbool.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Longest time between two samples of the input, in ticks of the capture timer (clock.h). */
#define HAL_STOP_PERIOD_TICKS 2000U

/* True if the last sample shows stop pressed (not debounced), before the first sample, and if the line is broken. */
bool hal_stop_pressed(void);

/* Source of a pressed stop; EITHER if the stop contacts and the drive stage's fault share a line. */
typedef enum hal_stop_source {
    HAL_STOP_EITHER,
    HAL_STOP_INPUT, /* the stop contacts; the drive stage reports no fault */
    HAL_STOP_DRIVE  /* a fault of the drive stage, on its own line */
} hal_stop_source;
hal_stop_source hal_stop_source_now(void);

/* False before the first sample and if the line is broken: hal_stop_pressed() then does not prove a pressed button. */
bool hal_stop_heard(void);

WH_C_END

#endif
