/* text.h: numbers and words written into a caller's buffer, for consoles without printf.
 *
 *     char line[80];
 *     wh_text text;
 *     wh_text_start(&text, line, sizeof line);
 *     wh_text_add(&text, "speed ");
 *     wh_text_add_fixed(&text, speed_radps, 2);
 *     hal_console_write(text.bytes, text.length);
 *
 * Excess characters are dropped, and set `truncated`. The buffer always ends in NUL. Floats are converted exactly, in
 * integers: a float build needs no double arithmetic, and every machine prints the same characters. */
#ifndef WH_TEXT_H
#define WH_TEXT_H

#include "number/flash.h"

WH_C_BEGIN

typedef struct wh_text {
    char *bytes;     /* the caller's buffer, NUL-terminated */
    unsigned size;   /* size of the buffer, including the NUL */
    unsigned length; /* characters written so far, without the NUL */
    bool truncated;  /* true if characters were dropped */
} wh_text;

#define wh_text_start WH_NAME(wh_text_start)
#define wh_text_add WH_NAME(wh_text_add)
#define wh_text_add_char WH_NAME(wh_text_add_char)
#define wh_text_add_unsigned WH_NAME(wh_text_add_unsigned)
#define wh_text_add_signed WH_NAME(wh_text_add_signed)
#define wh_text_add_hex WH_NAME(wh_text_add_hex)
#define wh_text_add_fixed WH_NAME(wh_text_add_fixed)
#define wh_words_item WH_NAME(wh_words_item)

#define WH_TEXT_DECIMALS_MAX 18U

/* Begin an empty text in bytes[size], size >= 1. */
void wh_text_start(wh_text *text, char *bytes, unsigned size);

void wh_text_add_char(wh_text *text, char character);
void wh_text_add(wh_text *text, const char *string);

/* Returns item `number` (from 0) of a WH_WORD_LIST such as WH_WORDS("one") WH_WORDS("two"). If `number` is too large,
 * returns the last item. */
#define WH_WORDS(words) words "\0"
const char *wh_words_item(const char *list, unsigned number);

void wh_text_add_unsigned(wh_text *text, uint64_t value);
void wh_text_add_signed(wh_text *text, int64_t value);

/* Add the low `digits` (1 to 16) hexadecimal digits of `value`, in lower case, with leading zeros. */
void wh_text_add_hex(wh_text *text, uint64_t value, unsigned digits);

/* Add `value` with `decimals` digits after the point (at most WH_TEXT_DECIMALS_MAX), correctly rounded, ties to even.
 * The characters are those of C's "%.*f", except that a value that rounds to zero has no sign. NaN gives "nan",
 * infinities give "inf" and "-inf". A double of magnitude 2^128 or more gives "huge" or "-huge". */
void wh_text_add_fixed(wh_text *text, wh_real value, unsigned decimals);

WH_C_END

#endif
