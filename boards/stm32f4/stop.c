/* stop.c: the stop input. Its pin is also TIM1's break input (motor.c). The chain of stop contacts feeds the pin, and
 * the drive stage's fault output pulls it down. */
#include "hal/stop.h"

#include "stm32f4.h"

bool hal_stop_pressed(void) { return !stm32f4_pin_is_high(BOARD_PIN_BREAK); }

hal_stop_source hal_stop_source_now(void) { return HAL_STOP_EITHER; }

/* The input cannot distinguish a broken line from a pressed stop. */
bool hal_stop_heard(void) { return true; }
