/* reference_run.h: the reference of priced runs: the motion at evenly spaced records, computed twice with independent
 * settings. The difference of the two is its error estimate, and limits the time until which it is trusted.
 *
 * Without contacts the method is extrapolation in long double (below), which shares only the operation list with
 * the compared runs. With contacts, or if a jump or a pole stops the extrapolation, the method is RK4 in double with compensated
 * sums. Its steps are far finer than the scene's, and the second computation takes half as many. */
#ifndef STUDY_REFERENCE_RUN_H
#define STUDY_REFERENCE_RUN_H

#include <float.h>

#include "host/engine/engine.h"
#include "host/image/op_list.h"
#include "host/io/records.h"
#include "host/number/functions.h"

/* === functions and lists in long double ======================================================= */
/* The language's functions, and an operation list, in long double: 64 binary digits on x86, 113 on AArch64. The
 * extrapolated reference is computed with them. These functions use no code of the core or of a library. If an
 * iteration begins with a double's value, the missing digits are computed here.
 *
 * Errors are a few units of the last place; for powers they are about |exponent log(base)| times as large. */

/* Does long double have more digits than double? If not, the reference reports that. */
#define LONG_IS_LONGER (LDBL_MANT_DIG > DBL_MANT_DIG)

static inline long double long_size(long double x) { return x < 0.0L ? -x : x; }

/* Angles of up to 2^31 quarter turns. */
void long_sincos(long double rad, long double *sine, long double *cosine);
long double long_root(long double x);
long double long_power(long double base, long double exponent);
/* A function of host/number/functions.h at x, or at (x, y). */
long double long_call(function_id function, long double x, long double y);

typedef struct long_list long_list;

/* The inputs of a list. Noise and accelerations of contacts are not available: both are 0. */
typedef struct long_leaves {
    const long double *angle_rad; /* unwrapped */
    const long double *linear;
    const long double *rate;
    const double *input;
    long double time_s;
} long_leaves;

long_list *long_list_new(const op_list *t); /* `t` must outlive it */
void long_list_free(long_list *l);          /* NULL is fine */
/* result[t->results] */
void long_list_run(long_list *l, const long_leaves *in, long double *result);

/* Does a result depend on an operation of this code? */
bool long_list_asks(const op_list *t, int result, op_code code);

/* === extrapolation ============================================================================ */
/* The motion of an image without contacts by the method of Gragg, Bulirsch and Stoer in long double.
 * It extrapolates modified midpoint rules of 2, 4, ..., 2 k substeps to step zero by Aitken and Neville (Hairer,
 * Norsett and Wanner, Solving Ordinary Differential Equations I, II.9). It shares no step, sine or method with the
 * core. */

typedef struct extrapolation extrapolation;

/* The accuracy of an extrapolation: `columns` rules (order 2 columns). In each step the last two columns must agree
 * within `tolerance` of each component's largest value so far. */
typedef struct extrapolation_setting {
    int columns; /* <= EXTRAPOLATION_COLUMNS */
    double tolerance;
} extrapolation_setting;
enum { EXTRAPOLATION_COLUMNS = 12 };

typedef enum extrapolation_status {
    EXTRAPOLATION_OK,
    EXTRAPOLATION_SMALL, /* no step is small enough, because of a jump, a pole, or a value that is not finite */
    EXTRAPOLATION_LONG /* the limit of operations was reached */
} extrapolation_status;

/* Starts at the image's start; the image must outlive it. `operations`: limit on all evaluated operations. */
extrapolation *extrapolation_new(const image *im, extrapolation_setting how, double operations);
void extrapolation_free(extrapolation *e);
/* Advances by span_s, which may have any length. */
extrapolation_status extrapolation_go(extrapolation *e, long double span_s);
/* The state, angles first, as engine_kind.state() has it. Valid until extrapolation_free(). */
const long double *extrapolation_state(const extrapolation *e);
double extrapolation_operations(const extrapolation *e);

/* === the reference ============================================================================ */
/* A cheap reference: a run in double with compensated sums, compared with one of twice its step. */
typedef struct reference_steps {
    uint64_t steps; /* steps in a record's spacing, even; 0: compute the best reference instead */
    wh_method method;
    int order;    /* order of the method's error */
    double limit; /* trusted while both runs differ by less than this part of the largest value */
} reference_steps;

