/* board.h: the interface of every board, including the PC. On bare metal the start-up code initializes memory and FPU,
 * and calls main(), whose result goes to board_exit(). */
#ifndef BOARDS_BOARD_H
#define BOARDS_BOARD_H

#include "hal/console.h" /* boards also implement hal_console_write() */

#include <stdbool.h>
#include <stdint.h>

WH_C_BEGIN

/* The board's name, as in boards/NAME; "host" on the PC. */
extern const char *const board_name;

/* Starts the console and the free-running clock. Call this once, before all other functions. */
void board_start(void);

/* Ends the program; 0 is success, 1 to 255 failure. Emulators exit with this code; silicon without a debugger stops. */
#ifdef __cplusplus
[[noreturn]] void board_exit(int code);
#else
_Noreturn void board_exit(int code);
#endif

/* Returns the time of a free-running clock, which counts up at the rate board_ticks_per_s, and wraps at 2^32. An
 * emulator counts its own time, so do not measure the speed of code with it. */
uint32_t board_ticks(void);
extern const uint32_t board_ticks_per_s;

/* Waits until board_ticks() reaches `ticks`, less than 2^31 ticks from now. Returns at once if `ticks` has passed. */
void board_wait_until(uint32_t ticks);

/* Opens the console for input (hal_console_read()). On the PC, opens a pseudo-terminal and prints its name. If the
 * console cannot be opened, prints the reason and returns false. */
bool board_converse(void);

/* The cycle counter (DWT's CYCCNT) of a real Cortex-M3, M4, M7 or M33. It wraps at 2^32. board_cycles_start() switches
 * it on. If there is no counter, board_cycles_start() returns false, and board_cycles() returns 0. */
bool board_cycles_start(void);
uint32_t board_cycles(void);

/* Returns the chip's identity: DBGMCU_IDCODE on the STM32F405, CPUID on other Cortex-M, 0 on other chips. */
uint32_t board_chip(void);

/* The start-up code and board_stack_paint() fill the unused part of the stack with a pattern. board_stack_used_bytes()
 * returns the largest use of the stack since the last fill. On the PC, the last two functions return 0. */
void board_stack_paint(void);
unsigned board_stack_used_bytes(void);
unsigned board_stack_size_bytes(void);

WH_C_END

#endif
