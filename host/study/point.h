/* point.h: one point of a sweep: one run and its measures. */
#ifndef STUDY_POINT_H
#define STUDY_POINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "host/engine/engine.h"
#include "host/lang/model.h"
#include "host/study/grid.h"

/* === measures ================================================================================= */
/* The measures of a sweep's runs.
 *
 * A measure is an expression of the language over coordinates, rates, accelerations, inputs,
 * parameters, lets and outputs. It has its value at the end of the run, or a function of its series
 * (one value a step, from a given time on):
 *   - max(x), min(x): largest and smallest sample.
 *   - amplitude(x): half the difference of the two.
 *   - mean(x): over time, by the trapezoidal rule.
 *   - period(x): mean spacing of the upward crossings of the mean, each found by linear
 *     interpolation between two samples. It is nan with fewer than two crossings, or if x does not
 *     vary beyond round-off. */

/* === a measure, sample by sample ============================================================== */

typedef enum measure_kind {
    MEASURE_FINAL,
    MEASURE_MAX,
    MEASURE_MIN,
    MEASURE_AMPLITUDE,
    MEASURE_MEAN,
    MEASURE_PERIOD
} measure_kind;

/* The state of a measure during one run. */
typedef struct gauge {
    measure_kind kind;
    uint64_t samples;
    double least;
    double most;
    double sum;
    double first;
    double last;
    bool undefined; /* a sample was not a finite number */
    double *kept;   /* every sample, for MEASURE_PERIOD */
    size_t kept_room;
} gauge;

/* Most samples of period(), which stores all of them. */
#define PERIOD_SAMPLES_MAX UINT64_C(100000000)

gauge gauge_start(measure_kind kind);
void gauge_enter(gauge *g, double value);
/* `epsilon`: relative round-off of a sample. The result is nan if there is no value, as for the period of a constant. If
 * large samples overflow in the computation, the result is infinite or nan, and a period is infinite. */
double gauge_result(const gauge *g, double step_s, double epsilon);
void gauge_end(gauge *g);

typedef struct measure {
    measure_kind kind;
    const char *name; /* CSV column: the text as typed */
    const expr *of;
} measure;

/* The symbol, with m->of->primes, that has the column's declared unit; NULL: SI. */
const symbol *measure_symbol(const measure *m);

typedef struct measures {
    struct arena *arena;
    measure *list; /* [count] */
    int count;
    /* The mechanism with the measured expressions as its only outputs: measures are derived and computed as outputs. */
    mechanism mechanism;
} measures;

/* Reads `count` texts, or without texts takes the final state and the outputs. NULL if one is
 * wrong, reported to `errors`. `of` must outlive the result. */
measures *measures_new(const mechanism *of, const char *const *texts, int count, diags *errors);
void measures_free(measures *m);

/* === a point of a sweep ======================================================================= */

/* The findings at a point that did not fail. */
typedef struct point_notes {
    unsigned found;    /* findings, as bits (host/check/finding.h) */
    unsigned warned;   /* warnings, as bits */
    unsigned fails;    /* findings that make the exit status 1, as bits */
    unsigned unlooked; /* run_checks_unlooked() */
    double end_s;      /* end of the run */
} point_notes;

/* A sweep in numbers. Everything in it outlives the runs and is not changed by them. */
typedef struct sweep {
    const grid *grid;
    const mechanism *mechanism; /* if there are measures, they are its outputs */
    const measures *measures;   /* NULL if the sweep is a map */
    const scene *scene;         /* NULL for a bare mechanism */
    const overrides *changes;   /* the changes of the command line, without the swept values */
    const engine_kind *kind;
    image_settings engine;
    double from_s; /* measure from this time on */
    double strict; /* run_checks_fails() */
    /* The image with the lists of all points, or NULL. Lists contain the parameters and the momentum
     * of a conserved coordinate, so a sweep of these derives each point. A point's rows do not depend
     * on earlier points. */
    const image *shared;
} sweep;

/* Columns after the swept values: the measures. For a mechanism with energies, the energy residual
 * (host/check/energy_residual.h; empty if unknown). For a swept step, the end of each run, `end_s`. */
int sweep_columns(const sweep *s);

/* Returns false, and reports the reason, if a measure uses the end of the runs and a swept step does not divide `until_s`. */
bool sweep_ends_are_alike(const sweep *s, double until_s);

/* May the grid's points share the lists of this image, which also serves the finer runs? */
bool sweep_can_share(const grid *g, const image *im);

/* The text after a column's name: the declared unit, as " [deg]"; "" for SI, or if `of` is NULL. The caller frees the
 * result. */
char *sweep_unit(const symbol *of, int primes);

/* The CSV fields of the swept values, as header and for one point, without a line's end. */
void sweep_header(const sweep *s, FILE *out);
char *sweep_swept_value(const axis *a, double si, char text[NUMBER_SIZE]);
void sweep_swept_fields(const sweep *s, uint64_t point, FILE *out);

/* The image of a point. Returns NULL, and reports the reason, if the point has no image that can start. */
image *sweep_image(const sweep *s, uint64_t point, diags *errors);

/* Runs the image of a point; value[measures + 1] gets the measures and the energy residual (NAN if unknown). Returns false
 * if the run failed or something was not a finite number, with a message on `reason` or reported. */
bool sweep_measure(const sweep *s, const image *im, double *value, diags *errors, FILE *reason,
                   point_notes *notes);

/* Runs the point and writes its row, including the line's end. The columns stay empty if the run fails, or
 * if a measure, an energy or a contact's expression is not finite. Then the result is false and one line
 * on `reason` gives the cause. After an interrupt the row is invalid. */
bool sweep_point(const sweep *s, uint64_t point, FILE *row, FILE *reason, point_notes *notes);

#endif
