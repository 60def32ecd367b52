/* pole.h: finds a pole on the way from one state to the next.
 *
 * Some values change their sign at a pole (divisors), others grow there (expressions). A sign change is located by halving. Each
 * expression is followed towards it on both sides, from the nearest distances at which both go on evenly. Nearer there is only
 * round-off. The place is a pole if an expression grows at least as fast as one over the distance. A limit or an integrable
 * singularity (one over a root) is no pole. Growth in leaps, or growth that ends, is none either. After each rejected place the
 * rest of the way is tested by itself: 1 + k/s has changed its sign twice if s has changed its own.
 *
 * A value that only touches zero, such as 1 - cos(q), changes no sign. Its size must fall at the begin of a way and rise at the
 * end, steeply enough to touch. Then golden sections find its least point, which is tested in the same way. If the value is
 * beyond zero there, as k + s + s^2/m may be, the two sides are tested. */
#ifndef CHECK_POLE_H
#define CHECK_POLE_H

#include <stdbool.h>

typedef struct pole_way {
    void *of;
    int signs;
    int values;
    const double
        *nearest; /* [signs] the least part of the way that has digits for this one's arguments */
    /* sign[signs], value[values] at this share of the way, 0 to 1. */
    void (*at)(void *of, double share, double *sign, double *value);
} pole_way;

/* May a value with these samples at 0, POLE_ASIDE, 1 - POLE_ASIDE and 1 have touched zero between? A value as round as a
 * square there stays above its tangents. */
#define POLE_ASIDE 0x1p-20
bool pole_may_touch(const double value[static 4]);

/* The first value with a pole on the way, or -1. */
int pole_on(const pole_way *w);

#endif
