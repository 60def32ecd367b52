/* startup.c: before and after main(). The C library's start-up code calls it and stops the processor when it returns:
 * main() is called in its place, and what it returns is the program's end. */
#include "boards/board.h"

int main(void);
void board_enter(void);
_Noreturn void board_run(void);

/* The last but one of the start-up code's pieces, which run one behind the other. */
__attribute__((naked, used, section(".init8"))) void board_enter(void) {
    __asm__ volatile("jmp board_run");
}

__attribute__((used)) _Noreturn void board_run(void) {
    board_stack_paint();
    board_exit(main());
}
