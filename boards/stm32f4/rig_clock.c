/* rig_clock.c: the start of the rig's hardware, and what its clock is (its time: boards/shared/rig_time.c). */
#include "hal/clock.h"

#include "boards/board.h"
#include "boards/shared/rig_time.h"
#include "hal/reset.h"
#include "stm32f4.h"

_Static_assert(BOARD_TICKS_PER_S == HAL_TICKS_PER_S, "one clock");

/* The motor first: it is off from here on whatever else fails. */
hal_start hal_clock_start(void) {
    stm32f4_motor_start();
    (void)hal_reset_cause();
    stm32f4_brown_out_start();
    stm32f4_slots_start();
    stm32f4_cell_start();
    return board_ticks_go_on() ? HAL_STARTED : HAL_START_NO_TIMER;
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
