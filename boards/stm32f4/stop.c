/* stop.c: the stop input on the pin of the break (motor.c). The pin is normally high: the chain of stop contacts feeds
 * it, and the drive stage's fault output pulls it down. */
#include "hal/stop.h"

#include "stm32f4.h"

bool hal_stop_pressed(void) { return !stm32f4_pin_is_high(BOARD_PIN_BREAK); }

hal_stop_source hal_stop_source_now(void) { return HAL_STOP_EITHER; }

/* Always true: a broken line cannot be distinguished and counts as pressed. */
bool hal_stop_heard(void) { return true; }
