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
 * parameters, lets and outputs. An expression alone gives its value at the end of the run. A function
 * takes a sample of its argument x at each step, from a given time on:
 *   - max(x), min(x): largest and smallest sample.
 *   - amplitude(x): half the difference of max and min.
 *   - mean(x): over time, by the trapezoidal rule.
 *   - period(x): mean interval between upward crossings of the mean, by linear interpolation of
 *     samples; nan with fewer than two crossings, or if x varies only by round-off. */

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

#define PERIOD_SAMPLES_MAX UINT64_C(100000000) /* limit for period(), which stores all samples */

gauge gauge_start(measure_kind kind);
void gauge_enter(gauge *g, double value);
/* `epsilon`: relative round-off of a sample. Returns NaN if there is no value, such as the period of a constant.
 * A period is infinite if a sum or difference of samples overflows. */
double gauge_result(const gauge *g, double step_s, double epsilon);
void gauge_end(gauge *g);

typedef struct measure {
    measure_kind kind;
    const char *name; /* CSV column: the text as typed */
    const expr *of;
} measure;

/* The measure's column is in this symbol's declared unit / s^n, n = m->of->primes. NULL: the column is in SI units. */
const symbol *measure_symbol(const measure *m);

typedef struct measures {
    struct arena *arena;
    measure *list; /* [count] */
    int count;
    mechanism mechanism; /* its only outputs are the measured expressions */
} measures;

/* Reads texts[count]. If count is 0, the measures are the final values of state and outputs. Returns NULL, and reports
 * it to `errors`, if a text is wrong. `of` must outlive the result. */
measures *measures_new(const mechanism *of, const char *const *texts, int count, diags *errors);
void measures_free(measures *m);

/* === a point of a sweep ======================================================================= */

/* The findings at a point that did not fail. */
typedef struct point_notes {
    unsigned found;    /* findings, as bits (host/check/finding.h) */
    unsigned warned;   /* warnings, as bits */
    unsigned fails;    /* findings that make the exit status 1, as bits */
    unsigned unlooked; /* findings for which some steps were not checked, as bits */
    double end_s;      /* end of the run */
} point_notes;

/* The objects that a sweep points to must outlive its runs. No run changes them. */
typedef struct sweep {
    const grid *grid;
    const mechanism *mechanism; /* equals &measures->mechanism if measures is not NULL */
    const measures *measures;   /* NULL if the sweep is a map */
    const scene *scene;         /* NULL for a bare mechanism */
    const overrides *changes;   /* changes by the command line; swept values come from `grid` */
    const engine_kind *kind;
    image_settings engine;
    double from_s;       /* measure from this time on */
    double strict;       /* the value of --strict: see run_checks_fails() */
    const image *shared; /* all points use its operation lists; NULL: each makes its own */
} sweep;

/* The number of columns after the swept values. There is one for each measure. If the mechanism has energies, there is
 * the energy residual (host/check/energy_residual.h; empty if unknown). If the step is swept, there is `end_s`. */
int sweep_columns(const sweep *s);

/* Returns false, with a message, if a measure is taken at the end, and a swept step does not divide until_s. */
bool sweep_ends_are_alike(const sweep *s, double until_s);

/* Can the runs and finer runs of all points use the operation lists of `im`? */
bool sweep_can_share(const grid *g, const image *im);

/* The declared unit after a column's name, such as " [deg]"; "" for SI, or if `of` is NULL. The caller frees it. */
char *sweep_unit(const symbol *of, int primes);

/* Writes the CSV header with a line end. */
void sweep_header(const sweep *s, FILE *out);
/* Returns `text`: the SI value `si` in the unit of the axis. */
char *sweep_swept_value(const axis *a, double si, char text[NUMBER_SIZE]);
/* Writes the swept values of one point, without a line end. */
void sweep_swept_fields(const sweep *s, uint64_t point, FILE *out);

/* The image of a point. Returns NULL, and reports the reason, if the point has no image that can start. */
image *sweep_image(const sweep *s, uint64_t point, diags *errors);

/* Runs the image of a point; value[measures + 1] gets the measures and the energy residual (NAN: unknown). Returns
 * false if the run failed or a value was not finite, with a message on `reason` or in `errors`. */
bool sweep_measure(const sweep *s, const image *im, double *value, diags *errors, FILE *reason,
                   point_notes *notes);

/* Runs the point and writes its row, with a line end. If sweep_image() or sweep_measure() fails, the row has only
 * swept values, `reason` gets a line with the cause, and the result is false. After an interrupt the row is void. */
bool sweep_point(const sweep *s, uint64_t point, FILE *row, FILE *reason, point_notes *notes);

#endif
