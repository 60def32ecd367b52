/* stop.h: the stop input: a button, or a chain of contacts, that a person at the rig opens.
 *
 * All functions may be called from anywhere. The controller switches the motor off in the control step that sees the
 * stop. A separate circuit may cut the drive without the processor. */
#ifndef HAL_STOP_H
#define HAL_STOP_H

#include <stdbool.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Longest time between two samples of the stop input, in ticks of the capture timer (clock.h). */
#define HAL_STOP_PERIOD_TICKS 2000U

/* Returns true while stop is pressed, according to the last sample; also before the first sample, and if the line is
 * broken. The input is not debounced: its first open contact counts. */
bool hal_stop_pressed(void);

/* The source of a pressed stop. If the stop contacts and the drive stage's fault share a line, the source is
 * unknown. */
typedef enum hal_stop_source {
    HAL_STOP_EITHER,
    HAL_STOP_INPUT, /* the stop contacts: no fault of the drive stage is known */
    HAL_STOP_DRIVE  /* a fault of the drive stage, on a line of its own */
} hal_stop_source;
hal_stop_source hal_stop_source_now(void);

/* Returns false before the first sample and if the line is broken. hal_stop_pressed() is then no evidence of a pressed
 * button. */
bool hal_stop_heard(void);

WH_C_END

#endif
