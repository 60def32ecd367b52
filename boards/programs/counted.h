/* counted.h: for programs whose instructions are counted: the functions that begin and end a counted interval, memory
 * for any scene, and lines of text on the console. Only one file of a program may include it. */
#ifndef BOARDS_PROGRAMS_COUNTED_H
#define BOARDS_PROGRAMS_COUNTED_H

#include "boards/board.h"
#include "boards/programs/table.h"
#include "core/text.h"

static uint64_t memory[WH_SCENE_WORDS];

void wh_count_begin(void);
void wh_count_end(void);

/* These functions only return: the plugin counts the instructions from one to the other. The operands differ so that
 * the compiler does not merge the functions. */
__attribute__((noinline)) void wh_count_begin(void) { __asm__ volatile("" : : "i"(1) : "memory"); }
__attribute__((noinline)) void wh_count_end(void) { __asm__ volatile("" : : "i"(2) : "memory"); }

static char line_bytes[160];
static wh_text line;

static void line_begin(const char *word, const char *name) {
    wh_text_start(&line, line_bytes, sizeof line_bytes);
    wh_text_add(&line, word);
    wh_text_add_char(&line, ' ');
    wh_text_add(&line, name);
}

static void line_word(const char *word) {
    wh_text_add_char(&line, ' ');
    wh_text_add(&line, word);
}

static void line_number(unsigned number) {
    wh_text_add_char(&line, ' ');
    wh_text_add_unsigned(&line, number);
}

static void line_end(void) {
    wh_text_add_char(&line, '\n');
    hal_console_write(line.bytes, line.length);
}

/* Prints that the intervals `first` to `last` belong to this method. `more` is appended to the method's name. */
static inline void say_counted(const char *name, const char *method, const char *more,
                               unsigned first, unsigned last) {
    line_begin("count", name);
    line_word(method);
    wh_text_add(&line, more);
    line_word(WH_DOUBLE ? "double" : "float");
    line_number(first);
    line_number(last);
    line_end();
}

#endif
