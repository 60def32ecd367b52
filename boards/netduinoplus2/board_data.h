/* Netduino Plus 2: STM32F405RG with a 25 MHz crystal. Pins on its headers: console D1 (out) and D0 (in), PWM D13,
 * enable D12, stop and driver's fault D9, slot sensors D8 and D3, load cell A0, supply A1. */
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
