/* line.h: a line of text on the console, word by word. Each program that prints lines includes it once. */
#ifndef PROGRAMS_LINE_H
#define PROGRAMS_LINE_H

#include "core/text.h"
#include "hal/console.h"

/* length of the longest line, including its line end */
#ifndef LINE_BYTES
#define LINE_BYTES 160U
#endif

static char line_bytes[LINE_BYTES];
static wh_text line;

static inline void line_begin(const char *word) {
    wh_text_start(&line, line_bytes, sizeof line_bytes);
    wh_text_add(&line, word);
}

static inline void line_word(const char *word) {
    wh_text_add_char(&line, ' ');
    wh_text_add(&line, word);
}

static inline void line_number(int64_t number) {
    wh_text_add_char(&line, ' ');
    wh_text_add_signed(&line, number);
}

static inline void line_hex(uint64_t number, unsigned digits) {
    line_word("0x");
    wh_text_add_hex(&line, number, digits);
}

static inline void line_end(void) {
    wh_text_add_char(&line, '\n');
    hal_console_write(line.bytes, line.length);
}

static inline void line_of(const char *word, const char *name) {
    line_begin(word);
    line_word(name);
}

#endif
