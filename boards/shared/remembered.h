/* remembered.h: memory that a reset does not clear, on families that have some. */
#ifndef BOARDS_SHARED_REMEMBERED_H
#define BOARDS_SHARED_REMEMBERED_H

#include <stdbool.h>
#include <stdint.h>

/* Never cleared or filled. */
#define BOARD_KEPT __attribute__((section(".noinit")))

/* Start value of CRCs there: memory that is all zeros is then invalid. */
#define BOARD_KEPT_CRC_START 0x52494721U

/* A barrier: stores to that memory are neither delayed beyond it nor moved before it. */
static inline void board_kept_settle(void) {
#if defined(__arm__)
    __asm__ volatile("dmb" ::: "memory");
#else
    __asm__ volatile("" ::: "memory");
#endif
}

/* hal_recall() would have something. */
bool board_remembers(void);

/* Power-on: hal_recall() returns no bytes until the next hal_remember(). */
void board_forget(void);

/* hal_reset_mark()'s last. */
uint32_t board_kept_state(void);

#endif