typedef struct reference_wish {
    const image *image;  /* image with any step and end */
    whole_ratio spacing; /* interval of the records, s */
    int records;         /* number of records after the start */
    double operations;   /* limit on the operations of each of the two computations */
    reference_steps by;
} reference_wish;

typedef enum reference_kind {
    REFERENCE_NONE, /* no trusted reference: `why` */
    REFERENCE_EXTRAPOLATED,
    REFERENCE_FINE_STEPS
} reference_kind;

/* The extent of a column's numbers. */
typedef struct reference_column {
    bool
        counts; /* enters the worst error of all components: a value or rate that the reference knows */
    long double largest; /* largest size over the records */
    long double off;     /* largest difference of the two computations */
} reference_column;

typedef struct reference {
    reference_kind kind;
    records *shape;           /* names and units of the columns, as `whirl run --csv` has them */
    int columns;              /* as in the shape; column 0 is the time */
    int wanted;               /* requested records after the start */
    int records;              /* trusted records after the start */
    long double *row;         /* [wanted + 1][columns] in the units of the columns */
    reference_column *column; /* [columns] */
    double limit; /* trusted while columns differ by less than this part of the largest value */
    char *how;    /* the two settings, in words */
    char *why; /* the reason for an early end of the trust, or for no reference at all; else "" */
    /* the reference is not trusted to the end because its steps are not small enough, not because the motions
     * diverge */
    bool broken;
    bool still;   /* no quantity moves, so there is no reference */
    bool stopped; /* interrupted: it is of no use */
} reference;

/* Always succeeds; check kind and stopped. The image must outlive it. */
reference *reference_new(const reference_wish *w);
/* From now on use at most this many records after the start. */
void reference_cut(reference *r, int until);
/* The largest difference of the two computations in columns that count, as a part of the column's largest value. */
double reference_agreement(const reference *r);
void reference_free(reference *r); /* NULL is fine */

/* The column of a name, "X", "X'" or an output's, or -1. *noisy: it is an output with its own noise, which has no reference. */
int reference_find(const reference *r, const char *name, bool *noisy);

/* A state in long double as a row of records. */
typedef struct long_rows long_rows;

long_rows *long_rows_new(const records *shape); /* `shape` must outlive it */
void long_rows_free(long_rows *l);
/* Fills row[shape->columns] in the columns' units; `state` as engine_kind.state() has it, angles first. */
void long_rows_read(long_rows *l, const long double *state, long double time_s, long double *row);

/* A reference by the interpreter: RK4 in double with compensated sums, by steps far finer than the scene's. It shares most of its
 * code with the compared runs.
 *
 * fine_steps_of() is the number of steps in a record's spacing for the finer of the two computations, an even number. It is the
 * requested number, or else the largest useful one within the limit of operations. */
uint64_t fine_steps_of(const reference_wish *w);
/* Fills row[(wanted + 1)][columns] with this many steps a record; returns the records after the start. */
int fine_steps_run(const reference_wish *w, const records *shape, uint64_t steps, long double *row);

/* === the deviation of a run =================================================================== */

/* A run takes `steps` steps in `records` spacings of the records. If a step is longer than a spacing, only the records at its
 * ends are compared. */
typedef struct deviation_pace {
    uint64_t steps;
    uint64_t records;
} deviation_pace;

/* The compared columns. */
typedef struct deviation_of_what {
    int column; /* a column of the reference, compared in its unit; or -1: all that count, each as a part of its largest value */
    double give_up; /* a run with a larger error is stopped as useless */
} deviation_of_what;

typedef struct deviation {
    /* the reference reached the end with errors below give_up and without clamped values */
    bool usable;
    double error; /* largest error of all records; if unusable, of the records before the stop */
    int column;   /* the column with that error */
    double known; /* the reference's own error in that column: errors near it are only bounds */
    double operations;       /* evaluated */
    double evaluations;      /* of the accelerations or the matrix, per simulated second */
    double evaluations_most; /* most evaluations in one step */
} deviation;

/* `im`: the reference's scene, with a step of this pace. */
deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what);

#endif
