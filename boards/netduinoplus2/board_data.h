/* Netduino Plus 2: STM32F405RG with a 25 MHz crystal. Pins of the headers: D1: console output. D0: console input.
 * D13: PWM. D12: enable. D9: stop, driver's fault. D8, D3: slot sensors. A0: load cell. A1: supply. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "netduinoplus2"
#define BOARD_CRYSTAL_HZ 25000000U
#define BOARD_PLL_M 25U
#define BOARD_PLL_N 336U

#define BOARD_SLOT_PINS PIN('A', 0), PIN('A', 2)
#define BOARD_SLOT_CHANNELS 1U, 3U /* channels of TIM2 */
#define BOARD_CELL_PIN PIN('C', 0)
#define BOARD_CELL_INPUT 10U
#define BOARD_SUPPLY_PIN PIN('C', 1)
#define BOARD_SUPPLY_INPUT 11U

#include "boards/stm32f4/stm32f405.h"

#endif
