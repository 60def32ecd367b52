/* stm32f405.h: data common to all boards with an STM32F405. A board's other data are in its board_data.h. All boards
 * have these pins on a header: PB13, the complement of TIM1's channel 1; PB14, the enable; PA6, TIM1's break input. */
#ifndef BOARDS_STM32F405_H
#define BOARDS_STM32F405_H

#include "rm0090.h"

#define BOARD_INTERRUPTS STM32F4_INTERRUPTS
#define BOARD_VECTOR_ROWS STM32F4_VECTOR_ROWS
#define BOARD_TICKS_PER_S 1000000U

#define BOARD_CHIP_ID 0xE0042000U /* DBGMCU_IDCODE (RM0090, 38.6.1) */

#define BOARD_PIN_TX PIN('C', 6)
#define BOARD_PIN_RX PIN('C', 7)
#define BOARD_PIN_PWM PIN('B', 13)
#define BOARD_PIN_ENABLE PIN('B', 14)
#define BOARD_PIN_BREAK PIN('A', 6)

/* This value does not contain MOE, so TIM1's outputs (motor.c) have their idle level, low. */
#define BOARD_MOTOR_BDTR (TIM_BDTR_LOCK_2 | TIM_BDTR_OSSI | TIM_BDTR_OSSR | TIM_BDTR_BKE)

/* Supply voltage at which the supply's input has the converter's largest value. The highest intended supply is 30 V. */
#define BOARD_SUPPLY_FULL_mV 33000U
#define BOARD_SUPPLY_MOST_mV 31500U

/* The first stores after a fault (boards/cortexm/fault.c). They set TIM1's outputs to idle, then the enable to low. */
#define BOARD_SAFE_ROWS(X) \
    X(TIM_BDTR(TIM1), BOARD_MOTOR_BDTR) \
    X(GPIO_BSRR(BOARD_PIN_ENABLE / 16U), 1U << (BOARD_PIN_ENABLE % 16U + 16U))

#endif
