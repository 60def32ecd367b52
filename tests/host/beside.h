/* beside.h: a tube of `whirl prove` (host/prove/containment.h) beside a reference of 113 bits, record by record. */
#ifndef TESTS_HOST_BESIDE_H
#define TESTS_HOST_BESIDE_H

#include "host/prove/containment.h"
#include "quad_arms.h"

/* The reference, which is taken along, and what became of it. */
typedef struct beside {
    quad_slopes *slopes;
    const void *of;
    quad step_s;
    quad state[QUAD_STATES]; /* in the order of the tube's */
    uint64_t records;
    uint64_t outside; /* the first record with a state that is outside of the tube; 0: none */
    double widest;    /* of the tube, while inside */
    double
        nearest; /* the least share of a tube's width between the reference and an end, while inside */
} beside;

/* The scene `name` of the text, run by `kind` and held against its tube. */
containment_found beside_hold(const char *text, const char *name, const engine_kind *kind,
                              beside *b);

#endif
