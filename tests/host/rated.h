/* rated.h: random smooth scenes with references, for tests of the accuracy that a run reports. The reference of a
 * linear scene is the matrix exponential. The other scenes have equations that were derived by hand and are
 * integrated in long double. */
#ifndef TESTS_HOST_RATED_H
#define TESTS_HOST_RATED_H

#include <stdbool.h>

#include "command.h"
#include "linear.h"

enum { RATED_STATES = LINEAR_STATES, RATED_TEXT = 4000, RATED_NUMBERS = 8, RATED_OPTIONS = 3 };

typedef struct rated {
    char text[RATED_TEXT]; /* a mechanism with a scene `s` */
    const char *method;    /* name of the method on the command line */
    const char *number;    /* "float" or "double" */
    bool compensated;
    int states; /* coordinates, then rates: the columns of a record after the time */
    double step_s;
    double until_s;
    double start[RATED_STATES];
    double number_of[RATED_NUMBERS]; /* parameters of `slope` */
    void (*slope)(const double *parameter, const long double *x, long double *slope);
    linear linear; /* the mechanism if `slope` is NULL */
} rated;

void rated_draw(dice *d, rated *r);
/* The states at the start and at `records` multiples of spacing_s: row[records + 1][states]. The caller frees the
 * result. */
long double *rated_motion(const rated *r, double spacing_s, int records);

#endif
