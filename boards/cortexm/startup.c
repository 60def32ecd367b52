/* startup.c: from reset to main(): vector table, memory, FPU, stack paint. */
#include "cortexm.h"

#include "boards/board.h"

_Noreturn void board_reset(void);

typedef void (*vector)(void);

/* Sixteen system vectors, then the chip's interrupts. This program uses no interrupt: any that
 * arrives is a fault and says so. */
__attribute__((section(".vectors"), used)) static const vector vectors[16 + BOARD_INTERRUPTS] = {
    [0] = (vector)(uintptr_t)board_stack_top,
    [1] = (vector)(uintptr_t)board_reset,
    [2 ... 16 + BOARD_INTERRUPTS - 1] = board_fault,
};

static void enable_fpu(void) {
#if defined(__ARM_FP)
    REGISTER(SCB_CPACR) |= 0xFU << 20;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
#endif
}

_Noreturn void board_reset(void) {
    enable_fpu();
    board_fill_memory();
#if __ARM_ARCH >= 7
    REGISTER(SCB_SHCSR) |= 7U << 16; /* usage, bus and memory faults by their own names */
#endif
    board_guard_stack();
    board_stack_paint();
    board_exit(main());
}
