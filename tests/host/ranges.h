/* ranges.h: the range of quantities over a run, and two-sided thresholds, for suites of the dissertation's findings. */
#ifndef TESTS_RANGES_H
#define TESTS_RANGES_H

#include "motion.h"

/* A quantity over a run. Set `name` ("X", "X'" or an output); the rest is filled in. SI. */
typedef struct range {
    const char *name;
    double least;
    double most;
} range;

/* Runs the scene to `until_s`, and samples it at the start and every `every_s`. */
void ranges_of(const char *which, stepping how, double until_s, double every_s, range *r,
               unsigned count);

double range_width(const range *r);

/* Fails the test unless least <= got <= most; prints a line either way. */
void expect_between(const char *what, double least, double most, double got);

#endif
