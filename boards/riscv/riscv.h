/* riscv.h: declarations shared by the RISC-V family. A board is data only: boards/NAME/board_data.h (registers),
 * board.ld (memory) and board.mk (flags and source list). */
#ifndef BOARDS_RISCV_H
#define BOARDS_RISCV_H

#include "board_data.h"
#include "boards/shared/metal.h"

/* Control and status registers, by their assembler names (RISC-V Privileged Architecture, 2.2). */
#define CSR_READ(name, value) __asm__ volatile("csrr %0, " name : "=r"(value))
#define CSR_WRITE(name, value) \
    __asm__ volatile("csrw " name ", %0" : : "r"((uint32_t)(value)) : "memory")

/* Starts the console's device. It may be called again: the report of a trap does this. */
void uart_start(void);
void uart_write(const char *bytes, unsigned count);

/* Handles every trap, which is a fault, because no interrupt is used. Never returns. */
void board_fault(void);

int main(void);

#endif
