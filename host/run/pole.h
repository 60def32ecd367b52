/* pole.h: is there a pole on the way from one state to the next?
 *
 * Some values change their sign at a pole (what is divided by), others grow there (the expressions). Where a sign changes,
 * that place is found by halving, and each expression is followed towards it from both sides, to where no digits are left
 * of the way: a pole is where one grows, at last, as one over the distance does, or faster, evenly, on either side. What has
 * a limit there, or may be integrated (one over a root), is none; neither is what grows in leaps, as rounding does where
 * what is left of a difference is divided by little; nor what ends growing. Behind each place that is none the rest of the
 * way is looked at by itself: 1 + k/s has changed its sign twice where s has changed its own.
 *
 * What only touches zero, as 1 - cos(q) does, changes no sign. Where its size falls at the begin of a way and rises at the
 * end, so steeply that it may touch, the place where it is least is found by golden sections, and asked alike; if it is
 * beyond zero there, as k + s + s^2/m may be, the two sides are. */
#ifndef RUN_POLE_H
#define RUN_POLE_H

#include <stdbool.h>

typedef struct pole_way {
    void *of;
    int signs;
    int values;
    /* [signs] The least part of the way that has digits for this one's arguments; and for how far off zero it is, where it
     * touches zero as a square does. */
    const double *nearest;
    const double *nearest_even;
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
