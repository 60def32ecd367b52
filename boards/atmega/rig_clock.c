/* rig_clock.c: the start of the rig's hardware, and the source of its clock (boards/shared/rig_time.c). */
#include "hal/clock.h"

#include "boards/board.h"
#include "boards/shared/rig_time.h"
#include "hal/reset.h"

#include "atmega.h"

/* atmega_motor_start() comes first, so that the motor is off even if a later function fails. */
bool hal_clock_start(void) {
    atmega_motor_start();
    (void)hal_reset_cause();
    atmega_slots_start();
    atmega_cell_start();
    return board_ticks_go_on();
}

/* Fuses choose the crystal. If it stops, the processor has no clock at all. */
hal_clock_source hal_clock_source_now(void) { return HAL_CLOCK_CRYSTAL; }
