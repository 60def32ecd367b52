/* startup.c: from reset to main(): vector table, memory, FPU, stack paint. */
#include "cortexm.h"

#include "boards/board.h"

extern uint32_t board_data_load[]; /* initial values, in flash */
extern uint32_t board_data_start[];
extern uint32_t board_data_end[];
extern uint32_t board_bss_start[];
extern uint32_t board_bss_end[];

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

/* Below the stack lies a strip that nobody may touch (Armv7-M Architecture Reference Manual, B3.5):
 * an overflow faults at once instead of quietly eating what comes next. Chips without a memory
 * protection unit read a region count of zero and go without, as do those of Armv8-M, whose unit is another. */
static void guard_stack(void) {
#if __ARM_ARCH == 7
    const uint32_t strip_256_bytes = 7U << 1; /* 2^(7 + 1) */
    const uint32_t no_access_no_execute = 1U << 28;
    if (((REGISTER(MPU_TYPE) >> 8) & 0xFFU) == 0) {
        return;
    }
    REGISTER(MPU_RBAR) = (uint32_t)(uintptr_t)board_stack_guard | 1U << 4; /* region 0 */
    REGISTER(MPU_RASR) = no_access_no_execute | strip_256_bytes | 1U;
    REGISTER(MPU_CTRL) = 1U << 2 | 1U; /* elsewhere the default map; not inside fault handlers */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
#endif
}

_Noreturn void board_reset(void) {
    enable_fpu();
    volatile uint32_t *data = board_data_start;
    const uint32_t data_words = board_words(board_data_start, board_data_end);
    for (uint32_t i = 0; i < data_words; i++) {
        data[i] = board_data_load[i];
    }
    volatile uint32_t *bss = board_bss_start;
    const uint32_t bss_words = board_words(board_bss_start, board_bss_end);
    for (uint32_t i = 0; i < bss_words; i++) {
        bss[i] = 0;
    }
#if __ARM_ARCH >= 7
    REGISTER(SCB_SHCSR) |= 7U << 16; /* usage, bus and memory faults by their own names */
#endif
    guard_stack();
    board_stack_paint();
    board_exit(main());
}
