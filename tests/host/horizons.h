/* horizons.h: the time until which a run is accurate, from a reference with other steps. It is compared with the
 * estimate of `whirl trust`.
 *
 * Without contacts, the reference is the extrapolation in long double (host/study/reference_run.h) of order 12, checked
 * by one of order 10. Until the run fails the tolerance, their difference must be far below it. With contacts, it
 * is RK4 in double with a 32nd of the run's step, checked by a 16th. */
#ifndef TESTS_HORIZONS_H
#define TESTS_HORIZONS_H

#include "derived.h"
#include "host/check/horizon.h"

typedef struct horizons_setting {
    const engine_kind *kind;
    bool compensated;
    wh_method method;
    image_tables tables;
    image_matrix_of matrix;
} horizons_setting;

typedef struct horizons {
    derived made;
    image *image; /* image with the setting of the run */
    /* image with the settings of the finer run (host/check/step_doubling.h), and of the reference */
    image *plain;
    step_doubling *twins;
    horizon estimate;
    /* [columns] time of the last accurate sample; infinite: accurate to the end */
    double *true_s;
    double true_until_s; /* the least of true_s, at most the end of the run */
    /* largest difference of the two references, divided by tolerance times range */
    double known;
    double look_s; /* time between two samples */
} horizons;

/* A scene of a text; `tolerance` as of `whirl trust`. */
horizons horizons_of(const char *text, const char *name, horizons_setting how, double tolerance);
void horizons_free(horizons *h);
/* Estimated time divided by the true one, for all columns together or for one; 1 if both are the run's end. */
double horizons_ratio(const horizons *h);
double horizons_column_ratio(const horizons *h, int column);

/* The text of a built-in file, "thomson.whirl", or of a file, with `more` appended; to be freed. */
char *horizons_builtin(const char *file, const char *more);
char *horizons_file(const char *path, const char *more);

#endif
