/* cortexm.h: what the parts of the Cortex-M family share. Boards of the family are data only:
 * boards/NAME/board_data.h (registers), board.ld (memory) and board.mk (flags and source list). */
#ifndef BOARDS_CORTEXM_H
#define BOARDS_CORTEXM_H

#include <stdint.h>

#include "board_data.h"
#include "boards/shared/metal.h"
#include "core/text.h"

/* System control space, the same on every Armv7-M core (Armv7-M Architecture Reference Manual,
 * B3.2). Armv6-M lacks the FPU and the fault status registers. */
#define SCB_VTOR 0xE000ED08U  /* where the vector table is */
#define SCB_AIRCR 0xE000ED0CU /* asks for a reset */
#define SCB_AIRCR_RESET 0x05FA0004U
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

/* Vectors that a program may take, by their names: on_NAME(). One that no file defines is a fault. The core's are here, X(
 * exception, NAME); the chip's are BOARD_VECTOR_ROWS of board_data.h, X(interrupt, NAME), those that its drivers know. The
 * four fault vectors cannot be taken: nothing may run before the motor is off. */
#define CORTEXM_VECTOR_ROWS(X) \
    X(2, nmi) \
    X(11, svcall) \
    X(14, pendsv) \
    X(15, systick)

#define CORTEXM_DECLARE_VECTOR(number, name) void on_##name(void);
CORTEXM_VECTOR_ROWS(CORTEXM_DECLARE_VECTOR)
BOARD_VECTOR_ROWS(CORTEXM_DECLARE_VECTOR)
#undef CORTEXM_DECLARE_VECTOR

/* Where the vector table sends every exception that nobody takes. Never returns. Before anything else it makes the stores of
 * BOARD_SAFE_ROWS (board_data.h): X(address, value), those that take the power from what the board drives. */
void board_fault(void);

/* What a fault leaves. */
typedef struct board_fault_facts {
    uint32_t exception; /* its number */
    uint32_t sp;        /* where it was; nothing is known of pc and lr when it was astray */
    uint32_t pc;
    uint32_t lr;
    uint32_t cfsr; /* SCB's */
    uint32_t hfsr;
    uint32_t address; /* that was not answered, when cfsr says it is known */
    uint32_t stack;   /* a board_stack_state */
} board_fault_facts;

typedef enum board_stack_state {
    BOARD_STACK_GOOD,
    BOARD_STACK_OVERFLOW,
    BOARD_STACK_ASTRAY
} board_stack_state;

/* Its facts in words: " HardFault, PC 0x... LR 0x... ... (bus error)". */
void board_fault_words(wh_text *text, const board_fault_facts *facts);

/* What comes of it: demo.c prints and ends the emulator, flashed.c keeps a record and resets. */
_Noreturn void board_fault_ends(const board_fault_facts *facts);

/* Sets the chip's clocks up, before any variable has its value: may have none of its own, and waits for nothing without a
 * bound. What came of it is then in board_clock_is, of chips that have clocks to set up: in memory that nobody fills. */
typedef enum board_clock {
    BOARD_CLOCK_CRYSTAL,  /* as the board has it */
    BOARD_CLOCK_FALLBACK, /* the crystal does not answer: the chip's own oscillator */
    BOARD_CLOCK_GIVEN     /* there is nothing to set up: an emulator */
} board_clock;
void board_clock_start(void);
extern board_clock board_clock_is;

int main(void);

#endif
