/* stop.c: the stop input with a pull-up: the closed chain of stop contacts pulls it low. An open chain and a broken
 * wire count as pressed; a short to ground is not detected. */
#include "hal/stop.h"

#include "atmega.h"

bool hal_stop_pressed(void) { return (PINB & _BV(ATMEGA_STOP_BIT)) != 0; }

/* The drive stage has no fault output. */
hal_stop_source hal_stop_source_now(void) { return HAL_STOP_INPUT; }

bool hal_stop_heard(void) { return true; }
