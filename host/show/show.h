/* show.h: polys as a reader of textbooks wants them: collected, factored, fractions as fractions. */
#ifndef SHOW_SHOW_H
#define SHOW_SHOW_H

#include <stdio.h>

#include "host/algebra/poly.h"

typedef enum show_style { SHOW_TEXT, SHOW_LATEX } show_style;

typedef struct show {
    FILE *out;
    show_style style;
    algebra *algebra;
    const char *(*name)(const void *names, const symbol *sym, int primes); /* NULL: the file's */
    const void *names;
    struct show_lets *lets; /* names of the file for sums; NULL: none */
    bool
        bracketed; /* a parenthesis follows: in LaTeX a function's symbol has its own, not \cos a (b + c) */
} show;
typedef struct show_lets show_lets;

/* A row of LaTeX, "LEFT &= RIGHT", that is broken into lines of at most 100 visible characters. */
typedef struct show_row {
    FILE *out;
    char *text;
    size_t length;
    show inner;
} show_row;

/* Returns what the row is written with. In text it is written as it stands. */
show *show_row_begin(show_row *row, const show *s);
void show_row_end(show_row *row);

show show_start(FILE *out, show_style style, algebra *a);

/* A symbol with its primes: theta1'', \ddot{\theta}_{1}. */
void show_symbol(const show *s, const symbol *sym, int primes);

/* Terms with the same rates and accelerations are collected and their coefficients factored;
 * accelerations first, then rates, then the rest. Zero is "0". Collecting and factoring makes products: where
 * the algebra overflows with them, or has before, the terms are printed as they are. */
void show_poly(const show *s, const poly *p);

/* Terms that show_poly() would print, before factoring: to judge whether a formula is readable. */
int show_size(const poly *p);

/* The atoms that every term of p has, in the lowest power found: a single term. */
const poly *show_common(algebra *a, const poly *p);

#endif
