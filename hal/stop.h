/* stop.h: the stop input: a button, or a chain of contacts, that a person at the rig opens.
 * All functions may be called from anywhere. The controller switches the motor off in the control step that sees the
 * stop. A circuit that cuts the drive without the processor is separate. */
#ifndef HAL_STOP_H
#define HAL_STOP_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Longest time between two samples of the level, in ticks of the capture timer (clock.h): one sample per control step. */
#define HAL_STOP_PERIOD_TICKS 2000U

/* True while stop is pressed, according to the last sample. Also true before the first sample, and if the line is
 * broken. Not debounced: the first contact counts. */
bool hal_stop_pressed(void);

/* The source of a pressed stop. If the drive stage's fault shares a line with the stop contacts, the source is unknown. */
typedef enum hal_stop_source {
    HAL_STOP_EITHER,
    HAL_STOP_INPUT, /* the stop contacts, because no fault of the drive stage is known */
    HAL_STOP_DRIVE  /* the fault of the drive stage, on its own line */
} hal_stop_source;
hal_stop_source hal_stop_source_now(void);

/* False before the first sample and if the line is broken: hal_stop_pressed() is then no evidence of a button. */
bool hal_stop_heard(void);

#ifdef __cplusplus
}
#endif

#endif
