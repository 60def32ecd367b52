/* reference_run.h: a reference run in double with short steps and compensated sums. A second run with twice the step
 * estimates the reference's error. The estimate omits the errors of operations, sines and event search. */
#ifndef STUDY_REFERENCE_RUN_H
#define STUDY_REFERENCE_RUN_H

#include "host/engine/engine.h"
#include "host/io/records.h"

/* === the reference ============================================================================ */
/* If `steps` is 0, Whirl uses nystroem5, halves its steps until two runs agree, and ignores the other fields. */
typedef struct reference_steps {
    uint64_t steps; /* number of steps from one record to the next; even */
    wh_method method;
    int order;    /* order of the method's error */
    double limit; /* a record is trusted if the runs differ by at most this part of `largest` */
} reference_steps;

typedef struct reference_request {
    const image *image;  /* the scene; its runs end at the last record, not at the scene's end */
    whole_ratio spacing; /* interval of the records, s */
    int records;         /* number of records after the start */
    double operations;   /* limit on the operations of the run with the shortest steps */
    reference_steps by;
} reference_request;

typedef struct reference_column {
    bool counts;    /* it is a coordinate or rate, and its values are more than round-off */
    double largest; /* largest magnitude in the trusted records */
    /* largest difference of the two runs; divided by 2^order - 1 if reference_steps.steps > 0 */
    double off;
} reference_column;

typedef struct reference {
    bool reliable;            /* false: there is no trusted reference, see `why` */
    records *shape;           /* names and units of the columns, as `whirl run --csv` has them */
    int columns;              /* as in the shape; column 0 is the time */
    int wanted;               /* number of requested records after the start */
    int records;              /* number of trusted records after the start */
    double *row;              /* [wanted + 1][columns] in the units of the columns */
    reference_column *column; /* [columns] */
    double limit;             /* the requested reference_steps.limit, or the default */
    char *how;                /* the two runs, in words */
    char *why;                /* why trust ends early, or why there is no reference; or NULL */
    bool still;               /* no quantity moves, so there is no reference */
    bool stopped;             /* interrupted: the result must not be used */
} reference;

/* Never NULL; check `reliable` and `stopped`. The image must outlive the result. */
reference *reference_new(const reference_request *w);
/* Limits r->records, the trusted records after the start, to `until`. */
void reference_cut(reference *r, int until);
/* A column's `off` as a part of its `largest`. `column` -1: the maximum over all columns that count. */
double reference_agreement(const reference *r, int column);
void reference_free(reference *r); /* NULL is fine */

/* The column of `name`, such as "theta'", or -1. *noisy: it is an output with noise, which has no reference. */
int reference_find(const reference *r, const char *name, bool *noisy);

/* === the deviation of a run =================================================================== */

/* A run makes `steps` steps while the reference advances by `records` records. Then the two are compared. */
typedef struct deviation_pace {
    uint64_t steps;
    uint64_t records;
} deviation_pace;

typedef struct deviation_of_what {
    int column;     /* the compared column; -1: all columns with reference_column.counts */
    double give_up; /* a run with a larger error is stopped as useless */
} deviation_of_what;

typedef struct deviation {
    bool usable;  /* the run reached its end without saturation, and no error exceeded give_up */
    double error; /* largest error of all records; if unusable, of those up to the stop */
    int column;   /* the column with the largest error */
    double known; /* the reference's error in that column, in the unit of `error` */
    double evaluations; /* evaluations of the accelerations or the matrix, per simulated second */
    double evaluations_most; /* most evaluations in one step */
} deviation;

/* `im`: the reference's scene, with the step that `pace` describes. */
deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what);

#endif
