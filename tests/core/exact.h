/* exact.h: what a mechanism by hand (hand.h) does, worked out another way. Its loads are constant, so between events it
 * moves on parabolas, whose roots are closed forms; at an event the laws of docs/dev/events.md are solved by trying all of
 * their cases. In double, without probes, pivots or pins. */
#ifndef TESTS_EXACT_H
#define TESTS_EXACT_H

#include "hand.h"

enum { EXACT_LOG = 32 };

/* Where a double is no more than a float, as on AVR, it is no reference. */
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
    double energy[HAND_CONTACTS];  /* what each contact gave, */
    double impulse[HAND_CONTACTS]; /* and pushed with along its row, from the start on */
    double pushed;                 /* the input */
    wh_event log[EXACT_LOG];       /* of the last step */
    unsigned logged;
    unsigned next;   /* stops that are hit in the next round, as bits */
    unsigned stands; /* crossings just taken that are where they cross, as bits */
    bool vague;      /* something hung on less than rounding: what follows is no reference */
    bool shared;     /* contacts repeated each other: what each gave is not unique */
} exact;

/* hand_now's start, and a step of 1 ms. */
void exact_start(exact *e);
void exact_step(exact *e);
/* Moves what is beyond free stops back, the least that does it, and stops what closes there. */
void exact_squeeze(exact *e);

#endif
