/* c_read.h: reads generated C: its words, what stands between its braces, and what its operations come to. Angles are taken in
 * radians; what is no operation (a function, a leaf, a table) has a made-up value of its name and arguments, by which two of
 * them differ. */
#ifndef TESTS_HOST_C_READ_H
#define TESTS_HOST_C_READ_H

#include <stdbool.h>
#include <stddef.h>

typedef struct c_word {
    const char *at;
    int length;
} c_word;

typedef struct c_file {
    char *text; /* without comments */
    c_word *word;
    int words;
} c_file;

/* Comments, and lines of the preprocessor but for their names, are left out. */
c_file c_file_of(const char *text);
void c_file_free(c_file *f);

/* Is word i this one? */
bool c_is(const c_file *f, int i, const char *word);
/* Behind the first place, from word `from` on, where these words stand, parted by blanks; -1: nowhere. */
int c_behind(const c_file *f, int from, const char *words);
/* The same, which must be there. */
int c_need(const c_file *f, int from, const char *words);
/* Words i and on, up to before word `end`, blanks between them, in text[size]. */
void c_text(const c_file *f, int i, int end, char *text, size_t size);
/* The bracket that closes the one at word i. */
int c_closing(const c_file *f, int i);
/* The number that word i is, WH_R(...) and a sign around it or not; *i goes behind it. */
double c_number(const c_file *f, int *i);

/* Fails the test where a compiler would: a name that is used and not there, or there and not used, in functions and in the
 * whole file. `what` is told then. */
void c_expect_whole(const c_file *f, const char *what);

/* --- values ------------------------------------------------------------------------------------------------ */

enum { C_NAMES = 300 };

/* What a function's statements give, by number: x3, s3 and c3, result[3]. */
typedef struct c_values {
    double x[C_NAMES], s[C_NAMES], c[C_NAMES], result[C_NAMES];
    bool has_x[C_NAMES], has_s[C_NAMES], has_c[C_NAMES], has_result[C_NAMES];
    double row[C_NAMES]; /* the phase that row3, y3 and back3 are of */
} c_values;

/* Run what stands between the braces of the function of this name, whose results go to the array `result`. */
void c_run(const c_file *f, const char *function, const char *result, c_values *v);

/* The made-up values. */
double c_leaf(const char *name, int index);
double c_called(const char *name, double x, double y);
double c_looked_up(const char *form, double phase, int number);
double c_mirrored(double value, double phase);

#endif
