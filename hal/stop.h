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

/* False before it was looked at for the first time, and where its line is broken: then pressed says nothing of a button. */
bool hal_stop_heard(void);

#ifdef __cplusplus
}
#endif

#endif
