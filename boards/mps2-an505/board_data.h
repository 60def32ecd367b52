/* MPS2 with application note 505, Cortex-M33: registers of the secure state (Arm DAI 0505, "Memory map"). */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "mps2-an505"
#define BOARD_INTERRUPTS 128
#define BOARD_VECTOR_ROWS(X) /* no driver handles an interrupt */
#define BOARD_SAFE_ROWS(X)   /* nothing to switch off: the rotor is simulated */
#define BOARD_UART 0x50200000U
#define BOARD_UART_DIVISOR 174U /* 20 MHz / 115200 */
#define BOARD_TIMER 0x50000000U
#define BOARD_TICKS_PER_S 20000000U

#endif
