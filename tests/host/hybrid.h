/* hybrid.h: random planar linkages (linkage.h) with stops and dry friction. Their motion is computed independently
 * of the program: in long double, with accelerations from numeric derivatives of the energies, events found by
 * bisection, and modes found by trying all cases. */
#ifndef TESTS_HOST_HYBRID_H
#define TESTS_HOST_HYBRID_H

#include "linkage.h"

enum { HYBRID_CONTACTS = 3, HYBRID_TEXT = 1000 };

typedef enum hybrid_kind {
    HYBRID_LEAST,   /* a stop at the coordinate's least value */
    HYBRID_MOST,    /* a stop at the coordinate's greatest value */
    HYBRID_FLOOR,   /* a stop below the end of the body */
    HYBRID_FRICTION /* friction on the coordinate; static and kinetic limit are equal */
} hybrid_kind;

typedef struct hybrid_contact {
    hybrid_kind kind;
    int body;
    double limit; /* position of a stop, m or rad; limit of a friction, N or N m */
    double restitution;
    /* the limit of a friction grows by `load` per m or rad of this coordinate, but is never below zero */
    int loaded_by;
    double load; /* 0: the limit is constant */
} hybrid_contact;

typedef struct hybrid {
    linkage of;
    int contacts; /* stops come before frictions */
    hybrid_contact contact[HYBRID_CONTACTS];
} hybrid;

/* Draws a linkage with contacts. At the start all stops are open. */
hybrid hybrid_draw(uint64_t *seed);

void hybrid_statements(const hybrid *h, char text[static HYBRID_TEXT]);

typedef struct hybrid_motion {
    long double state[2 * LINKAGE_BODIES]; /* coordinates, then rates */
    int impacts;
    int rests; /* number of closed stops and sticking frictions found at all events together */
    /* there is no reference: impacts on one stop accumulate (Zeno), or no case of the contact laws fits */
    bool aside;
} hybrid_motion;
#define HYBRID_STEP_S (1.0 / 4096.0)

/* Moves the linkage until until_s with this step. If a flight between two impacts is shorter than least_flight_s,
 * the motion ends early and `aside` is true. */
hybrid_motion hybrid_move(const hybrid *h, double step_s, double until_s, double least_flight_s);

#endif
