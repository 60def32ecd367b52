/* c_read.h: reads generated C: its words, its blocks and the values of its operations. Angles are in radians.
 * Functions, leaves and tables get made-up values from their names and arguments, so that two of them differ. */
#ifndef TESTS_HOST_C_READ_H
#define TESTS_HOST_C_READ_H

#include "test.h"

typedef struct c_word {
    const char *at;
    int length;
} c_word;

typedef struct c_file {
    char *text; /* without comments */
    c_word *word;
    int words;
} c_file;

/* Drops comments and preprocessor lines, except for the names that these define. */
c_file c_file_of(const char *text);
void c_file_free(c_file *f);

bool c_is(const c_file *f, int i, const char *word);
/* The word after the first match of `words` (parted by blanks) from word `from` on; -1 without a match. */
int c_behind(const c_file *f, int from, const char *words);
/* The same; fails the test without a match. */
int c_need(const c_file *f, int from, const char *words);
/* Joins words i to `end` - 1 with blanks in text[size]. */
void c_text(const c_file *f, int i, int end, char *text, size_t size);
/* The bracket that closes the one at word i. */
int c_closing(const c_file *f, int i);
/* The number at word i, with or without WH_R(...) and a sign. *i moves past it. */
double c_number(const c_file *f, int *i);

/* Fails the test, with `what`, on names that a compiler would reject or warn of: undeclared or unused ones. */
void c_expect_whole(const c_file *f, const char *what);

enum { C_NAMES = 300 };

/* Results of a function's statements, by number: x3, s3 and c3, result[3]. */
typedef struct c_values {
    double x[C_NAMES], s[C_NAMES], c[C_NAMES], result[C_NAMES];
    bool has_x[C_NAMES], has_s[C_NAMES], has_c[C_NAMES], has_result[C_NAMES];
    double row[C_NAMES]; /* phase of row3, y3 and back3 */
} c_values;

/* Runs the body of the named function. Its results go to the array `result`. */
void c_run(const c_file *f, const char *function, const char *result, c_values *v);

/* The made-up values. */
double c_leaf(const char *name, int index);
double c_called(const char *name, double x, double y);
double c_looked_up(const char *form, double phase, int number);
double c_mirrored(double value, double phase);

#endif
