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

bool board_converse(void) { return true; }

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

#if __ARM_ARCH >= 7

/* Data watchpoint and trace (Armv7-M Architecture Reference Manual, C1.8). Some Cortex-M7 lock it. */
#define DEMCR 0xE000EDFCU
#define DEMCR_TRCENA (1U << 24)
#define DWT_CTRL 0xE0001000U
#define DWT_CTRL_CYCCNTENA 1U
#define DWT_CYCCNT 0xE0001004U
#define DWT_LAR 0xE0001FB0U
#define DWT_LAR_KEY 0xC5ACCE55U

bool board_cycles_start(void) {
    REGISTER(DEMCR) |= DEMCR_TRCENA;
    REGISTER(DWT_LAR) = DWT_LAR_KEY;
    REGISTER(DWT_CTRL) |= DWT_CTRL_CYCCNTENA;
    const uint32_t before = board_cycles();
    __asm__ volatile("nop\n\tnop\n\tnop\n\tnop" ::: "memory");
    return board_cycles() != before;
}

uint32_t board_cycles(void) { return REGISTER(DWT_CYCCNT); }

#else

bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }

#endif
