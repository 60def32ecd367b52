/* waves.h: sines and cosines of several angles from as few evaluations as possible. For
 * host/derive only. */
#ifndef DERIVE_WAVES_H
#define DERIVE_WAVES_H

#include "lower.h"

typedef enum wave_rule {
    WAVE_EVALUATED, /* by the core's sine */
    WAVE_DOUBLE,    /* 2 p */
    WAVE_SUM,       /* p + q */
    WAVE_DIFFERENCE /* p - q */
} wave_rule;

struct wave {
    const poly *angle;
    wave_rule rule;
    int p;
    int q;
    int sine; /* operation, or -1 */
    int cosine;
};

/* Does a turn angle stand in this angle, times a number? */
bool waves_turns(const lowering *l, const poly *angle);
/* Choose rules for `count` angles (no duplicates). */
void waves_plan(lowering *l, const poly **angles, int count);
/* The operation for the sine or cosine of an angle; an angle that was not planned is evaluated. */
int waves_sine(lowering *l, const poly *angle);
int waves_cosine(lowering *l, const poly *angle);

#endif
