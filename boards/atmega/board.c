/* board.c: board.h on an ATmega2560 with the rig's hardware. Programs never end on this board. */
#include "boards/board.h"

#include "hal/motor.h"

#include "atmega.h"

const char *const board_name = BOARD_NAME;

void atmega_usart_start(void);

void board_start(void) {
    atmega_usart_start();
    atmega_time_base_start();
    sei();
}

bool board_converse(void) { return true; }

/* Stops with the motor off. */
_Noreturn void board_exit(int code) {
    (void)code;
    hal_motor_off(HAL_MOTOR_COAST);
    for (;;) {
        __asm__ volatile("" ::: "memory");
    }
}

bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }
uint32_t board_chip(void) { return 0; }
