/* ranges.h: the range of quantities over a run, and checks with two bounds, for the suites of the dissertation's
 * findings. */
#ifndef TESTS_RANGES_H
#define TESTS_RANGES_H

#include "motion.h"

/* The range of a quantity over a run, in SI units. The caller sets `name` ("X", "X'" or an output); ranges_of() sets
 * the rest. */
typedef struct range {
    const char *name;
    double least;
    double most;
} range;

/* Runs the scene until until_s. Samples the quantities at the start and then every every_s seconds. */
void ranges_of(const char *which, stepping how, double until_s, double every_s, range *r,
               unsigned count);

double range_width(const range *r);

/* Fails the test if `got` is not between `least` and `most`. Prints a line in any case. */
void expect_between(const char *what, double least, double most, double got);

#endif
