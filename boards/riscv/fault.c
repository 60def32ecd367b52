/* fault.c: after a trap, reports its kind and address and ends the program with a failure. */
#include "riscv.h"

#include "boards/board.h"
#include "core/text.h"

_Noreturn void board_fault_report(uint32_t stack_pointer);

/* The report has its own stack, because the old one is unusable after an overflow. mtvec requires word alignment. */
__attribute__((naked, aligned(4))) void board_fault(void) {
    __asm__ volatile(".option norelax\n\t"
                     "mv a0, sp\n\t"
                     "la sp, board_fault_stack_top\n\t"
                     "j board_fault_report");
}

static const char *name_of(uint32_t cause) {
    static const char *const names[] = {
        "instruction address misaligned",
        "instruction access fault",
        "illegal instruction",
        "breakpoint",
        "load address misaligned",
        "load access fault",
        "store address misaligned",
        "store access fault",
        "environment call",
        "environment call",
        "reserved exception",
        "environment call",
    };
    if ((cause >> 31) != 0) {
        return "unexpected interrupt";
    }
    return cause < sizeof names / sizeof names[0] ? names[cause] : "unknown exception";
}

static void add_register(wh_text *text, const char *name, uint32_t value) {
    wh_text_add(text, name);
    wh_text_add(text, " 0x");
    wh_text_add_hex(text, value, 8);
}

__attribute__((used)) _Noreturn void board_fault_report(uint32_t stack_pointer) {
    char line[160];
    wh_text text;
    uint32_t cause;
    uint32_t where;
    uint32_t address;
    CSR_READ("mcause", cause);
    CSR_READ("mepc", where);
    CSR_READ("mtval", address);
    wh_text_start(&text, line, sizeof line);
    wh_text_add(&text, "\nfault: ");
    wh_text_add(&text, name_of(cause));
    if (stack_pointer < (uint32_t)(uintptr_t)board_stack_limit) {
        wh_text_add(&text, ", stack overflow");
    } else if (stack_pointer > (uint32_t)(uintptr_t)board_stack_top) {
        wh_text_add(&text, ", stack pointer astray");
    }
    add_register(&text, ", SP", stack_pointer);
    add_register(&text, " PC", where);
    add_register(&text, " mcause", cause);
    add_register(&text, " mtval", address);
    wh_text_add_char(&text, '\n');
    uart_start();
    uart_write(text.bytes, text.length);
    board_exit(70);
}
