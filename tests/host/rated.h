/* rated.h: drawn smooth scenes for the rows that end a run, each with its motion as the test itself knows it: linear
 * ones by their exponential, others by equations that are written down here, integrated in long double. */
#ifndef TESTS_HOST_RATED_H
#define TESTS_HOST_RATED_H

#include <stdbool.h>

#include "command.h"
#include "linear.h"

enum { RATED_STATES = LINEAR_STATES, RATED_TEXT = 4000, RATED_NUMBERS = 8, RATED_OPTIONS = 3 };

typedef struct rated {
    char text[RATED_TEXT]; /* its scene is `s` */
    const char *method;    /* of the command line */
    const char *number;    /* "float" or "double" */
    bool compensated;
    int states; /* coordinates, then their rates: columns of a record behind the time */
    double step_s;
    double until_s;
    double start[RATED_STATES];
    double number_of[RATED_NUMBERS]; /* parameters, as `slope` takes them */
    void (*slope)(const double *parameter, const long double *x, long double *slope);
    linear linear; /* where slope is NULL */
} rated;

/* Every kind, method and number comes about. */
void rated_draw(dice *d, rated *r);
/* The motion at multiples of `spacing_s`: row[(records + 1)][states], to be freed. */
long double *rated_motion(const rated *r, double spacing_s, int records);

#endif
