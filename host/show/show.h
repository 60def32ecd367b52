/* show.h: polys in textbook form (collected, factored, with fractions), and the symbolic equations of motion for
 * readers. host/emit prints the running code from the image; tests compare both at random states. */
#ifndef SHOW_SHOW_H
#define SHOW_SHOW_H

#include <stdio.h>

#include "host/algebra/poly.h"
#include "host/derive/equations.h"
#include "host/image/lower.h"

typedef enum show_style { SHOW_TEXT, SHOW_LATEX } show_style;

typedef struct show {
    FILE *out;
    show_style style;
    algebra *algebra;
    const char *(*name)(const void *names, const symbol *sym,
                        int primes); /* NULL: the file's names */
    const void *names;
    struct show_lets *lets; /* lets whose names are printed instead of their values, or NULL */
    bool bracketed;         /* a parenthesis follows: in LaTeX, \cos a (b + c) would be ambiguous */
} show;
typedef struct show_lets show_lets;

/* A row of LaTeX, "LEFT &= RIGHT", to be broken into lines that fit a page. */
typedef struct show_row {
    FILE *out;
    char *text;
    size_t length;
    show inner;
} show_row;

/* Returns the show that writes the row. SHOW_TEXT writes the row to s->out at once, without line breaks. */
show *show_row_begin(show_row *row, const show *s);
void show_row_end(show_row *row);

show show_start(FILE *out, show_style style, algebra *a);

/* Prints theta1'' or \ddot{\theta}_{1}. */
void show_symbol(const show *s, const symbol *sym, int primes);

/* Prints p, collected by accelerations, then rates, with factored coefficients. Zero is "0". After an overflow of the
 * algebra, prints the terms as they are. */
void show_poly(const show *s, const poly *p);

/* The product of the atoms common to all terms of p, each in its lowest power. */
const poly *show_common(algebra *a, const poly *p);

/* === products ================================================================================= */

/* Returns a common factor of the coefficients. `whole`: division by this factor also removes small denominators. */
double show_common_number(const piece *pieces, int count, bool whole);
void show_number(const show *s, double value);
/* Prints the sign between two factors. */
void show_times(const show *s);
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
/* Prints a sum in parentheses. */
void show_grouped(const show *s, const poly *p);

/* === stops, frictions, holds and crossings, for readers ======================================= */

/* Prints `heading` and a line for each contact, in the order in which simultaneous events are handled. Each line begins
 * with `prefix`. If there are no contacts, prints nothing. */
void show_events(FILE *out, const equations *e, const char *prefix, const char *heading);

/* Print the equations. show_text() adds the first-order form; show_latex() adds the closed form if it is short. */
void show_text(FILE *out, const equations *e);
void show_latex(FILE *out, const equations *e);

/* Defines the printed `let` names, if any: prints `heading`, the definitions separated by `behind`, and `footing`. */
void show_lets_end(show *s, const char *heading, const char *behind, const char *footing);

/* Cramer's rule for the highest derivatives: top[i] over *bottom. Returns false if the result is too long to read. */
bool show_closed_form(const equations *e, const poly **top, const poly **bottom);
void show_fraction(const show *s, const poly *top, const poly *bottom);

/* Prints the calculation between emit_octave_head() and emit_octave_end(): parameters, inputs and state by name, then
 * the equations. A variable with a reserved name gets a longer one. */
void show_octave(FILE *out, const equations *e, bool (*is_free)(const char *name));

/* Prints the derivation of each equation of motion from the Lagrangian. A system of equations has no Lagrangian. */
void show_steps(FILE *out, const equations *e, show_style style);

#endif
