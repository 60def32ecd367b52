/* startup.c: calls main(), and ends the program with its result. The C library would stop the processor instead. */
#include "boards/board.h"

int main(void);
void board_enter(void);
_Noreturn void board_run(void);

/* Runs before the last piece of the C library's start-up code. */
__attribute__((naked, used, section(".init8"))) void board_enter(void) {
    __asm__ volatile("jmp board_run");
}

__attribute__((used)) _Noreturn void board_run(void) {
    board_stack_paint();
    board_exit(main());
}
