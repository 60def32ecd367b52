/* folded.h: what folding a scene's constants to double makes of its accelerations, at states of a run: the scene's own list
 * beside those whose constants were folded in other ways (host/number/folding.h). Of most scenes there are none, and nothing
 * is asked. */
#ifndef RUN_FOLDED_H
#define RUN_FOLDED_H

#include "engine.h"

typedef struct folded {
    const image *image;
    int results;
    evaluator *own;
    evaluator *other[IMAGE_WAYS];
    double *input[IMAGE_WAYS + 1]; /* each way's, then the scene's own */
    double *value;                 /* [results] */
    double *beside;                /* [results] */
    double *size;                  /* [results] the largest that it was, */
    double *off;                   /* [ways * results] and that another way was off it */
    double *start; /* [ways * components] so far another way starts from where the scene does */
} folded;

/* NULL where there is one way only. */
folded *folded_open(const image *im, const engine_kind *kind);
void folded_close(folded *f); /* NULL is fine */
/* x: a state as engine_kind.state() gives it, angles first. */
void folded_look(folded *f, const double *x);

/* The image of the way that leads furthest from the scene's own, about where it starts; NULL where there is none. */
const image *folded_furthest(const image *im);

#endif
