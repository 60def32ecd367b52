/* board.h: what every board offers, the PC included. Nothing else differs between them.
 *
 * On bare metal the startup code clears and copies memory, switches the FPU on, paints the stack
 * and calls main(); what main() returns goes to board_exit(). On the PC main() is main().
 */
#ifndef BOARDS_BOARD_H
#define BOARDS_BOARD_H

#include "hal/console.h" /* hal_console_write() is the board's as well */

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Name of the board as in boards/NAME, "host" on the PC. */
extern const char *const board_name;

/* Bring up the console and the free-running clock. Call once, first. */
void board_start(void);

/* End the program: `code` 0 is success, 1 to 255 failure. Under an emulator the code becomes the
 * emulator's exit status; on silicon without a debugger the core stops in a loop. */
#ifdef __cplusplus
[[noreturn]] void board_exit(int code);
#else
_Noreturn void board_exit(int code);
#endif

/* A free-running clock: counts up and wraps at 2^32, so differences of two readings below one wrap
 * are right when taken as uint32_t. board_ticks_per_s is constant. In an emulator it follows the
 * emulator's idea of time: good for timeouts, worthless for measuring speed. */
uint32_t board_ticks(void);
extern const uint32_t board_ticks_per_s;

/* Wait until the clock has reached `ticks`, which must be less than half its range ahead; return at once when it has
 * already. The PC sleeps meanwhile. */
void board_wait_until(uint32_t ticks);

/* Open the console for a dialogue (hal_console_read()): on the PC a pseudo-terminal, whose name is printed. False, and why
 * is printed, when there is none. Boards with a UART have it open. */
bool board_converse(void);

/* The processor's own count of its cycles, wrapping at 2^32. board_cycles_start() switches it on and says whether there
 * is one that counts: on silicon with a Cortex-M3, M4, M7 or M33 (DWT's CYCCNT); not on the PC, not in emulators, whose
 * time is none. Where there is none board_cycles() is 0. */
bool board_cycles_start(void);
uint32_t board_cycles(void);

/* What the chip says it is: on the STM32F405 device and revision (DBGMCU_IDCODE), on other Cortex-M the core's CPUID. 0: it
 * says nothing. */
uint32_t board_chip(void);

/* Worst use of the stack. board_stack_paint() marks the part not in use at the moment (the startup
 * code has done it once); board_stack_used_bytes() is the deepest mark overwritten since, counted
 * from the top of the stack; board_stack_size_bytes() is what there is. Both are 0 on the PC, where
 * the stack belongs to the operating system. */
void board_stack_paint(void);
unsigned board_stack_used_bytes(void);
unsigned board_stack_size_bytes(void);

#ifdef __cplusplus
}
#endif

#endif
