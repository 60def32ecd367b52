/* rig_clock.c: the start of the rig's hardware, and the source of its clock (boards/shared/rig_time.c). */
#include "hal/clock.h"

#include "boards/board.h"
#include "boards/shared/rig_time.h"
#include "stm32f4.h"

_Static_assert(BOARD_TICKS_PER_S == HAL_TICKS_PER_S, "one clock");
_Static_assert((int)BOARD_CLOCK_CRYSTAL == (int)HAL_CLOCK_CRYSTAL &&
                   (int)BOARD_CLOCK_FALLBACK == (int)HAL_CLOCK_FALLBACK &&
                   (int)BOARD_CLOCK_GIVEN == (int)HAL_CLOCK_PLAYED,
               "one list of what it runs on");

/* Sets up the motor first, so that the motor is off even if a later part fails. */
bool hal_clock_start(void) {
    stm32f4_motor_start();
    stm32f4_reset_start();
    stm32f4_brown_out_start();
    stm32f4_slots_start();
    stm32f4_cell_start();
    return board_ticks_go_on();
}

hal_clock_source hal_clock_source_now(void) { return (hal_clock_source)board_clock_is; }
