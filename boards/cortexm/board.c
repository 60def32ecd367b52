/* board.c: board.h on the Cortex-M family. */
#include "boards/board.h"

#include "cortexm.h"

const char *const board_name = BOARD_NAME;
const uint32_t board_ticks_per_s = BOARD_TICKS_PER_S;

void board_start(void) {
    uart_start();
    timer_start();
}

void hal_console_write(const char *bytes, unsigned count) { uart_write(bytes, count); }

bool board_converse(void) { return true; }

#ifndef BOARD_CHIP_ID
#define BOARD_CHIP_ID 0xE000ED00U /* CPUID */
#endif
uint32_t board_chip(void) { return reg_load(BOARD_CHIP_ID); }

#if __ARM_ARCH >= 7 || BOARD_REGISTERS_FAKED

/* Data watchpoint and trace (Armv7-M Architecture Reference Manual, C1.8). Some Cortex-M7 chips lock this unit. */
#define DEMCR 0xE000EDFCU
#define DEMCR_TRCENA (1U << 24)
#define DWT_CTRL 0xE0001000U
#define DWT_CTRL_CYCCNTENA 1U
#define DWT_CTRL_NOCYCCNT (1U << 25)
#define DWT_CYCCNT 0xE0001004U
#define DWT_LAR 0xE0001FB0U
#define DWT_LAR_KEY 0xC5ACCE55U

bool board_cycles_start(void) {
    reg_store(DEMCR, reg_load(DEMCR) | DEMCR_TRCENA);
    reg_store(DWT_LAR, DWT_LAR_KEY);
    if ((reg_load(DWT_CTRL) & DWT_CTRL_NOCYCCNT) != 0) {
        return false;
    }
    reg_store(DWT_CYCCNT, 0);
    reg_store(DWT_CTRL, reg_load(DWT_CTRL) | DWT_CTRL_CYCCNTENA);
    const uint32_t before = board_cycles();
    return board_cycles() != before;
}

uint32_t board_cycles(void) { return reg_load(DWT_CYCCNT); }

#else

bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }

#endif
