/* show.h: polys as a reader of textbooks wants them: collected, factored, fractions as fractions. */
#ifndef SHOW_SHOW_H
#define SHOW_SHOW_H

#include <stdio.h>

#include "host/algebra/poly.h"
#include "host/derive/lower.h"

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

/* === one product for readers ================================================================== */

/* value = top / bottom with small whole numbers? If not, top is the value and bottom 1. */
bool show_as_fraction(double value, double *top, double *bottom);
/* A number that belongs in front of a sum with these coefficients: all tops and all bottoms of their fractions have its
 * top and its bottom. With `whole`, the coefficients become whole numbers. */
double show_common_number(const piece *pieces, int count, bool whole);
void show_number(const show *s, double value);
/* Where a factor stands in a product: 0 parameters, 1 inputs, 2 coordinates, then the rest. */
int show_rank(const atom *x);
/* The sign between two factors, unless this is the first. */
void show_separate(const show *s, bool *first);
/* The factors above (side 1) or below (-1) the fraction bar. */
void show_factors(const show *outer, const piece *p, int side, bool *first);
int show_count_below(const piece *p);
/* size * factors, as a fraction where there is something below; a factor 1 is left out. */
void show_product(const show *s, const piece *p, double size);
/* A let, and its expression. */
typedef struct let_row {
    const symbol *let;
    const poly *value;
    bool used;
} let_row;

struct show_lets {
    int count;
    int below; /* only those before this one may be named */
    let_row row[];
};

/* The let that is *ratio times a part of p (`whole`: all of it), and *rest of p without it; NULL: none. */
const symbol *show_let(const show *s, const poly *p, bool whole, const poly **rest, double *ratio);
/* The let that is this power. */
const symbol *show_let_factor(const show *s, const atom *x, double exponent);
/* A sum in parentheses. */
void show_grouped(const show *s, const poly *p);

#endif
