/* exact.h: an independent reference for the mechanisms of hand.h. Under constant loads the motion is piecewise
 * parabolic, and the times of events are roots in closed form. At an event, all combinations of modes are tried against
 * the laws of docs/dev/events.md. The reference computes in double, without the probes, pivots and pins of
 * core/contact/. */
#ifndef TESTS_EXACT_H
#define TESTS_EXACT_H

#include "hand.h"

enum { EXACT_LOG = 32 };

/* Skips a test if double has only the precision of float, as on an AVR: the reference would be too coarse. */
#define EXACT_NEEDS_DOUBLE() \
    do { \
        if (__DBL_MANT_DIG__ < 53) { \
            TEST_IGNORE_MESSAGE("the reference needs doubles of 53 bits"); \
        } \
    } while (0)

typedef struct exact {
    double x[2];
    double v[2];
    int mode[HAND_CONTACTS];
    /* energy that each contact has given to the bodies since the start */
    double energy[HAND_CONTACTS];
    double impulse[HAND_CONTACTS]; /* impulse of each contact along its row since the start */
    double pushed;                 /* the scene's input */
    wh_event log[EXACT_LOG];       /* events of the last step */
    unsigned logged;
    unsigned next;   /* bits: stops that the next round hits */
    unsigned stands; /* bits: crossings of this moment whose values are still zero */
    bool vague;      /* a decision depended on round-off: from then on the state is no reference */
    bool shared;     /* contacts are redundant, so the force of each one is not unique */
} exact;

/* Starts from the start of hand_now, with a step of 1 ms. */
void exact_start(exact *e);
void exact_step(exact *e);
/* Moves bodies back from free stops that they passed, by the smallest move in the mass metric. Bodies that approach a
 * stop get rate zero. */
void exact_squeeze(exact *e);

#endif
