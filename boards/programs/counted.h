/* counted.h: for programs whose instructions are counted: the begin and end of a counted interval, memory for any
 * scene, and lines of text. Only one file of a program may include it. */
#ifndef BOARDS_PROGRAMS_COUNTED_H
#define BOARDS_PROGRAMS_COUNTED_H

#include "boards/board.h"
#include "boards/programs/line.h"
#include "boards/programs/table.h"

static uint64_t memory[WH_SCENE_WORDS];

void wh_count_begin(void);
void wh_count_end(void);

/* Empty: the plugin counts the instructions between the calls. The operands differ, so that GCC keeps two functions. */
__attribute__((noinline)) void wh_count_begin(void) { __asm__ volatile("" : : "i"(1) : "memory"); }
__attribute__((noinline)) void wh_count_end(void) { __asm__ volatile("" : : "i"(2) : "memory"); }

/* Prints that the intervals `first` to `last` belong to this method; `more` follows the method's name. */
static inline void say_counted(const char *name, const char *method, const char *more,
                               unsigned first, unsigned last) {
    line_of("count", name);
    line_word(method);
    wh_text_add(&line, more);
    line_word(WH_DOUBLE ? "double" : "float");
    line_number(first);
    line_number(last);
    line_end();
}

#endif
