/* cortexm.h: what the parts of the Cortex-M family share. Boards of the family are data only:
 * boards/NAME/board_data.h (registers), board.ld (memory) and board.mk (flags and source list). */
#ifndef BOARDS_CORTEXM_H
#define BOARDS_CORTEXM_H

#include <stdint.h>

#include "board_data.h"
#include "boards/shared/metal.h"

/* System control space, the same on every Armv7-M core (Armv7-M Architecture Reference Manual,
 * B3.2). Armv6-M lacks the FPU and the fault status registers. */
#define SCB_SHCSR 0xE000ED24U /* enables the three configurable faults */
#define SCB_CFSR 0xE000ED28U  /* why a configurable fault happened */
#define SCB_HFSR 0xE000ED2CU  /* why a hard fault happened */
#define SCB_MMFAR 0xE000ED34U /* address of a MemManage fault, when CFSR says it is valid */
#define SCB_BFAR 0xE000ED38U  /* address of a bus fault, when CFSR says it is valid */
#define MPU_TYPE 0xE000ED90U  /* how many regions there are, if any */
#define MPU_CTRL 0xE000ED94U
#define SCB_CPACR 0xE000ED88U /* coprocessor access: the FPU is 10 and 11 */

/* The console's device, one driver file a family of chips. uart_start() may be called again at any
 * time, also from the fault handler before anything else is up. */
void uart_start(void);
void uart_write(const char *bytes, unsigned count);

/* The free-running clock's device. */
void timer_start(void);

/* Where the vector table sends every exception but reset. Never returns. */
void board_fault(void);

int main(void);

#endif
