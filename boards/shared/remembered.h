/* remembered.h: memory that a reset does not clear, on families that have some. */
#ifndef BOARDS_SHARED_REMEMBERED_H
#define BOARDS_SHARED_REMEMBERED_H

#include <stdbool.h>
#include <stdint.h>

/* Places a variable in memory that is never cleared or filled. */
#define BOARD_KEPT __attribute__((section(".noinit")))

/* Start value of the CRCs of BOARD_KEPT variables. */
#define BOARD_KEPT_CRC_START 0x52494721U

/* A barrier: the compiler moves no store to that memory across this call. */
static inline void board_kept_settle(void) {
#if defined(__arm__)
    __asm__ volatile("dmb" ::: "memory");
#else
    __asm__ volatile("" ::: "memory");
#endif
}

/* True if hal_recall() has bytes to return. */
bool board_remembers(void);

/* Makes hal_recall() return no bytes until the next hal_remember(). Call it after a power-on. */
void board_forget(void);

/* Returns the last argument of hal_reset_mark(). */
uint32_t board_kept_state(void);

#endif
