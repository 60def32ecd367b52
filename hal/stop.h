/* stop.h: the stop input: a button, or a chain of contacts, that a person at the rig opens.
 *
 * Both may be called from anywhere. The controller switches the motor off, in the control step that sees it. A circuit
 * that cuts the drive without the processor is separate. */
#ifndef HAL_STOP_H
#define HAL_STOP_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Longest time between two samples of the level, capture timer (clock.h): once a control step. */
#define HAL_STOP_PERIOD_TICKS 2000U

/* True while stop is pressed, as last sampled; also before the first sample, and if its line is broken. Not debounced:
 * the first contact counts. */
bool hal_stop_pressed(void);

/* The source of a pressed line. A drive stage's fault may share it with the stop contacts: then it is unknown. */
typedef enum hal_stop_source {
    HAL_STOP_EITHER,
    HAL_STOP_INPUT, /* the stop contacts: the drive stage has no line, or an inactive one */
    HAL_STOP_DRIVE  /* the drive stage's fault, on a line of its own */
} hal_stop_source;
hal_stop_source hal_stop_source_now(void);

/* False before the first sample, and if its line is broken: pressed is then no evidence of a button. */
bool hal_stop_heard(void);

#ifdef __cplusplus
}
#endif

#endif
