/* fault_words.c: a fault's facts in words. */
#include "cortexm.h"

#include "core/packed_words.h"

#define NUMBER(number, words) number,
#define WORDS(number, words) WH_WORDS(words) "\0"

/* Of rows of words, each by a bit: those of the first whose bit is among `bits`; what stands behind all rows, if none is. */
static const char *first_of(uint32_t bits, const uint8_t *bit, unsigned rows, const char *words) {
    unsigned i = 0;
    while (i < rows && (bits >> bit[i] & 1U) == 0) {
        i++;
    }
    return wh_words_item(words, i);
}

#define INTERRUPT 16U /* the first that is the chip's */
#define EXCEPTION_ROWS(X) \
    X(2, "NMI") \
    X(3, "HardFault") \
    X(4, "MemManage") \
    X(5, "BusFault") \
    X(6, "UsageFault") \
    X(11, "SVCall") \
    X(12, "DebugMonitor") \
    X(14, "PendSV") \
    X(15, "SysTick") \
    X(INTERRUPT, "unexpected interrupt")

static const char *name_of(uint32_t exception) {
    static const uint8_t numbers[] = {EXCEPTION_ROWS(NUMBER)};
    static const char names[] = EXCEPTION_ROWS(WORDS) WH_WORDS("reserved exception");
    return first_of(1U << (exception < INTERRUPT ? exception : INTERRUPT), numbers, sizeof numbers,
                    names);
}

static void add_register(wh_text *text, const char *name, uint32_t value) {
    wh_text_add(text, name);
    wh_text_add(text, " 0x");
    wh_text_add_hex(text, value, 8);
}

#if __ARM_ARCH >= 7
/* The causes that come up in practice (Armv7-M Architecture Reference Manual, B3.2.15). */
#define CAUSE_ROWS(X) \
    X(0, "instruction fetch denied") \
    X(1, "data access denied") \
    X(4, "stack unusable") \
    X(8, "instruction fetch failed") \
    X(9, "bus error") \
    X(10, "imprecise bus error") \
    X(12, "stack unusable") \
    X(16, "undefined instruction") \
    X(17, "jump to a non-Thumb address") \
    X(18, "bad exception return") \
    X(19, "no FPU or FPU switched off") \
    X(20, "stack limit passed") \
    X(24, "unaligned access") \
    X(25, "division by zero")

static const char *cause_of(uint32_t cfsr) {
    static const uint8_t bits[] = {CAUSE_ROWS(NUMBER)};
    static const char causes[] = CAUSE_ROWS(WORDS) WH_WORDS("no cause given");
    return first_of(cfsr, bits, sizeof bits, causes);
}

static void add_status(wh_text *text, const board_fault_facts *facts) {
    add_register(text, " CFSR", facts->cfsr);
    add_register(text, " HFSR", facts->hfsr);
    if ((facts->cfsr & (1U << 15 | 1U << 7)) != 0) {
        add_register(text, " at", facts->address);
    }
    wh_text_add(text, " (");
    wh_text_add_words(text, cause_of(facts->cfsr));
    wh_text_add_char(text, ')');
}
#else
static void add_status(wh_text *text, const board_fault_facts *facts) {
    (void)text;
    (void)facts;
}
#endif

void board_fault_words(wh_text *text, const board_fault_facts *facts) {
    wh_text_add_char(text, ' ');
    wh_text_add_words(text, name_of(facts->exception));
    if (facts->exception >= INTERRUPT) {
        wh_text_add_char(text, ' ');
        wh_text_add_unsigned(text, facts->exception - INTERRUPT);
    }
    if (facts->stack != BOARD_STACK_GOOD) {
        wh_text_add_words(text, facts->stack == BOARD_STACK_OVERFLOW
                                    ? WH_WORDS(", stack overflow")
                                    : WH_WORDS(", stack pointer astray"));
        add_register(text, ", SP", facts->sp);
    } else {
        add_register(text, ", PC", facts->pc);
        add_register(text, " LR", facts->lr);
    }
    add_status(text, facts);
}
