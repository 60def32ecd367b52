/* point.h: one point of a sweep: one run, and what its measures come to. */
#ifndef STUDY_POINT_H
#define STUDY_POINT_H

#include <stdio.h>

#include "host/engine/engine.h"
#include "host/study/grid.h"
#include "host/study/measures.h"

/* === a run of a sweep ========================================================================= */
/* One run of a sweep: an image, stepped to its end and measured. */

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

/* A sweep in numbers. Everything in it outlives the runs and is not changed by them. */
typedef struct sweep {
    const grid *grid;
    const mechanism *mechanism; /* with the measures as its outputs, if there are any */
    const measures *measures;   /* NULL of a map */
    const scene *scene;         /* NULL for a bare mechanism */
    const overrides *changes;   /* the command line's, without what is swept */
    const engine_kind *kind;
    image_settings engine;
    double from_s; /* measure from this time on */
    double strict; /* run_checks_fails() */
    /* The image whose lists every point takes, or NULL: parameters are folded into them, and so is the
     * momentum of a conserved coordinate, so a sweep that varies them derives each point anew. A
     * point's rows do not depend on the points before it: nothing is carried over. */
    const image *shared;
} sweep;

/* Columns behind the swept values: the measures, and of a mechanism with energies how well they balance
 * (host/check/energy_residual.h; empty where that is not known); where the step is swept, the end of each run, `end_s`. */
int sweep_columns(const sweep *s);

/* Do all runs end at the same time, as far as a measure takes their end? False, told: a step does not divide the time. */
bool sweep_ends_are_alike(const sweep *s, double until_s);

/* May the points of the grid share the lists of this image of one of them? */
bool sweep_can_share(const grid *g, const image *im);

/* Behind a column's name: " [deg]", the declared unit; "" where it is SI or `of` is NULL. Free it. */
char *sweep_unit(const symbol *of, int primes);

/* The CSV fields of the swept values, as header and for one point, without a line's end. */
void sweep_header(const sweep *s, FILE *out);
char *sweep_swept_value(const axis *a, double si, char text[NUMBER_SIZE]);
void sweep_swept_fields(const sweep *s, uint64_t point, FILE *out);

/* The image of a point, and if step_doubling_plain() says so the one for the finer run beside it. NULL, reported: it has none that can
 * start. `plain` may be NULL. */
image *sweep_image(const sweep *s, uint64_t point, image **plain, diags *errors);

/* Run the point and write its row, line's end included. A run that fails, or has a measure, an energy or a
 * contact's expression that is not a finite number, leaves its columns empty: then the result is false and
 * one line on `reason` says why. After an interrupt the row is of no use. */
bool sweep_point(const sweep *s, uint64_t point, FILE *row, FILE *reason, point_notes *notes);

#endif
