/* riscv.h: declarations shared by the parts of the RISC-V family. A board of the family is data only:
 * boards/NAME/board_data.h (registers), board.ld (memory) and board.mk (flags and source list). */
#ifndef BOARDS_RISCV_H
#define BOARDS_RISCV_H

#include "board_data.h"
#include "boards/shared/metal.h"

/* Control and status registers, by their names in the assembler (RISC-V Privileged Architecture, 2.2). */
#define CSR_READ(name, value) __asm__ volatile("csrr %0, " name : "=r"(value))
#define CSR_WRITE(name, value) \
    __asm__ volatile("csrw " name ", %0" : : "r"((uint32_t)(value)) : "memory")

/* Start the console's device. Another call is allowed at any time, also for a trap's report before other parts are
 * up. */
void uart_start(void);
void uart_write(const char *bytes, unsigned count);

/* The handler of every trap. This program uses no interrupt, so every trap is a fault. Never returns. */
void board_fault(void);

int main(void);

#endif
