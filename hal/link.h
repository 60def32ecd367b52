/* link.h: a line of bytes to and from the plant's simulator. Bytes arrive in order. The line is a pair of semihosting
 * files (boards/cortexm), file descriptors (boards/host) or the console (boards/shared/link_console.c). If a function
 * detects that the simulator is gone, the program ends with status HAL_LINK_GONE. */
#ifndef HAL_LINK_H
#define HAL_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

#define HAL_LINK_GONE 3

/* File descriptors that the simulator passes to the program or its emulator, to read (DOWN) and to write (UP). */
#define HAL_LINK_DOWN 3
#define HAL_LINK_UP 4

/* Opens the line; call it first. Returns false if there is no line. */
bool hal_link_open(void);

/* Waits for data, then reads up to room >= 1 bytes. Returns the number of bytes read, at least 1. */
unsigned hal_link_read(uint8_t *bytes, unsigned room);

void hal_link_write(const uint8_t *bytes, unsigned count);

/* A timer that measures computing times. It wraps at 2^32. If it is unusable, its counts per second are 0. */
uint32_t hal_link_timer(void);
uint32_t hal_link_timer_per_s(void);

const char *hal_link_board(void);

WH_C_END

#endif
