/* registers.h: access to the chip's registers, in addition to boards/shared/metal.h. */
#ifndef BOARDS_STM32F4_REGISTERS_H
#define BOARDS_STM32F4_REGISTERS_H

#include "boards/shared/metal.h"

#if BOARD_REGISTERS_FAKED
uint32_t reg_address(volatile void *memory);
/* for stm32f4_hold() and stm32f4_go_on() */
uint32_t reg_hold(void);
void reg_go_on(uint32_t before);
#else
/* Returns the address of memory for DMA. */
static inline uint32_t reg_address(volatile void *memory) { return (uint32_t)(uintptr_t)memory; }
#endif

/* Sets the bits of `mask` in a register to `bits`. Not safe if an interrupt changes the same register. */
static inline void reg_change(uint32_t address, uint32_t mask, uint32_t bits) {
    reg_store(address, (reg_load(address) & ~mask) | bits);
}
static inline void reg_set(uint32_t address, uint32_t bits) { reg_change(address, 0, bits); }
static inline void reg_clear(uint32_t address, uint32_t bits) { reg_change(address, bits, 0); }

#endif
