/* demo.c: ends a program under an emulator or debugger, with an exit status. Images for real boards have flashed.c. */
#include "cortexm.h"

#include "boards/board.h"

/* Semihosting's SYS_EXIT_EXTENDED (Arm semihosting specification, 0x20) ends the emulator or debugger. Without one, the
 * breakpoint becomes a hard fault, whose handler calls this function again. */
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

_Noreturn void board_fault_ends(const board_fault_facts *facts) {
    char line[240];
    wh_text text;
    wh_text_start(&text, line, sizeof line);
    wh_text_add(&text, "\nfault:");
    board_fault_words(&text, facts);
    wh_text_add_char(&text, '\n');
    uart_start();
    uart_write(text.bytes, text.length);
    board_exit(70);
}
