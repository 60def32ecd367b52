/* metal.h: registers, and the memory layout of boards/shared/sections.ld, for the bare-metal families. */
#ifndef BOARDS_SHARED_METAL_H
#define BOARDS_SHARED_METAL_H

#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Access to a register. Tests on the PC replace these functions (tests/chip). */
#ifndef BOARD_REGISTERS_FAKED
#define BOARD_REGISTERS_FAKED 0
#endif
#if BOARD_REGISTERS_FAKED
uint32_t reg_load(uint32_t address);
void reg_store(uint32_t address, uint32_t value);
#else
static inline uint32_t reg_load(uint32_t address) { return REGISTER(address); }
static inline void reg_store(uint32_t address, uint32_t value) { REGISTER(address) = value; }
#endif

extern uint32_t board_stack_guard[]; /* lowest word of the guard strip */
extern uint32_t board_stack_limit[]; /* lowest word of the stack */
extern uint32_t board_stack_top[];   /* one past the highest word of the stack */
extern uint32_t board_fault_stack_top[];

/* Size of the guard strip. It is also the strip's alignment, because memory protection units require that. */
#define BOARD_STRIP_BYTES 256U

/* Protects the guard strip, if the chip can: accesses to it then fault (guard.c). The start-up code calls this once. */
void board_guard_stack(void);

/* Returns the number of words between two symbols of the linker script. C does not define their difference. */
static inline uint32_t board_words(const uint32_t *low, const uint32_t *high) {
    return (uint32_t)(((uintptr_t)high - (uintptr_t)low) / sizeof *low);
}

/* Copies initial values from flash, and clears the other variables. Call it before any code that uses variables. */
static inline void board_fill_memory(void) {
    extern uint32_t board_data_load[];
    extern uint32_t board_data_start[];
    extern uint32_t board_data_end[];
    extern uint32_t board_bss_start[];
    extern uint32_t board_bss_end[];
    volatile uint32_t *data = board_data_start;
    const uint32_t data_words = board_words(board_data_start, board_data_end);
    for (uint32_t i = 0; i < data_words; i++) {
        data[i] = board_data_load[i];
    }
    volatile uint32_t *bss = board_bss_start;
    const uint32_t bss_words = board_words(board_bss_start, board_bss_end);
    for (uint32_t i = 0; i < bss_words; i++) {
        bss[i] = 0;
    }
}

#endif
