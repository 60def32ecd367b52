/* tube.h: a tube round the exact motion, from its start on: at each time a box in which it lies, proved.
 *
 * Steps as Lohner's (Enclosing the solutions of ordinary initial and boundary value problems, 1987; Nedialkov, Jackson,
 * Corliss, Validated solutions of initial value problems, 1999): over [0, h] the motion stays in a box that its own
 * Taylor series leads back into; then x(t + tau) is the Taylor polynomial from the middle of what is known, plus the
 * polynomial's slopes times how far the motion may be off the middle, plus the remainder, of that box. What may be off is kept as a
 * box along axes that turn with the motion. All in enclosures: rounding is in it, and so are parameters that no double
 * is. */
#ifndef PROVE_TUBE_H
#define PROVE_TUBE_H

#include <stdint.h>

#include "taylor.h"

enum { TUBE_ORDER = 26 };

typedef struct tube tube;

/* The motion must outlive it. */
tube *tube_new(const exact_motion *m, int order);
void tube_free(tube *t);

/* Opens a step at the present time and tells how long it is, s; 0: no step that is worth one leads on. `most_s`: it need
 * not be longer. Until tube_on() the tube then is known at tau_s in [0, that]: x[states]. */
double tube_open(tube *t, double most_s);
void tube_at(const tube *t, enclosure tau_s, enclosure *x);
/* The present time becomes this one of the open step. False: nothing is known there any more. */
bool tube_on(tube *t, enclosure tau_s);
/* Steps so far, and products of enclosures, about: what they cost. */
uint64_t tube_steps(const tube *t);
double tube_products(const tube *t);

#endif
