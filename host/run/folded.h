/* folded.h: what folding a scene's constants to double makes of its accelerations, at states of a run: the scene's own list
 * beside those whose constants were folded in other ways (host/number/folding.h). Of most scenes there are none, and nothing
 * is asked. */
#ifndef RUN_FOLDED_H
#define RUN_FOLDED_H

#include "engine.h"

/* One list of the scene beside those of the other ways; of none, no results. */
typedef struct folded_list {
    int results;
    evaluator *list[IMAGE_WAYS + 1]; /* each way's, then the scene's own */
    double *value;                   /* [results] */
    double *beside;                  /* [results] */
    double *size;                    /* [results] the largest that it was, */
    double *off;                     /* [ways * results] and that another way was off it */
} folded_list;

/* What contacts are made of, as image_role has it. */
enum { FOLDED_CONTACTS = 3 };

typedef struct folded {
    const image *image;
    folded_list step;
    folded_list contact[FOLDED_CONTACTS];
    double *input[IMAGE_WAYS + 1]; /* likewise */
    double *start; /* [ways * components] so far another way starts from where the scene does */
} folded;

/* NULL where there is one way only. */
folded *folded_open(const image *im, const engine_kind *kind);
void folded_close(folded *f); /* NULL is fine */
/* x: a state as engine_kind.state() gives it, angles first. */
void folded_look(folded *f, const double *x);
/* What contacts are off at most, of what each number of theirs was at most. */
double folded_contacts_off(const folded *f);

/* The image of the way that leads furthest from the scene's own, about where it starts; NULL where there is none. */
const image *folded_furthest(const image *im);

#endif
