#include "lexer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/spelling.h"
#include "host/lang/words.h"
#include "host/number/decimal.h"

enum { NUMBER_LENGTH_MAX = 100 };

static int at_offset(const lexer *in, size_t ahead) {
    const source *text = in->at.source;
    const size_t offset = in->at.offset + ahead;
    return offset < text->length ? (unsigned char)text->text[offset] : -1;
}

/* Advances by one byte. Columns count characters, so UTF-8 continuation bytes do not count. */
static void step_over(place *at) {
    const unsigned char c = (unsigned char)at->source->text[at->offset++];
    if (c == '\n') {
        at->line++;
        at->column = 1;
    } else if (at->offset >= at->source->length ||
               ((unsigned char)at->source->text[at->offset] & 0xc0) != 0x80) {
        at->column++;
    }
}

static void advance(lexer *in, size_t bytes) {
    for (size_t i = 0; i < bytes; i++) {
        step_over(&in->at);
    }
}

place place_after(place from, size_t bytes) {
    for (size_t i = 0; i < bytes && from.offset < from.source->length; i++) {
        step_over(&from);
    }
    return from;
}

/* Reports a carriage return without a line feed: it would not end a # comment. */
static void check_line_ends(const lexer *in) {
    const source *text = in->at.source;
    const char *at = text->text + in->at.offset;
    const char *end = text->text + text->length;
    while ((at = memchr(at, '\r', (size_t)(end - at))) != NULL) {
        if (at + 1 < end && at[1] != '\n') {
            const size_t bytes = (size_t)(at - text->text) - in->at.offset;
            diag_error(in->diags, place_after(in->at, bytes),
                       "end each line with a line feed, or with a carriage return and a line feed",
                       "a carriage return within a line");
            return;
        }
        at++;
    }
}

lexer lexer_start(const source *text, diags *all) {
    lexer in = {{text, 1, 1, 0}, true, false, all};
    if (text->length >= 3 && memcmp(text->text, "\xef\xbb\xbf", 3) == 0) {
        in.at.offset = 3; /* after the byte order mark */
    }
    check_line_ends(&in);
    return in;
}

/* Reports a comment in the form of another language, and skips it. Returns false if there is none. */
static bool skip_foreign_comment(lexer *in) {
    const int c = at_offset(in, 0);
    const int next = at_offset(in, 1);
    if (c != '%' && (c != '/' || (next != '/' && next != '*'))) {
        return false;
    }
    diag_error(in->diags, in->at, "begin a comment with #", "unexpected '%.*s'", c == '%' ? 1 : 2,
               in->at.source->text + in->at.offset);
    const bool block = next == '*';
    advance(in, block ? 2 : 1);
    while (at_offset(in, 0) > 0 && (block || at_offset(in, 0) != '\n')) {
        const bool ends = block && at_offset(in, 0) == '*' && at_offset(in, 1) == '/';
        advance(in, ends ? 2 : 1);
        if (ends) {
            break;
        }
    }
    return true;
}

static void skip_space(lexer *in) {
    for (;;) {
        const int c = at_offset(in, 0);
        if (skip_foreign_comment(in)) {
            continue;
        }
        if (c == '#') {
            while (at_offset(in, 0) != '\n' && at_offset(in, 0) > 0) {
                advance(in, 1);
            }
        } else if (c == ' ' || c == '\t' || c == '\r') {
            advance(in, 1);
        } else {
            return;
        }
    }
}

static size_t behind_digits(const lexer *in, size_t from) {
    while (is_digit(at_offset(in, from))) {
        from++;
    }
    return from;
}

