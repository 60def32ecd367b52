/* rig_time.c: hal/clock.h, implemented with board_ticks(). */
#include "rig_time.h"

#include "boards/board.h"
#include "hal/clock.h"

#define LOOKS 10000U

bool board_ticks_go_on(void) {
    const uint32_t first = board_ticks();
    for (uint16_t i = 0; i < LOOKS; i++) {
        if (board_ticks() != first) {
            return true;
        }
    }
    return false;
}

uint32_t hal_clock_ticks(void) { return board_ticks(); }

void hal_clock_wait_until(uint32_t ticks) { board_wait_until(ticks); }
