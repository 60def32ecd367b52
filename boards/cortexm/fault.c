/* fault.c: handler of every unhandled exception: it switches the board's outputs off, then records the fault. */
#include "cortexm.h"

void board_fault_report(const uint32_t *frame, uint32_t exception);

#define SAFE_STORE(address, value) \
    __asm__ volatile("ldr r0, =%c0\n\t" \
                     "ldr r1, =%c1\n\t" \
                     "str r1, [r0]" \
                     : \
                     : "i"(address), "i"(value));

/* Calls board_fault_report() with the address of the stacked frame, on a new stack: the old one may have overflowed. */
__attribute__((naked)) void board_fault(void) {
    BOARD_SAFE_ROWS(SAFE_STORE)
    __asm__ volatile("cpsid i\n\t"
                     "mov r0, sp\n\t"
                     "mrs r1, ipsr\n\t"
                     "ldr r2, =board_fault_stack_top\n\t"
                     "mov sp, r2\n\t"
                     "ldr r2, =board_fault_report\n\t"
                     "bx r2\n\t"
                     ".ltorg");
}

#define WEAK_VECTOR(number, name) __attribute__((weak, alias("board_fault"))) void on_##name(void);
CORTEXM_VECTOR_ROWS(WEAK_VECTOR)
BOARD_VECTOR_ROWS(WEAK_VECTOR)

/* Bit of CFSR on Armv8-M. If it is set, the stack has reached its limit MSPLIM, and SP does not point to a frame. */
#define STACK_LIMIT_PASSED (1U << 20)

#define CFSR_MEMORY_ADDRESS (1U << 7)
#define CFSR_BUS_ADDRESS (1U << 15)

__attribute__((used)) _Noreturn void board_fault_report(const uint32_t *frame, uint32_t exception) {
    const uintptr_t at = (uintptr_t)frame;
    board_fault_facts facts = {.exception = exception, .sp = (uint32_t)at};
#if __ARM_ARCH >= 7
    facts.cfsr = REGISTER(SCB_CFSR);
    facts.hfsr = REGISTER(SCB_HFSR);
    if ((facts.cfsr & CFSR_BUS_ADDRESS) != 0) {
        facts.address = REGISTER(SCB_BFAR);
    } else if ((facts.cfsr & CFSR_MEMORY_ADDRESS) != 0) {
        facts.address = REGISTER(SCB_MMFAR);
    }
#endif
    if (at < (uintptr_t)board_stack_limit || (facts.cfsr & STACK_LIMIT_PASSED) != 0) {
        facts.stack = BOARD_STACK_OVERFLOW;
    } else if (at + 8U * sizeof *frame > (uintptr_t)board_stack_top) {
        facts.stack = BOARD_STACK_ASTRAY;
    } else { /* the processor has stacked r0-r3, r12, lr, pc, xpsr */
        facts.lr = frame[5];
        facts.pc = frame[6];
    }
    board_fault_ends(&facts);
}
