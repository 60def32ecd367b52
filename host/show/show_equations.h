/* show_equations.h: the equations of motion for readers, printed from the equations themselves: what runs is printed
 * from the image by host/emit, and tests hold both against each other at random states. */
#ifndef SHOW_SHOW_EQUATIONS_H
#define SHOW_SHOW_EQUATIONS_H

#include <stdio.h>

#include "host/derive/equations.h"
#include "host/show/show.h"

/* The equations of motion, one a coordinate, terms collected by second derivative and factored; then
 * the first-order form. */
void show_text(FILE *out, const equations *e);
void show_latex(FILE *out, const equations *e);

/* One equation of motion: "LEFT = RIGHT", in LaTeX "LEFT &= RIGHT". */
void show_equation(const show *s, const equations *e, int i);

/* From here on, sums and functions that have a name in the file (`let`) are printed by it. */
void show_lets_begin(show *s, const equations *e);
/* The definitions of those that were printed: `heading`, rows with `behind` between them, `footing`; nothing where there
 * are none. */
void show_lets_end(show *s, const char *heading, const char *behind, const char *footing);

/* y(1) ... y(N): values first, then rates, and so on, as the dissertation numbers them. */
int show_y_number(const equations *e, int unknown_index, int primes);

/* Solves for the highest derivatives by Cramer's rule in symbols: top[i] over *bottom. False where the result would not
 * be readable. */
bool show_closed_form(const equations *e, const poly **top, const poly **bottom);
void show_fraction(const show *s, const poly *top, const poly *bottom);

/* The calculation of a function file for Octave, between emit_octave_head() and emit_octave_end(): parameters, inputs and
 * the state with their names, then the equations. A variable whose name is not free gets a longer one. */
void show_octave(FILE *out, const equations *e, bool (*is_free)(const char *name));

/* How they come about: the Lagrangian; then of each coordinate its momentum, the momentum's rate, the slopes of L and F, Q, and
 * the equation. Not of a system, which has no energies. */
void show_steps(FILE *out, const equations *e, show_style style);

#endif
