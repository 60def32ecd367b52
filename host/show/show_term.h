/* show_term.h: one product for readers. For host/show's own files. */
#ifndef SHOW_SHOW_TERM_H
#define SHOW_SHOW_TERM_H

#include "host/derive/pieces.h"
#include "show.h"

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
