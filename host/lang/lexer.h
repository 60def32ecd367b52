/* lexer.h: the lexer of .whirl texts. */
#ifndef LANG_LEXER_H
#define LANG_LEXER_H

#include <stdbool.h>
#include <stddef.h>

#include "host/base/diag.h"
#include "host/number/enclosure.h"

enum {
    NAME_LENGTH_MAX = 63, /* most characters of a name */
    PRIMES_MAX = 9        /* most primes after a name */
};

typedef enum token_kind {
    TOKEN_END,
    TOKEN_NEWLINE,
    TOKEN_NAME, /* letters, digits, underscores, then `primes` primes */
    TOKEN_NUMBER,
    TOKEN_UNIT,   /* [ ... ]: `text` is between the brackets */
    TOKEN_STRING, /* " ... ": `text` is between the quotes */
    TOKEN_SIGN,   /* one of + - * / ^ ( ) { } , ; = < > or a two-character sign listed below */
    TOKEN_BAD     /* unreadable; already reported */
} token_kind;

enum { SIGN_PLUS_ASSIGN = 256, SIGN_AT_LEAST, SIGN_AT_MOST, SIGN_EQUAL, SIGN_TO };

typedef struct token {
    token_kind kind;
    int sign;
    place at;
    const char *text; /* points into the source, not terminated */
    size_t length;
    int primes;
    double number;
    enclosure exact;  /* encloses the decimal value, which a double may not represent */
    bool starts_line; /* first token of its line */
} token;

typedef struct lexer {
    place at; /* place of the next character */
    bool starts_line;
    bool stopped; /* only TOKEN_END follows */
    diags *diags;
} lexer;

/* ASCII characters, in any locale. A name begins with a letter or an underscore. */
static inline bool is_digit(int c) { return c >= '0' && c <= '9'; }
static inline bool begins_name(int c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
static inline bool continues_name(int c) { return begins_name(c) || is_digit(c); }

/* `source` must outlive the lexer. Its text must end with a zero byte after the `length` bytes. */
lexer lexer_start(const source *source, diags *diags);
token lexer_next(lexer *in);

place place_after(place from, size_t bytes);

#endif
