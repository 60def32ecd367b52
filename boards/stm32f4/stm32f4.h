/* stm32f4.h: declarations shared by the drivers of the STM32F405. Crystal and pins are in the board's board_data.h. */
#ifndef BOARDS_STM32F4_H
#define BOARDS_STM32F4_H

#include <stdbool.h>
#include <stdint.h>

#include "boards/cortexm/cortexm.h"
#include "registers.h"
#include "rm0090.h"

/* Clocks after board_clock_start() (RM0090, 7.2, figure 21). Timers run at twice their bus clock if it is divided. */
typedef struct stm32f4_clocks {
    uint32_t timer1_Hz; /* clock of TIM1, on APB2 */
    uint32_t timers_Hz; /* clock of TIM2 and TIM3, on APB1 */
    uint32_t usart_Hz;  /* clock of the USART, on APB2 */
} stm32f4_clocks;
const stm32f4_clocks *stm32f4_clocks_now(void);

/* Number of a peripheral: the index of its bit in the clock enable registers. Port A has number 0. */
#define RCC_PART(enable, bit) (((enable)-RCC_AHB1ENR) * 8U + (unsigned)__builtin_ctz(bit))

/* Enables the peripheral's clock, which runs when the call returns (RM0090, 7.3.14; ES0182, 2.1.13). */
void stm32f4_clock_on(unsigned part);

/* Waits until the bits of `mask` in a register equal `wanted`. Returns false after `looks` polls of some ten cycles. */
bool stm32f4_comes(uint32_t address, uint32_t mask, uint32_t wanted, uint32_t looks);

/* A pin's mode and pull resistor. */
#define PIN_INPUT 0U
#define PIN_OUTPUT 1U
#define PIN_ALTERNATE(function) (2U | (function) << 4) /* functions 0 to 15 */
#define PIN_ANALOGUE 3U
#define PULL_UP (1U << 2)
#define PULL_DOWN (2U << 2)

/* Sets a pin's mode, and enables the port's clock. */
void stm32f4_pin_is(unsigned pin, unsigned what);
/* Sets a pin's level by a single store, so that a fault handler may call it. */
WH_INLINE void stm32f4_pin_set(unsigned pin, bool high) {
    reg_store(GPIO_BSRR(pin / 16U), 1U << (pin % 16U + (high ? 0U : 16U)));
}
static inline bool stm32f4_pin_is_high(unsigned pin) {
    return (reg_load(GPIO_IDR(pin / 16U)) >> (pin % 16U) & 1U) != 0;
}

/* Sets field `number` in the registers from `first` on. All fields have `bits` bits; none crosses registers. */
void stm32f4_field(uint32_t first, unsigned bits, unsigned number, uint32_t value);

/* Enables an interrupt of the chip. Interrupts do not interrupt each other; faults interrupt all. */
void stm32f4_interrupt(unsigned number);

/* Switches interrupts off until stm32f4_go_on(). Returns the interrupt state before the call. */
static inline uint32_t stm32f4_hold(void) {
#if BOARD_REGISTERS_FAKED
    return reg_hold();
#else
    uint32_t before = 0;
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(before) : : "memory");
    return before;
#endif
}
static inline void stm32f4_go_on(uint32_t before) {
#if BOARD_REGISTERS_FAKED
    reg_go_on(before);
#else
    __asm__ volatile("msr primask, %0" : : "r"(before) : "memory");
#endif
}

/* Returns false if the flash stays busy for longer than an erase, which takes less than two seconds. */
static inline bool stm32f4_flash_rests(void) {
    return stm32f4_comes(FLASH_SR, FLASH_SR_BSY, 0, 100000000U);
}

/* hal_clock_start() calls these functions (rig_clock.c). */
void stm32f4_motor_start(void);
void stm32f4_reset_start(void);
void stm32f4_slots_start(void);
void stm32f4_cell_start(void);
void stm32f4_brown_out_start(void);

#endif
