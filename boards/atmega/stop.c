/* stop.c: the stop input, pulled up: the chain of stop contacts, closed while all is well, holds it low. Open and broken are
 * pressed; a line that touches ground is not seen. */
#include "hal/stop.h"

#include "atmega.h"

bool hal_stop_pressed(void) { return (PINB & _BV(ATMEGA_STOP_BIT)) != 0; }

/* No line comes from the drive stage. */
hal_stop_source hal_stop_source_now(void) { return HAL_STOP_INPUT; }

bool hal_stop_heard(void) { return true; }
