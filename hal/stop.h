/* stop.h: the stop input: a button, or a chain of contacts, that a person at the rig opens. The next control step
 * switches the motor off; a separate circuit may cut the drive, too. These functions may be called from anywhere. */
#ifndef HAL_STOP_H
#define HAL_STOP_H

#include <stdbool.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Longest time between two samples of the input, in ticks of the capture timer (clock.h). */
#define HAL_STOP_PERIOD_TICKS 2000U

/* True if the last sample (not debounced) shows a pressed stop, if there is no sample yet, or if the line is broken. */
bool hal_stop_pressed(void);

/* Source of a pressed stop. */
typedef enum hal_stop_source {
    HAL_STOP_EITHER, /* unknown: the stop contacts and the drive stage's fault share a line */
    HAL_STOP_INPUT,  /* the stop contacts */
    HAL_STOP_DRIVE   /* a fault of the drive stage, which has its own line */
} hal_stop_source;
hal_stop_source hal_stop_source_now(void);

/* False if there is no sample yet, or if the line is broken. In both cases hal_stop_pressed() is true. */
bool hal_stop_heard(void);

WH_C_END

#endif
