/* deviation.h: how far a run is off its reference. */
#ifndef STUDY_DEVIATION_H
#define STUDY_DEVIATION_H

#include "reference_run.h"

/* How a step lies in the records: so many steps in so many spacings, one of the two being 1. Where a step is longer than a
 * spacing, only the records at its ends are looked at. */
typedef struct deviation_pace {
    uint64_t steps;
    uint64_t records;
} deviation_pace;

/* What of it is looked at. */
typedef struct deviation_of_what {
    int column; /* of the reference, in the column's unit; or -1: each that counts, as a part of its largest value */
    double give_up; /* a run that is off by more is of no use: it is not run on */
} deviation_of_what;

typedef struct deviation {
    bool
        usable; /* it came to the end without being off by more than give_up, and nothing was held at an end of its range */
    double error; /* the largest of all records; where it is not usable, that of those it came to */
    int column;   /* where */
    double
        known; /* and how well the reference knows that column there: errors near it are no more than bounds */
    double operations;       /* evaluated: what it took */
    double evaluations;      /* of the accelerations, or of the matrix, a simulated second */
    double evaluations_most; /* in one step */
} deviation;

/* `im`: the reference's scene, with a step of this pace. */
deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what);

#endif
