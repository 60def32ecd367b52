/* made_sweep.h: a sweep over a text, set up in the same way as `whirl sweep` does. For tests of host/study. */
#ifndef TESTS_HOST_MADE_SWEEP_H
#define TESTS_HOST_MADE_SWEEP_H

#include "command.h"
#include "derived.h"
#include "host/study/session.h"

typedef struct made_sweep {
    derived d; /* image of the first scene, with the measures as its outputs */
    diags *errors;
    whirl_model *model;
    grid grid;
    measures *measures;
    overrides changes;
    image *image;
    sweep sweep;
} made_sweep;

/* Opens a sweep of a text: over[axes] are the ranges, asked[count] the measures. */
void made_sweep_open(made_sweep *m, const char *text, const char *const *over, int axes,
                     const char *const *asked, int count, const engine_kind *kind);
void made_sweep_close(made_sweep *m);

/* A mechanism as text: a body above a floor at x = 0 that moves freely along y. */
extern const char made_sweep_floor[];

#endif
