/* virt.h: registers shared by boards on QEMU's machine `virt` (QEMU, hw/riscv/virt.c, virt_memmap). */
#ifndef BOARDS_VIRT_H
#define BOARDS_VIRT_H

#define BOARD_UART 0x10000000U
#define BOARD_UART_DIVISOR 2U   /* 3.6864 MHz / 16 / 115200 */
#define BOARD_TIMER 0x0200BFF8U /* mtime of the core-local interruptor */
#define BOARD_TICKS_PER_S 10000000U
#define BOARD_FINISHER 0x00100000U

#endif
