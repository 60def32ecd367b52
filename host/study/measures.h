/* measures.h: the measures of a sweep's runs.
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
#ifndef STUDY_MEASURES_H
#define STUDY_MEASURES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/lang/model.h"

/* === a measure, sample by sample ============================================================== */
/* The function of a measure of a sweep (measures.h), sample by sample. */

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
/* `epsilon`: relative round-off of a sample. nan if the measure has no value, and for a period without a swing.
 * Infinite or nan if finite samples are too large for it; a period is then infinite. */
double gauge_result(const gauge *g, double step_s, double epsilon);
void gauge_end(gauge *g);

typedef struct measure {
    measure_kind kind;
    const char *name; /* its CSV column: the text as typed */
    const expr *of;
} measure;

/* The symbol, with m->of->primes, that has the column's declared unit; NULL: SI. */
const symbol *measure_symbol(const measure *m);

typedef struct measures {
    struct arena *arena;
    measure *list; /* [count] */
    int count;
    /* The mechanism with only the measured expressions as outputs. So measures are derived and
     * computed as outputs are, without any others. */
    mechanism mechanism;
} measures;

/* Reads `count` texts, or without texts takes the final state and the outputs. NULL if one is
 * wrong, reported to `errors`. `of` must outlive the result. */
measures *measures_new(const mechanism *of, const char *const *texts, int count, diags *errors);
void measures_free(measures *m);

#endif
