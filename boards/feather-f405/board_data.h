/* Adafruit Feather STM32F405 Express with a 12 MHz crystal. Its wiring is in docs/boards.md. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "feather-f405"
#define BOARD_CRYSTAL_HZ 12000000U
#define BOARD_PLL_M 6U
#define BOARD_PLL_N 168U

#define BOARD_SLOT_PINS PIN('A', 5), PIN('B', 11)
#define BOARD_SLOT_CHANNELS 1U, 4U /* channels of TIM2 */
#define BOARD_CELL_PIN PIN('C', 4)
#define BOARD_CELL_INPUT 14U
#define BOARD_SUPPLY_PIN PIN('C', 5)
#define BOARD_SUPPLY_INPUT 15U

#include "boards/stm32f4/stm32f405.h"

#endif
