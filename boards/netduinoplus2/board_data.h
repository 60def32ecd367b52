/* Netduino Plus 2: STM32F405RG with a 25 MHz crystal. Its wiring is in docs/boards.md. */
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
