/* show.h: polys in textbook form: collected, factored, with fractions. */
#ifndef SHOW_SHOW_H
#define SHOW_SHOW_H

#include <stdio.h>

#include "host/algebra/poly.h"
#include "host/derive/equations.h"
#include "host/derive/lower.h"

typedef enum show_style { SHOW_TEXT, SHOW_LATEX } show_style;

typedef struct show {
    FILE *out;
    show_style style;
    algebra *algebra;
    const char *(*name)(const void *names, const symbol *sym, int primes); /* NULL: the file's */
    const void *names;
    struct show_lets *lets; /* names of the file for sums; NULL without names */
    bool
        bracketed; /* a parenthesis follows, so in LaTeX a function's argument needs one, too, not \cos
                    * a (b + c) */
} show;
typedef struct show_lets show_lets;

/* A row of LaTeX, "LEFT &= RIGHT", to be broken into lines that fit a page. */
typedef struct show_row {
    FILE *out;
    char *text;
    size_t length;
    show inner;
} show_row;

/* Returns the show for writing the row. Text is written without line breaks. */
show *show_row_begin(show_row *row, const show *s);
void show_row_end(show_row *row);

show show_start(FILE *out, show_style style, algebra *a);

/* A symbol with its primes: theta1'', \ddot{\theta}_{1}. */
void show_symbol(const show *s, const symbol *sym, int primes);

/* Terms with the same rates and accelerations are collected and their coefficients factored: accelerations first, then
 * rates, then the others. Zero is "0". Collecting and factoring makes products. If the algebra overflows, now or
 * earlier, the terms are printed as they are. */
void show_poly(const show *s, const poly *p);

/* The product of the atoms common to all terms of p, each in its lowest power. */
const poly *show_common(algebra *a, const poly *p);

/* === one product for readers ================================================================== */

/* A common factor of these coefficients: its numerator divides all their numerators, its denominator all their
 * denominators. If `whole`, the coefficients divided by the factor are whole numbers. */
double show_common_number(const piece *pieces, int count, bool whole);
void show_number(const show *s, double value);
/* The sign between two factors, unless this is the first. */
void show_separate(const show *s, bool *first);
typedef struct let_row {
    const symbol *let;
    const poly *value;
    bool used;
} let_row;

struct show_lets {
    int count;
    int below; /* only lets before this one may be used */
    let_row row[];
};

/* From now on, sums and functions with a name in the file (`let`) are printed as that name. */
void show_lets_begin(show *s, const equations *e);
/* A sum in parentheses. */
void show_grouped(const show *s, const poly *p);

#endif
