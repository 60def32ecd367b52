/* pole.h: is there a pole on the way from one state to the next?
 *
 * Some values change their sign at a pole (what is divided by), others grow there (the expressions). Where a sign changes,
 * that place is found by halving, and each expression is followed towards it from both sides, to where no digits are left
 * of the way: a pole is where one grows, at last, as one over the distance does, or faster, evenly, on either side. What has
 * a limit there, or may be integrated (one over a root), is none; neither is what grows in leaps, as rounding does where
 * what is left of a difference is divided by little; nor what ends growing. Behind each place that is none the rest of the
 * way is looked at by itself: 1 + k/s has changed its sign twice where s has changed its own. */
#ifndef RUN_POLE_H
#define RUN_POLE_H

typedef struct pole_way {
    void *of;
    int signs;
    int values;
    const double
        *nearest; /* [signs] the least part of the way that has digits for this one's arguments */
    /* sign[signs], value[values] at this share of the way, 0 to 1. */
    void (*at)(void *of, double share, double *sign, double *value);
} pole_way;

/* The first value with a pole on the way; -1: none. */
int pole_on(const pole_way *w);

#endif
