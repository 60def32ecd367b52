/* cortexm.h: declarations shared by the Cortex-M family. A board is data only: boards/NAME/board_data.h (registers),
 * board.ld (memory) and board.mk (flags and source list). */
#ifndef BOARDS_CORTEXM_H
#define BOARDS_CORTEXM_H

#include <stdint.h>

#include "board_data.h"
#include "boards/shared/metal.h"
#include "core/text.h"

/* System control space (Armv7-M Architecture Reference Manual, B3.2). Armv6-M lacks FPU and fault status registers. */
#define SCB_VTOR 0xE000ED08U  /* address of the vector table */
#define SCB_AIRCR 0xE000ED0CU /* requests a reset */
#define SCB_AIRCR_RESET 0x05FA0004U
#define SCB_SHCSR 0xE000ED24U /* enables the three configurable faults */
#define SCB_CFSR 0xE000ED28U  /* cause of a configurable fault */
#define SCB_HFSR 0xE000ED2CU  /* cause of a hard fault */
#define SCB_MMFAR 0xE000ED34U /* address of a MemManage fault, if CFSR marks it valid */
#define SCB_BFAR 0xE000ED38U  /* address of a bus fault, if CFSR marks it valid */
#define MPU_TYPE 0xE000ED90U  /* number of regions; 0: no memory protection unit */
#define MPU_CTRL 0xE000ED94U
#define SCB_CPACR 0xE000ED88U /* coprocessor access; the FPU is coprocessors 10 and 11 */

/* Starts the console's device. May be called at any time, also again, and from the fault handler. */
void uart_start(void);
void uart_write(const char *bytes, unsigned count);

/* Starts the free-running clock. */
void timer_start(void);

/* Exceptions of the core, X(exception, NAME). BOARD_VECTOR_ROWS (board_data.h) lists the drivers' interrupts,
 * X(interrupt, NAME). If a program has a function on_NAME(), the function handles NAME; otherwise board_fault() does.
 * The four fault exceptions always run board_fault(), which first switches the outputs off. */
#define CORTEXM_VECTOR_ROWS(X) \
    X(2, nmi) \
    X(11, svcall) \
    X(14, pendsv) \
    X(15, systick)

#define CORTEXM_DECLARE_VECTOR(number, name) void on_##name(void);
CORTEXM_VECTOR_ROWS(CORTEXM_DECLARE_VECTOR)
BOARD_VECTOR_ROWS(CORTEXM_DECLARE_VECTOR)
#undef CORTEXM_DECLARE_VECTOR

/* Handles every exception that has no handler. Never returns. First it makes the stores X(address, value) of
 * BOARD_SAFE_ROWS (board_data.h), which switch the board's outputs off. */
void board_fault(void);

typedef struct board_fault_facts {
    uint32_t exception;
    uint32_t sp; /* stack pointer; if it was invalid, pc and lr are unknown */
    uint32_t pc;
    uint32_t lr;
    uint32_t cfsr;
    uint32_t hfsr;
    uint32_t address; /* address whose access failed, if cfsr marks it valid */
    uint32_t stack;   /* a board_stack_state */
} board_fault_facts;

typedef enum board_stack_state {
    BOARD_STACK_GOOD,
    BOARD_STACK_OVERFLOW,
    BOARD_STACK_ASTRAY
} board_stack_state;

/* Adds a fault's facts in words: " HardFault, PC 0x... LR 0x... ... (bus error)". */
void board_fault_words(wh_text *text, const board_fault_facts *facts);

/* Ends a program after a fault: demo.c prints and ends the emulator, flashed.c stores a record and resets. */
_Noreturn void board_fault_ends(const board_fault_facts *facts);

/* Result of board_clock_start(). This function runs before the start-up code initializes the variables. It uses only
 * board_clock_is, which the start-up code does not clear. Each of its waits is bounded. */
typedef enum board_clock {
    BOARD_CLOCK_CRYSTAL,  /* the crystal of the board */
    BOARD_CLOCK_FALLBACK, /* the chip's own oscillator, because the crystal does not oscillate */
    BOARD_CLOCK_GIVEN     /* an emulator, which has no clock to set up */
} board_clock;
void board_clock_start(void);
extern board_clock board_clock_is;

int main(void);

#endif
