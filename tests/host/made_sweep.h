/* made_sweep.h: a sweep of a text, set up as `whirl sweep` does it. For tests of host/study. */
#ifndef TESTS_HOST_MADE_SWEEP_H
#define TESTS_HOST_MADE_SWEEP_H

#include "command.h"
#include "derived.h"
#include "host/study/session.h"

typedef struct made_sweep {
    derived d; /* image of the first scene; its measures replace the outputs */
    diags *errors;
    whirl_model *model;
    grid grid;
    measures *measures;
    overrides changes;
    image *image;
    sweep sweep;
} made_sweep;

/* Opens a sweep of a text over the axes over[axes], with the measures asked[count]. */
void made_sweep_open(made_sweep *m, const char *text, const char *const *over, int axes,
                     const char *const *asked, int count, const engine_kind *kind);
void made_sweep_close(made_sweep *m);

/* Text of a mechanism: a body above a floor at x = 0, free along y. */
extern const char made_sweep_floor[];

#endif
