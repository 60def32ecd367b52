/* show.h: polys in textbook form: collected, factored, with fractions; and the equations of motion for readers, printed
 * from the symbolic equations. host/emit prints the running code from the image; tests compare both at random states. */
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
    struct show_lets *
        lets; /* the model's `let` names that are printed in place of the sums that they stand for; NULL: none */
    /* true: a parenthesis follows, so that \cos a (b + c) would be ambiguous in LaTeX */
    bool bracketed;
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

/* === stops, frictions, holds and crossings, for readers ======================================= */

/* Prints a heading, then a line for each contact of the scene, in the order in which simultaneous events are handled.
 * Every line begins with `prefix`. Prints nothing without contacts. */
void show_events(FILE *out, const equations *e, const char *prefix, const char *heading);

/* The equations of motion, one for each coordinate, with terms collected by second derivative and factored; then the
 * first-order form. */
void show_text(FILE *out, const equations *e);
void show_latex(FILE *out, const equations *e);

/* The definitions of the printed names: `heading`, rows separated by `behind`, `footing`; nothing if no name was used. */
void show_lets_end(show *s, const char *heading, const char *behind, const char *footing);

/* Symbolic solution for the highest derivatives by Cramer's rule: top[i] over *bottom. Returns false if the result is
 * too long to read. */
bool show_closed_form(const equations *e, const poly **top, const poly **bottom);
void show_fraction(const show *s, const poly *top, const poly *bottom);

/* The calculation of a function file for Octave, between emit_octave_head() and emit_octave_end(). It defines
 * parameters, inputs and the state by name, then the equations. A variable with a reserved name gets a longer one. */
void show_octave(FILE *out, const equations *e, bool (*is_free)(const char *name));

/* The derivation: the Lagrangian; then for each coordinate its momentum, the momentum's rate, the derivatives of L and
 * F, Q, and the equation. Not for a system, which has no energies. */
void show_steps(FILE *out, const equations *e, show_style style);

#endif
