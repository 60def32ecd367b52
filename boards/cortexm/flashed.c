/* flashed.c: end of a program on a real board. The motor is off. A fault is recorded, then the chip is reset. */
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

/* fault.c has already switched the outputs off. */
_Noreturn void board_fault_ends(const board_fault_facts *facts) {
    board_kept_fault(facts, board_ticks());
    __asm__ volatile("dsb" ::: "memory");
    REGISTER(SCB_AIRCR) = SCB_AIRCR_RESET;
    hold_still();
}
