/* rig_clock.c: hal/clock.h on timer 2, which board_start() has started; and the start of the rig's other hardware. */
#include "hal/clock.h"

#include "boards/board.h"
#include "hal/reset.h"
#include "stm32f4.h"

_Static_assert(BOARD_TICKS_PER_S == HAL_TICKS_PER_S, "one clock");

static uint32_t late_most;

/* It counts within a microsecond, and waiting for one that does not would never end. */
static bool counts(void) {
    const uint32_t first = board_ticks();
    for (uint32_t i = 0; i < 10000U; i++) {
        if (board_ticks() != first) {
            return true;
        }
    }
    return false;
}

/* The motor first: it is off from here on whatever else fails. */
hal_start hal_clock_start(void) {
    stm32f4_motor_start();
    (void)hal_reset_cause();
    stm32f4_brown_out_start();
    stm32f4_slots_start();
    stm32f4_cell_start();
    return counts() ? HAL_STARTED : HAL_START_NO_TIMER;
}

uint32_t hal_clock_ticks(void) { return board_ticks(); }

void hal_clock_wait_until(uint32_t ticks) {
    board_wait_until(ticks);
    const uint32_t late = board_ticks() - ticks;
    late_most = late > late_most ? late : late_most;
}

uint32_t hal_clock_late_ticks(void) {
    const uint32_t most = late_most;
    late_most = 0;
    return most;
}

hal_clock_source hal_clock_source_now(void) {
    switch (board_clock_is) {
    case BOARD_CLOCK_CRYSTAL: return HAL_CLOCK_CRYSTAL;
    case BOARD_CLOCK_FALLBACK: return HAL_CLOCK_FALLBACK;
    case BOARD_CLOCK_GIVEN: break;
    }
    return HAL_CLOCK_PLAYED;
}

uint32_t hal_clock_tolerance_ppm(void) { return stm32f4_clocks_now()->tolerance_ppm; }
