/* flowpipe.h: a tube around the exact motion: for each time, a box that provably contains the motion. The method is
 * Lohner's (Enclosing the solutions of ordinary initial and boundary value problems, 1987; Nedialkov, Jackson, Corliss,
 * Validated solutions of initial value problems, 1999). A step of length h first finds a box that contains the motion
 * during the whole step. Then x(t + tau) is the sum of three parts: the Taylor polynomial at the tube's centre; the
 * polynomial's derivatives times the deviation from the centre; and Lagrange's remainder over the box.
 * All numbers are enclosures, because operations round, and because a parameter such as 0.1 is not a double. */
#ifndef PROVE_FLOWPIPE_H
#define PROVE_FLOWPIPE_H

#include <stdint.h>

#include "host/number/enclosure.h"
#include "host/prove/taylor.h"

/* === zonotope ================================================================================= */
/* A set of deviations from a centre: a drift plus a sum of generators, each times any number from -1 to 1
 * (Kuehn, Rigorously computed orbits of dynamical systems without the wrapping effect, Computing 61, 1998). Round-off
 * becomes new generators. If there are too many generators, a box replaces the smallest ones. */

typedef struct zonotope {
    int n; /* dimensions */
    int count;
    int most;
    double *drift;     /* [n] */
    double *generator; /* [most][n] */
} zonotope;

/* Makes room for `most` generators, or for 4 n if `most` is less. */
zonotope *zonotope_new(int n, int most);
void zonotope_free(zonotope *z);

/* Computes the smallest box[n] that contains the zonotope. */
void zonotope_box(const zonotope *z, enclosure *box);
/* Computes nearly orthogonal axes, in the columns of axes[n * n]. off[n] encloses the deviation along these axes. */
void zonotope_frame(const zonotope *z, double *axes, enclosure *off);
/* The new set contains M d + v for each old deviation d. map[n * n] encloses M, and more[n] encloses v. */
void zonotope_map(zonotope *z, const enclosure *map, const enclosure *more);

enum { FLOWPIPE_ORDER = 26 };

typedef struct flowpipe flowpipe;

/* `m` must outlive the tube. */
flowpipe *flowpipe_new(const exact_motion *m, int order);
void flowpipe_free(flowpipe *t);

/* Opens a step of at most `most_s`. Returns the step's length in s, or 0 if no useful step is possible. */
double flowpipe_open(flowpipe *t, double most_s);
/* Sets x[states] to enclose the state at tau_s after the open step's start; 0 <= tau_s <= the step's length. */
void flowpipe_at(const flowpipe *t, enclosure tau_s, enclosure *x);
/* Ends the step at tau_s. Returns false if the tube ends there. */
bool flowpipe_on(flowpipe *t, enclosure tau_s);
/* The number of steps so far, and their estimated cost in products of enclosures. */
uint64_t flowpipe_steps(const flowpipe *t);
double flowpipe_products(const flowpipe *t);

#endif
