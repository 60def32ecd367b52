/* curved.h: random mechanisms with curved stops and holds and dry friction, as text: cams, cranks and beads with
 * coupled inertia. Their friction passes dead centres. */
#ifndef TESTS_CURVED_H
#define TESTS_CURVED_H

#include "test.h"

/* Writes a mechanism to `text`; the same seed gives the same text. Returns the scale of its energy balance: the energy
 * at the start without gravity and springs at rest, J. `step_s` and `until_s` go into its scene. */
double curved_text(uint64_t seed, double step_s, double until_s, char *text, size_t size);

#endif
