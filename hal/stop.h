/* stop.h: the stop input: a button, or a chain of contacts, that whoever stands at the rig opens.
 *
 * Both may be called from anywhere. It is the controller that switches the motor off, in the control step that sees it; a
 * circuit that cuts the drive without the processor is none of this. */
#ifndef HAL_STOP_H
#define HAL_STOP_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The level is looked at so often at least, capture timer (clock.h): once a control step. */
#define HAL_STOP_PERIOD_TICKS 2000U

/* True while stop is pressed, as last looked at; also before it was looked at for the first time, and where its line is
 * broken. It is not debounced: the first contact counts. */
bool hal_stop_pressed(void);

/* Whose the pressed line is. A drive stage's fault may share it with the stop contacts: then nobody can tell. */
typedef enum hal_stop_source {
    HAL_STOP_EITHER,
    HAL_STOP_INPUT, /* the stop contacts: the drive stage has no line, or one of its own that is quiet */
    HAL_STOP_DRIVE /* the drive stage's fault, by a line of its own */
} hal_stop_source;
hal_stop_source hal_stop_source_now(void);

/* False before it was looked at for the first time, and where its line is broken: then pressed says nothing of a button. */
bool hal_stop_heard(void);

#ifdef __cplusplus
}
#endif

#endif
