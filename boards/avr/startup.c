/* startup.c: before and after main(). The C library's start-up code would call main() and stop the processor when it
 * returns. This file calls main() instead, and ends the program with its result. */
#include "boards/board.h"

int main(void);
void board_enter(void);
_Noreturn void board_run(void);

/* Runs as the last piece but one of the C library's start-up code. */
__attribute__((naked, used, section(".init8"))) void board_enter(void) {
    __asm__ volatile("jmp board_run");
}

__attribute__((used)) _Noreturn void board_run(void) {
    board_stack_paint();
    board_exit(main());
}
