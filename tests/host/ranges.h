/* ranges.h: what the suites about the dissertation's findings share: the span of quantities over a
 * scene's run, and thresholds with two sides. */
#ifndef TESTS_RANGES_H
#define TESTS_RANGES_H

#include "motion.h"

/* A quantity over a run: set `name` ("X", "X'" or an output), the rest is filled in. SI. */
typedef struct range {
    const char *name;
    double first;
    double last;
    double least;
    double most;
} range;

/* The scene's run from its start to `until_s`, looked at every `every_s` and at the start. */
void ranges_of(const char *which, stepping how, double until_s, double every_s, range *r,
               unsigned count);

/* largest - smallest */
double range_width(const range *r);

/* Largest distance from the value at the start. */
double range_drift(const range *r);

/* least <= got <= most, or the test fails; prints a line either way. */
void expect_between(const char *what, double least, double most, double got);

#endif
