/* show_equations.h: the equations of motion for readers, printed from the symbolic equations. host/emit prints the
 * running code from the image; tests compare both at random states. */
#ifndef SHOW_SHOW_EQUATIONS_H
#define SHOW_SHOW_EQUATIONS_H

#include <stdio.h>

#include "host/derive/equations.h"
#include "host/show/show.h"

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
