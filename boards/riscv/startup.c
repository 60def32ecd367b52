/* startup.c: from reset to main(), in machine mode. */
#include "riscv.h"

#include "boards/board.h"

void board_entry(void);
_Noreturn void board_reset(void);

/* The first code in flash. norelax is necessary, because gp is never set. */
__attribute__((naked, used, section(".vectors"))) void board_entry(void) {
    __asm__ volatile(".option norelax\n\t"
                     "la sp, board_stack_top\n\t"
                     "la t0, board_fault\n\t"
                     "csrw mtvec, t0\n\t"
                     "tail board_reset");
}

static void enable_fpu(void) {
#if defined(__riscv_flen)
    const uint32_t state_initial = 1U << 13; /* mstatus.FS */
    __asm__ volatile("csrs mstatus, %0" : : "r"(state_initial) : "memory");
    CSR_WRITE("fcsr", 0); /* rounds to nearest */
#endif
}

__attribute__((used)) _Noreturn void board_reset(void) {
    enable_fpu();
    board_fill_memory();
    board_guard_stack();
    board_stack_paint();
    board_exit(main());
}
