/* rig_clock.c: hal/clock.h on the time base, which board_start() has started; and the start of the rig's other hardware. */
#include "hal/clock.h"

#include "boards/board.h"
#include "hal/reset.h"

#include "atmega.h"

static uint32_t late_most;

/* It counts within half a microsecond, and waiting for one that does not would never end. */
static bool counts(void) {
    const uint32_t first = board_ticks();
    for (uint16_t i = 0; i < 1000U; i++) {
        if (board_ticks() != first) {
            return true;
        }
    }
    return false;
}

/* The motor first: it is off from here on whatever else fails. */
hal_start hal_clock_start(void) {
    atmega_motor_start();
    (void)hal_reset_cause();
    atmega_slots_start();
    atmega_cell_start();
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

/* Fuses choose it, and there is no other: one that stops leaves the processor without a clock. */
hal_clock_source hal_clock_source_now(void) { return HAL_CLOCK_CRYSTAL; }

uint32_t hal_clock_tolerance_ppm(void) { return 100; }
