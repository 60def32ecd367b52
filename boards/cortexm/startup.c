/* startup.c: from reset to main(). */
#include "cortexm.h"

#include "boards/board.h"

_Noreturn void board_reset(void);

typedef void (*vector)(void);

#define CORE_ROW(number, name) [(number)] = on_##name,
#define CHIP_ROW(number, name) [16 + (number)] = on_##name,

/* The table's first row fills a range with the fault handler; later rows override parts of it. */
#pragma GCC diagnostic ignored "-Woverride-init"

/* Sixteen system vectors, then the chip's interrupts. */
__attribute__((section(".vectors"), used)) static const vector vectors[16 + BOARD_INTERRUPTS] = {
    [2 ... 16 + BOARD_INTERRUPTS - 1] = board_fault,
    [0] = (vector)(uintptr_t)board_stack_top,
    [1] = (vector)(uintptr_t)board_reset,
    CORTEXM_VECTOR_ROWS(CORE_ROW) BOARD_VECTOR_ROWS(CHIP_ROW)};

static void enable_fpu(void) {
#if defined(__ARM_FP)
    REGISTER(SCB_CPACR) |= 0xFU << 20;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
#endif
}

/* A loader in ROM may have set the address of another vector table. */
static void take_vectors(void) {
#if __ARM_ARCH >= 7
    REGISTER(SCB_VTOR) = (uint32_t)(uintptr_t)vectors;
    REGISTER(SCB_SHCSR) |= 7U << 16; /* separate vectors of usage, bus and memory faults */
    __asm__ volatile("dsb" ::: "memory");
#endif
}

_Noreturn void board_reset(void) {
    take_vectors();
    enable_fpu();
    board_clock_start();
    board_fill_memory();
    board_guard_stack();
    board_stack_paint();
    board_exit(main());
}