static void read_number(lexer *in, token *made) {
    size_t length = behind_digits(in, 0);
    /* the dots of a range such as 1..2 are not part of the number */
    if (at_offset(in, length) == '.' && at_offset(in, length + 1) != '.') {
        length = behind_digits(in, length + 1);
    }
    const int mark = at_offset(in, length);
    if (mark == 'e' || mark == 'E') {
        const int sign = at_offset(in, length + 1);
        const size_t digits = length + (sign == '+' || sign == '-' ? 2 : 1);
        length = is_digit(at_offset(in, digits)) ? behind_digits(in, digits) : length;
    }
    made->kind = TOKEN_NUMBER;
    made->length = length;
    char digits[NUMBER_LENGTH_MAX + 1];
    if (length > NUMBER_LENGTH_MAX) {
        diag_error(in->diags, made->at, NULL, "this number has more than %d characters",
                   NUMBER_LENGTH_MAX);
        made->kind = TOKEN_BAD;
    } else {
        memcpy(digits, made->text, length);
        digits[length] = '\0';
        int side;
        made->number = decimal_read_side(digits, NULL, &side);
        made->exact = (enclosure){side < 0 ? enclosure_below(made->number) : made->number,
                                  side > 0 ? enclosure_above(made->number) : made->number};
        if (isinf(made->number)) {
            diag_error(in->diags, made->at, NULL,
                       "this number is too large (1.7e308 is the limit)");
            made->kind = TOKEN_BAD;
        } else if (made->number == 0.0 && strcspn(digits, "123456789") < strcspn(digits, "eE")) {
            diag_error(in->diags, made->at, "write 0, or at least 5e-324",
                       "this number is too small to be distinguished from zero");
            made->kind = TOKEN_BAD;
        }
    }
    advance(in, length);
}

static void read_name(lexer *in, token *made) {
    size_t length = 0;
    while (continues_name(at_offset(in, length))) {
        length++;
    }
    made->kind = TOKEN_NAME;
    made->length = length;
    size_t primes = 0;
    while (at_offset(in, length + primes) == '\'') {
        primes++;
    }
    made->primes = primes > PRIMES_MAX ? PRIMES_MAX : (int)primes;
    if (length > NAME_LENGTH_MAX) {
        diag_error(in->diags, made->at, NULL, "this name is longer than %d characters",
                   NAME_LENGTH_MAX);
        made->kind = TOKEN_BAD;
    } else if (primes > PRIMES_MAX) {
        diag_error(in->diags, place_after(made->at, length), NULL, "more than %d primes",
                   PRIMES_MAX);
        made->kind = TOKEN_BAD;
    }
    advance(in, length + primes);
}

/* A string ends on its line. It must be UTF-8 text without control characters, except for tabs. */
static void read_string(lexer *in, token *made) {
    size_t length = 1;
    int c = at_offset(in, length);
    bool is_clean = true; /* allows \r: check_line_ends() has reported it */
    bool is_utf8 = true;
    while (c > 0 && c != '"' && c != '\n') {
        const size_t left = in->at.source->length - in->at.offset - length;
        const size_t bytes = utf8_length(made->text + length, left);
        is_clean = is_clean && (c >= 0x20 || c == '\t' || c == '\r') && c != 0x7f;
        is_utf8 = is_utf8 && bytes > 0;
        length += bytes > 0 ? bytes : 1;
        c = at_offset(in, length);
    }
    made->kind = TOKEN_STRING;
    made->text++;
    made->length = length - 1;
    if (c != '"') {
        diag_error(in->diags, made->at, "end the text with \" on the line on which it begins",
                   "this text is not closed");
        made->kind = TOKEN_BAD;
        length--; /* there is no closing quote to skip */
    } else if (!is_clean || !is_utf8) {
        diag_error(in->diags, made->at, is_clean ? "save the file as UTF-8" : NULL,
                   is_clean ? "this text is not UTF-8" : "a control character in this text");
        made->kind = TOKEN_BAD;
    }
    advance(in, length + 1);
}

