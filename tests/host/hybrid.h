/* hybrid.h: random planar linkages (linkage.h) with stops and dry friction. Their motion is independent of the program:
 * long double, accelerations from the energies in numbers, bisected events, modes found by trying all cases. */
#ifndef TESTS_HOST_HYBRID_H
#define TESTS_HOST_HYBRID_H

#include "linkage.h"

enum { HYBRID_CONTACTS = 3, HYBRID_TEXT = 1000 };

typedef enum hybrid_kind {
    HYBRID_LEAST,   /* a stop: the coordinate stays above */
    HYBRID_MOST,    /* a stop: it stays below */
    HYBRID_FLOOR,   /* a stop: the body's end stays above */
    HYBRID_FRICTION /* on the coordinate, static and kinetic alike */
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

/* No stop is violated at the start. */
hybrid hybrid_draw(uint64_t *seed);

void hybrid_statements(const hybrid *h, char text[static HYBRID_TEXT]);

typedef struct hybrid_motion {
    long double state[2 * LINKAGE_BODIES]; /* values, then rates */
    int impacts;
    int rests;  /* number of closed stops and sticking rates */
    bool aside; /* impacts on one stop that converge (Zeno), or modes that fit no case */
} hybrid_motion;
/* Step of most of these runs. */
#define HYBRID_STEP_S (1.0 / 4096.0)

/* Its motion until `until_s` with this step. A flight shorter than `least_flight_s` ends it as `aside`. */
hybrid_motion hybrid_move(const hybrid *h, double step_s, double until_s, double least_flight_s);

#endif
