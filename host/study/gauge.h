/* gauge.h: what a measure of a sweep (measures.h) comes to, sample by sample. */
#ifndef STUDY_GAUGE_H
#define STUDY_GAUGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

#endif
