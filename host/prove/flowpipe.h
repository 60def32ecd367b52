/* flowpipe.h: a tube around the exact motion from its start: at each time a box that provably contains it. The steps
 * are Lohner's (Enclosing the solutions of ordinary initial and boundary value problems, 1987; Nedialkov, Jackson,
 * Corliss, Validated solutions of initial value problems, 1999). First, a box is found that contains the motion over
 * [0, h]: the Taylor series, with its remainder over this box, stays inside. Then x(t + tau) is the sum of the Taylor
 * polynomial at the centre of the current set, its derivatives times the deviation from the centre, and the remainder
 * over that box. The deviation is a box along axes that turn with the motion. All numbers are enclosures, because of
 * round-off, and because no double represents some parameters. */
#ifndef PROVE_FLOWPIPE_H
#define PROVE_FLOWPIPE_H

#include <stdint.h>

#include "host/number/enclosure.h"
#include "host/prove/taylor.h"

/* === zonotope ================================================================================= */
/* The deviation of a point from a centre: a known drift plus a sum of generators, each times a number from -1 to 1
 * (Kuehn, Rigorously computed orbits of dynamical systems without the wrapping effect, Computing 61, 1998). A linear
 * map transforms them exactly, except for round-off, which becomes new generators. Only if there are too many
 * generators are the smallest enclosed in a box. */

typedef struct zonotope {
    int n; /* dimensions */
    int count;
    int most;
    double *drift;     /* [n] */
    double *generator; /* [most][n] */
} zonotope;

/* `most` generators fit, at least 4 n. */
zonotope *zonotope_new(int n, int most);
void zonotope_free(zonotope *z);

/* Computes the smallest box[n] that contains the zonotope. */
void zonotope_box(const zonotope *z, enclosure *box);
/* Computes nearly orthogonal axes, in columns, the first along the longest extent. off[n] encloses the
 * deviation's components along them. */
void zonotope_frame(const zonotope *z, double *axes, enclosure *off);
/* Applies all maps in map[n * n], and adds `more`[n]. */
void zonotope_map(zonotope *z, const enclosure *map, const enclosure *more);

enum { FLOWPIPE_ORDER = 26 };

typedef struct flowpipe flowpipe;

/* `m` must outlive the tube. */
flowpipe *flowpipe_new(const exact_motion *m, int order);
void flowpipe_free(flowpipe *t);

/* Opens a step of at most `most_s`. Returns its length, s, or 0 if no useful step is possible. Until flowpipe_on(),
 * flowpipe_at() encloses the motion tau_s after the step's start, 0 <= tau_s <= length: x[states]. */
double flowpipe_open(flowpipe *t, double most_s);
void flowpipe_at(const flowpipe *t, enclosure tau_s, enclosure *x);
/* Ends the step at tau_s. Returns false if the tube ends there. */
bool flowpipe_on(flowpipe *t, enclosure tau_s);
/* The number of steps so far, and their estimated cost in products of enclosures. */
uint64_t flowpipe_steps(const flowpipe *t);
double flowpipe_products(const flowpipe *t);

#endif
