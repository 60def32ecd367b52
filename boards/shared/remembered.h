/* remembered.h: memory that a reset leaves alone, of families that have some. */
#ifndef BOARDS_SHARED_REMEMBERED_H
#define BOARDS_SHARED_REMEMBERED_H

#include <stdbool.h>
#include <stdint.h>

/* Nobody clears or fills it. */
#define BOARD_KEPT __attribute__((section(".noinit")))

/* Where CRCs of what is kept there begin: so memory that is all zeros is none. */
#define BOARD_KEPT_CRC_START 0x52494721U

/* Nothing of what is kept may be left for later, or come before what stands before it. */
static inline void board_kept_settle(void) {
#if defined(__arm__)
    __asm__ volatile("dmb" ::: "memory");
#else
    __asm__ volatile("" ::: "memory");
#endif
}

/* hal_recall() would have something. */
bool board_remembers(void);

/* The power came: hal_recall() has nothing, until the next hal_remember(). */
void board_forget(void);

/* hal_reset_mark()'s last. */
uint32_t board_kept_state(void);

#endif
