/* board.h: the interface of every board, including the PC. Boards differ only in their implementation of this
 * interface. On bare metal the start-up code copies and clears memory, switches the FPU on, paints the stack and calls
 * main(); main()'s result goes to board_exit(). On the PC main() is called as usual. */
#ifndef BOARDS_BOARD_H
#define BOARDS_BOARD_H

#include "hal/console.h" /* boards also implement hal_console_write() */

#include <stdbool.h>
#include <stdint.h>

WH_C_BEGIN

/* Name of the board, as in boards/NAME; "host" on the PC. */
extern const char *const board_name;

/* Start the console and the free-running clock. Call this once, before all other functions. */
void board_start(void);

/* End the program with an exit code: 0 is success, 1 to 255 failure. Under an emulator the code becomes the emulator's
 * exit status. On silicon without a debugger the core stops in a loop. */
#ifdef __cplusplus
[[noreturn]] void board_exit(int code);
#else
_Noreturn void board_exit(int code);
#endif

/* A free-running clock: it counts up and wraps at 2^32. A difference of two readings in uint32_t is right if it is
 * below one wrap. board_ticks_per_s is constant. In an emulator the clock has the emulator's time: good for timeouts,
 * useless for measuring speed. */
uint32_t board_ticks(void);
extern const uint32_t board_ticks_per_s;

/* Wait until the clock reaches `ticks`, less than half of its range ahead. Returns at once if the clock is past
 * `ticks`. The PC sleeps meanwhile. */
void board_wait_until(uint32_t ticks);

/* Open the console for input (hal_console_read()): on the PC a pseudo-terminal, whose name is printed. If that fails,
 * prints the reason and returns false. On boards with a UART the console is already open. */
bool board_converse(void);

/* The processor's own cycle counter, wrapping at 2^32. board_cycles_start() switches it on and returns true if there is
 * a counter. Chips with a Cortex-M3, M4, M7 or M33 have one (DWT's CYCCNT). The PC has none, and emulators do not model
 * cycles. Without a counter, board_cycles() is 0. */
bool board_cycles_start(void);
uint32_t board_cycles(void);

/* Returns the chip's identity: on the STM32F405 device and revision (DBGMCU_IDCODE), on other Cortex-M the core's
 * CPUID. 0: unknown. */
uint32_t board_chip(void);

/* The largest use of the stack. board_stack_paint() fills the presently unused part with a pattern (the start-up code
 * has done this once). board_stack_used_bytes() returns the number of bytes, from the top of the stack, that have been
 * overwritten since then. board_stack_size_bytes() returns the stack's size. Both return 0 on the PC, where the
 * operating system has the stack. */
void board_stack_paint(void);
unsigned board_stack_used_bytes(void);
unsigned board_stack_size_bytes(void);

WH_C_END

#endif
