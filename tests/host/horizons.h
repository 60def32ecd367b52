/* horizons.h: the time until which a run is accurate, from a comparison with a reference. Tests compare this true
 * time with the estimate of `whirl trust`.
 *
 * The reference runs in double, with compensated sums and a 32nd of the run's step. A second reference with a 16th of
 * the step checks the first: until the run fails the tolerance, the difference of the two references must be far
 * below the tolerance. */
#ifndef TESTS_HORIZONS_H
#define TESTS_HORIZONS_H

#include "derived.h"
#include "host/check/run_checks.h"

typedef struct horizons_setting {
    const engine_kind *kind;
    bool compensated;
    wh_method method;
    image_tables tables;
    image_matrix_of matrix;
} horizons_setting;

typedef struct horizons {
    derived made;
    image *image; /* image with the settings of the run */
    /* image with the settings of the finer run (host/check/step_doubling.h); the reference uses it, too */
    run_checks *checks;
    const step_doubling *doubling;
    horizon estimate;
    /* [columns] time until which the column is accurate; infinite: until the end of the run */
    double *true_s;
    double true_until_s; /* least of true_s, or the end of the run */
    /* without contacts: largest difference of the two references, divided by tolerance times range */
    double known;
    double look_s; /* time between two samples */
} horizons;

/* Runs the scene `name` of a text, its reference and the estimate. `tolerance` has the meaning of `whirl trust`. */
horizons horizons_of(const char *text, const char *name, horizons_setting how, double tolerance);
void horizons_free(horizons *h);
/* horizons_ratio(): the estimated time divided by the true time. horizons_column_ratio(): the same for one column. 1
 * if both times are the end of the run. */
double horizons_ratio(const horizons *h);
double horizons_column_ratio(const horizons *h, int column);

/* The text of a built-in file such as "thomson.whirl", or of the file at `path`, followed by `more`. The caller
 * frees the text. */
char *horizons_builtin(const char *file, const char *more);
char *horizons_file(const char *path, const char *more);

#endif
