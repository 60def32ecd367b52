/* guard.c: the guard strip below the stack, on Armv6-M and Armv7-M (Armv7-M Architecture Reference Manual, B3.5). Chips
 * without a memory protection unit, such as every Cortex-M0, have zero regions and no guard. */
#include "cortexm.h"

#if __ARM_ARCH > 7
#error \
    "Armv8-M: put boards/armv8m/guard.c into BOARD_SOURCES; these registers mean something else there"
#endif

#define MPU_RBAR 0xE000ED9CU
#define MPU_RASR 0xE000EDA0U

void board_guard_stack(void) {
    const uint32_t strip_256_bytes = 7U << 1; /* 2^(7 + 1) */
    const uint32_t no_access_no_execute = 1U << 28;
    if (((REGISTER(MPU_TYPE) >> 8) & 0xFFU) == 0) {
        return;
    }
    REGISTER(MPU_RBAR) = (uint32_t)(uintptr_t)board_stack_guard | 1U << 4; /* region 0 */
    REGISTER(MPU_RASR) = no_access_no_execute | strip_256_bytes | 1U;
    /* The default map applies outside the region; hard-fault and NMI handlers run unprotected. */
    REGISTER(MPU_CTRL) = 1U << 2 | 1U;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}
