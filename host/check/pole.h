/* pole.h: is there a pole on the way from one state to the next?
 *
 * Some values change their sign at a pole (what is divided by), others grow there (the expressions). Where a sign changes,
 * that place is found by halving, and each expression is followed towards it on both sides: from the nearest distances on at
 * which it, and what changes its sign, go on evenly, for nearer there is but rounding. A pole is where it grows
 * there as one over the distance does, or faster. What has a limit, or may be integrated (one over a root), is none; neither is
 * what grows in leaps, nor what ends growing. Behind each place that is none the rest of the way is looked at by itself: 1 + k/s
 * has changed its sign twice where s has changed its own.
 *
 * What only touches zero, as 1 - cos(q) does, changes no sign. Where its size falls at the begin of a way and rises at the
 * end, so steeply that it may touch, the place where it is least is found by golden sections, and asked alike; if it is
 * beyond zero there, as k + s + s^2/m may be, the two sides are. */
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

/* May one that has these values at 0, POLE_ASIDE, 1 - POLE_ASIDE and 1 have touched zero between? What is as round as a square
 * there stays above its tangents. */
#define POLE_ASIDE 0x1p-20
bool pole_may_touch(const double value[static 4]);

/* The first value with a pole on the way; -1: none. */
int pole_on(const pole_way *w);

#endif