static void read_unit(lexer *in, token *made) {
    size_t length = 1;
    int c = at_offset(in, length);
    while (c > 0 && strchr("[]#\"={};,", c) == NULL) {
        c = at_offset(in, ++length);
    }
    made->kind = TOKEN_UNIT;
    made->text++;
    made->length = length - 1;
    if (c == ']') {
        advance(in, length + 1);
        return;
    }
    const char *text = in->at.source->text;
    size_t before = made->at.offset;
    while (before > 0 && text[before - 1] == ' ') {
        before--;
    }
    diag_error(in->diags, made->at,
               before > 0 && text[before - 1] == '='
                   ? "there are no matrices: give each number a name"
                   : "write the unit like this: 2 [N*s/m]",
               "this unit is not closed with ']'");
    made->kind = TOKEN_BAD;
    while (at_offset(in, 0) > 0 && at_offset(in, 0) != '\n') {
        advance(in, 1);
    }
}

static void read_stray(lexer *in, token *made) {
    const int c = at_offset(in, 0);
    made->kind = TOKEN_BAD;
    if (c >= 0x80) {
        diag_error(in->diags, made->at,
                   ascii_hint(made->text, in->at.source->length - in->at.offset,
                              "other letters may stand in comments and in quoted texts"),
                   "names, numbers and signs are written in ASCII");
        while (at_offset(in, 0) >= 0x80) {
            advance(in, 1);
        }
        return;
    }
    if (c == '\'') {
        diag_error(in->diags, made->at, "write theta' without a space",
                   "a prime must stand directly after a name");
    } else if (c == ']') {
        diag_error(in->diags, made->at, NULL, "']' without '['");
    } else if (c < 0x20 || c == 0x7f) {
        diag_error(in->diags, made->at, NULL, "control character %d in the text", c);
    } else {
        const char sign = (char)c;
        const int next = at_offset(in, 1);
        const bool each = c == '.' && next > 0 &&
                          strchr("*/^", next) !=
                              NULL; /* .*, ./ and .^ are operators of matrices in other languages */
        diag_error(in->diags, made->at,
                   each ? "write the operators *, / and ^ without a point"
                        : first_word_hint(&sign, 1),
                   "unexpected character '%c'", c);
    }
    advance(in, 1);
}

static void read_sign(lexer *in, token *made) {
    static const struct {
        char text[3];
        int sign;
    } pairs[] = {{"+=", SIGN_PLUS_ASSIGN},
                 {">=", SIGN_AT_LEAST},
                 {"<=", SIGN_AT_MOST},
                 {"==", SIGN_EQUAL},
                 {"..", SIGN_TO}};
    const int c = at_offset(in, 0);
    int sign = c;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if (c == pairs[i].text[0] && at_offset(in, 1) == pairs[i].text[1]) {
            sign = pairs[i].sign;
        }
    }
    if (sign == c && strchr("+-*/^(){},;=<>", c) == NULL) {
        read_stray(in, made);
        return;
    }
    made->kind = TOKEN_SIGN;
    made->sign = sign;
    made->length = sign == c ? 1 : 2;
    advance(in, made->length);
}

token lexer_next(lexer *in) {
    skip_space(in);
    token made = {.kind = TOKEN_END, .at = in->at, .starts_line = in->starts_line};
    made.text = in->at.source->text + in->at.offset;
    const int c = at_offset(in, 0);
    if (c < 0 || in->stopped || diags_count(in->diags) > DIAG_MAX) {
        in->stopped = true;
        made.starts_line = true;
        return made;
    }
    if (c == 0) {
        diag_error(in->diags, in->at, NULL, "a zero byte: this is not a text file");
        in->stopped = true;
        made.kind = TOKEN_BAD;
        return made;
    }
    in->starts_line = c == '\n';
    if (c == '\n') {
        made.kind = TOKEN_NEWLINE;
        made.length = 1;
        advance(in, 1);
    } else if (begins_name(c)) {
        read_name(in, &made);
    } else if (is_digit(c) || (c == '.' && is_digit(at_offset(in, 1)))) {
        read_number(in, &made);
    } else if (c == '"') {
        read_string(in, &made);
    } else if (c == '[') {
        read_unit(in, &made);
    } else {
        read_sign(in, &made);
    }
    return made;
}
