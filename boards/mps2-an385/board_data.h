/* MPS2 with application note 385, Cortex-M3: registers (Arm DAI 0385, "Memory map"). */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "mps2-an385"
#define BOARD_INTERRUPTS 32
#define BOARD_UART 0x40004000U
#define BOARD_UART_DIVISOR 217U /* 25 MHz / 115200 */
#define BOARD_TIMER 0x40000000U
#define BOARD_TICKS_PER_S 25000000U

#endif
