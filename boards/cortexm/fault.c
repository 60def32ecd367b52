/* fault.c: a fault says what happened and where, then ends the program with a failure. */
#include "cortexm.h"

#include "boards/board.h"
#include "core/text.h"

void board_fault_report(const uint32_t *frame, uint32_t exception);

/* The stacked frame is where SP points (this program runs on the main stack only). The report runs
 * on a stack of its own: after an overflow the old one is of no use. */
__attribute__((naked)) void board_fault(void) {
    __asm__ volatile("mov r0, sp\n\t"
                     "mrs r1, ipsr\n\t"
                     "ldr r2, =board_fault_stack_top\n\t"
                     "mov sp, r2\n\t"
                     "ldr r2, =board_fault_report\n\t"
                     "bx r2\n\t"
                     ".ltorg");
}

static const char *name_of(uint32_t exception) {
    switch (exception) {
    case 2: return "NMI";
    case 3: return "HardFault";
    case 4: return "MemManage";
    case 5: return "BusFault";
    case 6: return "UsageFault";
    case 11: return "SVCall";
    case 12: return "DebugMonitor";
    case 14: return "PendSV";
    case 15: return "SysTick";
    default: return exception < 16 ? "reserved exception" : "unexpected interrupt";
    }
}

static void add_register(wh_text *text, const char *name, uint32_t value) {
    wh_text_add(text, name);
    wh_text_add(text, " 0x");
    wh_text_add_hex(text, value, 8);
}

/* Armv8-M's, when the stack pointer would have passed MSPLIM; nothing was stacked below it then. */
#define STACK_LIMIT_PASSED (1U << 20)

#if __ARM_ARCH >= 7
/* The causes that come up in practice (Armv7-M Architecture Reference Manual, B3.2.15). */
static const char *cause_of(uint32_t cfsr) {
    static const struct {
        uint32_t bit;
        const char *text;
    } causes[] = {
        {1U << 0, "instruction fetch denied"},
        {1U << 1, "data access denied"},
        {1U << 4, "stack unusable"},
        {1U << 8, "instruction fetch failed"},
        {1U << 9, "bus error"},
        {1U << 10, "imprecise bus error"},
        {1U << 12, "stack unusable"},
        {1U << 16, "undefined instruction"},
        {1U << 17, "jump to a non-Thumb address"},
        {1U << 18, "bad exception return"},
        {1U << 19, "no FPU or FPU switched off"},
        {STACK_LIMIT_PASSED, "stack limit passed"},
        {1U << 24, "unaligned access"},
        {1U << 25, "division by zero"},
    };
    for (unsigned i = 0; i < sizeof causes / sizeof causes[0]; i++) {
        if ((cfsr & causes[i].bit) != 0) {
            return causes[i].text;
        }
    }
    return "no cause given";
}
#endif

__attribute__((used)) _Noreturn void board_fault_report(const uint32_t *frame, uint32_t exception) {
    char line[240];
    wh_text text;
    const uintptr_t at = (uintptr_t)frame;
#if __ARM_ARCH >= 7
    const uint32_t cfsr = REGISTER(SCB_CFSR);
#else
    const uint32_t cfsr = 0;
#endif
    const bool overflow = at < (uintptr_t)board_stack_limit || (cfsr & STACK_LIMIT_PASSED) != 0;
    wh_text_start(&text, line, sizeof line);
    wh_text_add(&text, "\nfault: ");
    wh_text_add(&text, name_of(exception));
    if (exception >= 16) {
        wh_text_add_char(&text, ' ');
        wh_text_add_unsigned(&text, exception - 16U);
    }
    if (overflow || at + 8U * sizeof *frame > (uintptr_t)board_stack_top) {
        wh_text_add(&text, overflow ? ", stack overflow" : ", stack pointer astray");
        add_register(&text, ", SP", (uint32_t)at);
    } else {
        /* r0-r3, r12, lr, pc, xpsr */
        add_register(&text, ", PC", frame[6]);
        add_register(&text, " LR", frame[5]);
    }
#if __ARM_ARCH >= 7
    add_register(&text, " CFSR", cfsr);
    add_register(&text, " HFSR", REGISTER(SCB_HFSR));
    if ((cfsr & (1U << 15)) != 0) {
        add_register(&text, " at", REGISTER(SCB_BFAR));
    } else if ((cfsr & (1U << 7)) != 0) {
        add_register(&text, " at", REGISTER(SCB_MMFAR));
    }
    wh_text_add(&text, " (");
    wh_text_add(&text, cause_of(cfsr));
    wh_text_add_char(&text, ')');
#endif
    wh_text_add_char(&text, '\n');
    uart_start();
    uart_write(text.bytes, text.length);
    board_exit(70);
}
