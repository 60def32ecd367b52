/* guard.c: the guard strip below the stack, by physical memory protection (RISC-V Privileged Architecture, 3.7). A
 * locked entry without rights also restricts machine mode, until the next reset. Chips without PMP ignore writes. */
#include "riscv.h"

void board_guard_stack(void) {
    const uint32_t locked = 0x80U;
    /* NAPOT: the number of 1 bits at the low end of pmpaddr0 gives the strip's size */
    const uint32_t power_of_two = 3U << 3;
    const uint32_t strip = (uint32_t)(uintptr_t)board_stack_guard;
    CSR_WRITE("pmpaddr0", strip >> 2 | (BOARD_STRIP_BYTES / 8U - 1U));
    CSR_WRITE("pmpcfg0", locked | power_of_two);
}
