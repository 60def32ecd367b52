/* fault_words.c: the facts of a fault as text. */
#include "cortexm.h"

#include "core/text.h"

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

#if __ARM_ARCH >= 7
/* The common causes (Armv7-M Architecture Reference Manual, B3.2.15). */
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
        {1U << 20, "stack limit passed"},
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

void board_fault_words(wh_text *text, const board_fault_facts *facts) {
    wh_text_add_char(text, ' ');
    wh_text_add(text, name_of(facts->exception));
    if (facts->exception >= 16) {
        wh_text_add_char(text, ' ');
        wh_text_add_unsigned(text, facts->exception - 16U);
    }
    if (facts->stack != BOARD_STACK_GOOD) {
        wh_text_add(text, facts->stack == BOARD_STACK_OVERFLOW ? ", stack overflow"
                                                               : ", stack pointer astray");
        add_register(text, ", SP", facts->sp);
    } else {
        add_register(text, ", PC", facts->pc);
        add_register(text, " LR", facts->lr);
    }
#if __ARM_ARCH >= 7
    add_register(text, " CFSR", facts->cfsr);
    add_register(text, " HFSR", facts->hfsr);
    if ((facts->cfsr & (1U << 15 | 1U << 7)) != 0) {
        add_register(text, " at", facts->address);
    }
    wh_text_add(text, " (");
    wh_text_add(text, cause_of(facts->cfsr));
    wh_text_add_char(text, ')');
#endif
}
