/* link.h: a two-way line of bytes to the simulator of the plant. The board implements it (boards/<family>/link.c): by
 * semihosting with files on the debugger's side under an emulator, by two file descriptors on the PC, by the console on
 * real boards (boards/shared/link_console.c). Bytes arrive in order. If these functions notice that the simulator is
 * gone, they end the program, with exit status HAL_LINK_GONE. */
#ifndef HAL_LINK_H
#define HAL_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

#define HAL_LINK_GONE 3

/* File descriptors that the simulator passes to the program or to its emulator: HAL_LINK_DOWN to read, the other to
 * write. */
#define HAL_LINK_DOWN 3
#define HAL_LINK_UP 4

/* Opens the line. Returns false if there is no line. Call it before the other functions. */
bool hal_link_open(void);

/* Waits for data, then reads up to room >= 1 bytes. Returns the number read, at least one. */
unsigned hal_link_read(uint8_t *bytes, unsigned room);

void hal_link_write(const uint8_t *bytes, unsigned count);

/* hal_link_timer() is a free-running counter that measures computing time and wraps at 2^32. hal_link_timer_per_s()
 * returns its counts per second, or 0 if the counter is unusable. */
uint32_t hal_link_timer(void);
uint32_t hal_link_timer_per_s(void);

/* The board's name. */
const char *hal_link_board(void);

WH_C_END

#endif
