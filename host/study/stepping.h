/* stepping.h: one run of a sweep: an image, stepped to its end and measured. */
#ifndef STUDY_STEPPING_H
#define STUDY_STEPPING_H

#include <stdio.h>

#include "gauge.h"
#include "host/engine/engine.h"

/* Where a measured expression is read: in the state itself, or among the outputs. */
typedef struct channel {
    enum { FROM_ANGLE, FROM_REAL, FROM_OUTPUT } where;
    int index;
} channel;

typedef struct measured {
    measure_kind kind;
    const char *name;
    channel from;
} measured;

typedef struct measuring {
    const engine_kind *kind;
    double from_s; /* measure from this time on */
    const measured *list;
    int count;
    double strict; /* run_checks_fails() */
} measuring;

/* What is to be told of a point that did not fail. */
typedef struct point_notes {
    unsigned found;   /* findings, as bits (host/check/finding.h), */
    unsigned against; /* the warnings among them, */
    unsigned fails;   /* and those for which the exit status is 1 */
    double end_s;     /* of the run */
} point_notes;

/* Run the image; value[count + 1] gets the measures and how well the energies balance (NAN where that is not known).
 * False when the run failed or something was not a finite number: said on `reason` or reported. */
bool stepping_measure(const measuring *w, const image *im, double *value, diags *errors,
                      FILE *reason, point_notes *notes);

#endif
