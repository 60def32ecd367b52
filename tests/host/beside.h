/* beside.h: compares a proved enclosure of a motion (a tube, host/prove/containment.h) with a 113-bit reference, record
 * by record. */
#ifndef TESTS_HOST_BESIDE_H
#define TESTS_HOST_BESIDE_H

#include "host/prove/containment.h"
#include "quad_arms.h"

/* The reference, integrated together with the tube, and the result of the comparison. */
typedef struct beside {
    quad_slopes *slopes;
    const void *of;
    quad step_s;
    quad state[QUAD_STATES]; /* in the tube's order */
    uint64_t records;
    uint64_t outside; /* first record with a state outside the tube; 0: no such record */
    double widest;    /* width of the tube, while inside */
    /* least distance of the reference from an end of its interval, divided by the width */
    double nearest;
} beside;

/* Runs scene `name` of the text by `kind` and compares it with its tube. */
containment_found beside_hold(const char *text, const char *name, const engine_kind *kind,
                              beside *b);

#endif
