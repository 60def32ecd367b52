/* board.c: board.h on the Cortex-M family. */
#include "boards/board.h"

#include "cortexm.h"

const char *const board_name = BOARD_NAME;
const uint32_t board_ticks_per_s = BOARD_TICKS_PER_S;

void board_start(void) {
    uart_start();
    timer_start();
}

void hal_console_write(const char *bytes, unsigned count) { uart_write(bytes, count); }

/* Semihosting's SYS_EXIT_EXTENDED (Arm semihosting specification, 0x20): the emulator or debugger
 * ends with our code. With nobody listening the breakpoint becomes a hard fault, whose handler
 * comes here again: the second time there is nothing left to do but stop. */
_Noreturn void board_exit(int code) {
    static volatile int leaving = 0;
    const uint32_t application_exit = 0x20026U;
    const uint32_t block[2] = {application_exit, (uint32_t)code};
    if (leaving == 0) {
        leaving = 1;
        register uint32_t operation __asm__("r0") = 0x20U;
        register const uint32_t *argument __asm__("r1") = block;
        __asm__ volatile("bkpt 0xAB" : "+r"(operation) : "r"(argument) : "memory");
    }
    for (;;) {
    }
}
