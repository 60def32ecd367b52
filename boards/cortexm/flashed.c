/* flashed.c: how a program ends that runs on a board of its own: never. A fault is noted and the processor starts again; a
 * program that cannot go on holds still, the motor off. */
#include "boards/board.h"
#include "hal/motor.h"

#include "kept.h"

_Noreturn static void hold_still(void) {
    for (;;) {
        __asm__ volatile("" ::: "memory");
    }
}

_Noreturn void board_exit(int code) {
    (void)code;
    hal_motor_off(HAL_MOTOR_COAST);
    hold_still();
}

/* The stores that switch off are made (fault.c). */
_Noreturn void board_fault_ends(const board_fault_facts *facts) {
    board_kept_fault(facts, board_ticks());
    __asm__ volatile("dsb" ::: "memory");
    REGISTER(SCB_AIRCR) = SCB_AIRCR_RESET;
    hold_still();
}
