/* hybrid.h: random planar linkages (linkage.h) with stops and dry friction. Their motion is computed independently of
 * the program: in long double, with accelerations from numeric derivatives of the energies, events by bisection, and
 * modes by trying all cases. */
#ifndef TESTS_HOST_HYBRID_H
#define TESTS_HOST_HYBRID_H

#include "linkage.h"

enum { HYBRID_CONTACTS = 3, HYBRID_TEXT = 1000 };

typedef enum hybrid_kind {
    HYBRID_LEAST,   /* a stop: the coordinate stays above */
    HYBRID_MOST,    /* a stop: the coordinate stays below */
    HYBRID_FLOOR,   /* a stop: the end of the body stays above */
    HYBRID_FRICTION /* friction on the coordinate, with equal static and kinetic limits */
} hybrid_kind;

typedef struct hybrid_contact {
    hybrid_kind kind;
    int body;
    double limit; /* of a stop: its position, m or rad; of friction: N or N m */
    double restitution;
    int loaded_by; /* friction: the limit grows by `load` per m or rad of this coordinate, and is never below zero */
    double load; /* 0: constant */
} hybrid_contact;

typedef struct hybrid {
    linkage of;
    int contacts; /* stops first */
    hybrid_contact contact[HYBRID_CONTACTS];
} hybrid;

/* Draws a linkage with contacts. No stop is passed at the start. */
hybrid hybrid_draw(uint64_t *seed);

void hybrid_statements(const hybrid *h, char text[static HYBRID_TEXT]);

typedef struct hybrid_motion {
    long double state[2 * LINKAGE_BODIES]; /* values, then rates */
    int impacts;
    int rests; /* number of closed stops and sticking rates */
    /* impacts on one stop accumulate (Zeno), or no case of the contact laws fits: no reference */
    bool aside;
} hybrid_motion;
/* The step of most of these runs, s. */
#define HYBRID_STEP_S (1.0 / 4096.0)

/* The motion of h until `until_s` with this step. A flight shorter than `least_flight_s` ends the motion, with `aside`
 * set. */
hybrid_motion hybrid_move(const hybrid *h, double step_s, double until_s, double least_flight_s);

#endif
