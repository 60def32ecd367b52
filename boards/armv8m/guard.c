/* guard.c: stack guard on Armv8-M (Armv8-M Architecture Reference Manual, B3.21 and B10). The core refuses to move the
 * stack pointer below MSPLIM, so an overflow faults before any store. The memory protection unit protects the guard
 * strip from stores through any pointer; privileged code cannot be denied reading. */
#include "boards/cortexm/cortexm.h"

#define MPU_RNR 0xE000ED98U
#define MPU_RBAR 0xE000ED9CU
#define MPU_RLAR 0xE000EDA0U
#define MPU_MAIR0 0xE000EDC0U

void board_guard_stack(void) {
#if defined(__ARM_ARCH_8M_MAIN__) || __ARM_FEATURE_CMSE == 3
    __asm__ volatile("msr msplim, %0" : : "r"(board_stack_limit));
#endif
    const uint32_t strip = (uint32_t)(uintptr_t)board_stack_guard;
    const uint32_t read_only_privileged = 2U << 1;
    const uint32_t no_execute = 1U;
    if (((REGISTER(MPU_TYPE) >> 8) & 0xFFU) == 0) {
        return;
    }
    REGISTER(MPU_MAIR0) = 0x44U; /* attribute 0: normal memory, not cached */
    REGISTER(MPU_RNR) = 0;
    REGISTER(MPU_RBAR) = strip | read_only_privileged | no_execute;
    REGISTER(MPU_RLAR) = ((strip + BOARD_STRIP_BYTES - 1U) & ~31U) | 1U; /* 1: enabled */
    /* The default map applies outside the region, and in hard-fault and NMI handlers. */
    REGISTER(MPU_CTRL) = 1U << 2 | 1U;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}
