/* horizons.h: until when a run is right, by a reference that shares no step with it: what `whirl trust` estimates.
 *
 * Without contacts the reference is the project's extrapolation in long double (host/study/extrapolation.h), of order 12,
 * beside another of order 10: what the two differ by must be far below the tolerance where the run passes it, or the
 * reference knows nothing. With contacts it is RK4 in double by steps a 32nd of the run's, beside a 16th. */
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
    image *image; /* with the setting */
    image
        *plain; /* as the finer run wants it (host/check/step_doubling.h); for the reference, too */
    step_doubling *twins;
    horizon estimate;
    double *true_s;      /* [columns] last look at which it was right; infinite: to the end */
    double true_until_s; /* the least of them; the end */
    double
        known; /* what the references differ by at the passages, in parts of the tolerance times the range: the most */
    double look_s; /* between looks */
} horizons;

/* A scene of a text; `tolerance` as of `whirl trust`. */
horizons horizons_of(const char *text, const char *name, horizons_setting how, double tolerance);
void horizons_free(horizons *h);
/* Estimate by truth, of all columns together or of one; 1 where both are the end. */
double horizons_ratio(const horizons *h);
double horizons_column_ratio(const horizons *h, int column);

/* The text of a built-in file, "thomson.whirl", or of a file, with more behind it; to be freed. */
char *horizons_builtin(const char *file, const char *more);
char *horizons_file(const char *path, const char *more);

#endif
