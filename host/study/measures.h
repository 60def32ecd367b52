/* measures.h: what a sweep keeps of each run.
 *
 * A measure is an expression of the language over coordinates, rates, accelerations, inputs,
 * parameters, lets and outputs: its value at the end of the run, or what the series of its values
 * (one a step, from a given time on) comes to:
 *
 *     max(x)  min(x)   largest and smallest sample
 *     amplitude(x)     half the difference of the two
 *     mean(x)          over time, by the trapezoidal rule
 *     period(x)        mean spacing of the upward crossings of the mean, each found by linear
 *                      interpolation between two samples; nan with fewer than two crossings, or
 *                      when x does not vary beyond rounding */
#ifndef STUDY_MEASURES_H
#define STUDY_MEASURES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/lang/model.h"

/* === a measure, sample by sample ============================================================== */
/* What a measure of a sweep (measures.h) comes to, sample by sample. */

typedef enum measure_kind {
    MEASURE_FINAL,
    MEASURE_MAX,
    MEASURE_MIN,
    MEASURE_AMPLITUDE,
    MEASURE_MEAN,
    MEASURE_PERIOD
} measure_kind;

/* What a measure has seen of one run. */
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

/* period() keeps every sample: no more than so many. */
#define PERIOD_SAMPLES_MAX UINT64_C(100000000)

gauge gauge_start(measure_kind kind);
void gauge_enter(gauge *g, double value);
/* `epsilon`: relative rounding error of a sample. nan when the measure has no value, of a period also when nothing
 * swings; infinite or nan when finite samples are too large for it, of a period always infinite. */
double gauge_result(const gauge *g, double step_s, double epsilon);
void gauge_end(gauge *g);

typedef struct measure {
    measure_kind kind;
    const char *name; /* its CSV column: the text as typed */
    const expr *of;
} measure;

/* The symbol, with m->of->primes, in whose declared unit the column stands; NULL: it is SI. */
const symbol *measure_symbol(const measure *m);

typedef struct measures {
    struct arena *arena;
    measure *list; /* [count] */
    int count;
    /* The mechanism with the measured expressions as its outputs and no others, so that what
     * derives and computes outputs computes measures, and nothing that was not asked for. */
    mechanism mechanism;
} measures;

/* Read `count` texts, or with none take the final state and the outputs. NULL when one is wrong,
 * reported to `errors`. `of` must outlive the result. */
measures *measures_new(const mechanism *of, const char *const *texts, int count, diags *errors);
void measures_free(measures *m);

#endif
