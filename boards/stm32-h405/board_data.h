/* Olimex STM32-H405: STM32F405RG with an 8 MHz crystal. The board labels the pins of its extension headers with the
 * chip's names. The button is on PA0, so the slot sensors are on PA1 and PA2. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "stm32-h405"
#define BOARD_CRYSTAL_HZ 8000000U
#define BOARD_PLL_M 4U
#define BOARD_PLL_N 168U

#define BOARD_SLOT_PINS PIN('A', 1), PIN('A', 2)
#define BOARD_SLOT_CHANNELS 2U, 3U /* channels of TIM2 */
#define BOARD_CELL_PIN PIN('C', 0)
#define BOARD_CELL_INPUT 10U
#define BOARD_SUPPLY_PIN PIN('C', 1)
#define BOARD_SUPPLY_INPUT 11U

#include "boards/stm32f4/stm32f405.h"

#endif
