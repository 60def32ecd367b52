/* exact.h: an independent reference for mechanisms by hand (hand.h). Under constant loads motion is piecewise parabolic, with
 * roots in closed form. Events try all cases of the laws of docs/dev/events.md. In double, without probes, pivots or pins. */
#ifndef TESTS_EXACT_H
#define TESTS_EXACT_H

#include "hand.h"

enum { EXACT_LOG = 32 };

/* A double that is only a float, as on AVR, is no reference. */
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
    double energy[HAND_CONTACTS];  /* each contact's energy */
    double impulse[HAND_CONTACTS]; /* and impulse along its row, since the start */
    double pushed;                 /* the input */
    wh_event log[EXACT_LOG];       /* of the last step */
    unsigned logged;
    unsigned next;   /* stops that are hit in the next round, as bits */
    unsigned stands; /* crossings just taken that are still at their place, as bits */
    bool vague;      /* a decision depended on round-off; from then on there is no reference */
    bool shared;     /* redundant contacts: each one's share is not unique */
} exact;

/* hand_now's start, and a step of 1 ms. */
void exact_start(exact *e);
void exact_step(exact *e);
/* Moves bodies back from free stops that they passed, by the least move, and stops those that close there. */
void exact_squeeze(exact *e);

#endif
