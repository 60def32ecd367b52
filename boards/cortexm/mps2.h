/* mps2.h: registers shared by the Armv7-M images of Arm's MPS2 board (Arm DAI 0385 and 0386, "Memory map"). */
#ifndef BOARDS_MPS2_H
#define BOARDS_MPS2_H

#define BOARD_INTERRUPTS 32
#define BOARD_VECTOR_ROWS(X) /* no driver handles an interrupt */
#define BOARD_SAFE_ROWS(X)   /* nothing to switch off: the rotor is simulated */
#define BOARD_UART 0x40004000U
#define BOARD_UART_DIVISOR 217U /* 25 MHz / 115200 */
#define BOARD_TIMER 0x40000000U
#define BOARD_TICKS_PER_S 25000000U

#endif
