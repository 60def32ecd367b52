/* curved.h: random mechanisms with curved stops and holds and dry friction, as texts: cams, cranks and beads
 * with coupled inertia, whose friction passes dead centres. Shared by the suites about contacts. */
#ifndef TESTS_CURVED_H
#define TESTS_CURVED_H

#include <stddef.h>
#include <stdint.h>

/* One of them, in `text`; the same for the same seed. Returns its energy at the start beside springs at rest
 * and without gravity, in J: the scale of its books. `step_s` and `until_s` are written into its scene. */
double curved_text(uint64_t seed, double step_s, double until_s, char *text, size_t size);

#endif
