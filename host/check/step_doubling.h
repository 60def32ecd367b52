/* step_doubling.h: the difference between a run and a finer run of the same scene, over time.
 *
 * The finer run has half the step. It uses double with compensated sums, and no tables. Its method is the run's method
 * if that has at least order 4, else RK4. The difference contains all errors of the run, and the smaller error of the
 * finer run. With --matrix exact, both runs have the same step, and the difference is round-off. */
#ifndef CHECK_STEP_DOUBLING_H
#define CHECK_STEP_DOUBLING_H

#include "host/io/records.h"
#include "pole.h"

enum { STEP_DOUBLING_LOOKS = 20000 }; /* limit on the number of comparisons */

#define ACCELERATIONS_DOUBT 1e-3 /* a larger part is reported */
#define ACCELERATIONS_HINT \
    "hint: write it without a high power of a sine or cosine of a small angle, or choose parameters of " \
    "similar sizes\n"
/* Bound on the part of a highest derivative at a state that is wrong because of round-off, or because folding lost
 * digits of constants (host/number/folding.h): the largest of all, for the unknown *worst. */
double accelerations_doubt(const image *im, const double *angle_rad, const double *real,
                           int *worst);

/* The difference first reached `size` at the comparison that followed `time_s`. */
typedef struct passage {
    double time_s;
    double size;
} passage;

typedef struct passages {
    passage *passed; /* [count] in rising order of time_s and of size */
    int count;
    int room;
    double most;
} passages;

#define PASSAGE_GRAIN 1e-3 /* relative resolution of the recorded sizes */

/* Enters the difference `size`. `before_s`: time of the previous comparison. A NaN counts as infinite. */
void passages_enter(passages *p, double before_s, double size);
void passages_free(passages *p);

/* The time of the last comparison before the difference exceeded `level`; infinite if it never did. */
double passages_until_s(const passages *p, double level);

typedef struct step_doubling_column {
    double start;    /* first value of the finer run, in the column's unit */
    double low;      /* least value up to cut_s */
    double high;     /* largest value up to cut_s */
    double rounding; /* bound on the column's round-off in the finer run */
    double last;     /* difference at the last comparison */
    bool has_rate;   /* the column's rate is a component of the state */
    bool written;    /* the scene gives the start value as a number, so it has no round-off */
    int place;       /* index of the column with the coordinate itself, not with its rate */
    double one;      /* number of the column's units in one SI unit */
    double alike;    /* the largest range of all positions with the column's unit */
    passages off;
} step_doubling_column;

/* Forcing that aliases with the step (horizon.h). */
typedef struct step_doubling_aliased {
    int column;   /* the column with the largest difference; 0: no aliasing */
    double at_s;  /* the time of the largest difference */
    double part;  /* the largest difference, divided by the column's range */
    double value; /* the run's value, in the column's unit */
    double other; /* the value of a run with the step step_s */
    double step_s;
} step_doubling_aliased;

typedef struct step_doubling {
    image finer;         /* the finer run's image; shares the lists of the image it was made from */
    uint64_t each;       /* steps of the finer run in one step of the run */
    uint64_t operations; /* operations of all steps of the finer run */
    double left_out;     /* estimated error of the run, divided by the runs' difference */
    records *shape;      /* names and units of the columns: 0 is the time, outputs come last */
    bool refolded;       /* the finer run's constants are from image.refolded[] */
    int columns; /* number of columns that are no outputs: the time, coordinates and rates */
    step_doubling_column *column; /* [columns] */
    double end_s;                 /* end of the run's last completed step */
    wh_status status;             /* of the run's last step */
    void *run;                    /* the caller's run */
    bool unwrapped;        /* the finer run failed at an angle beyond the range of double's sine */
    double finer_failed_s; /* begin of the step in which the finer run failed; below 0: none */
    double overrun_s;      /* in either run, begin of a step with too many events; below 0: none */
    double jumped_s;       /* begin of the step that jumped over a pole (pole.h); below 0: none */
    bool missed;  /* true: a missed contact or force at jumped_s (missed.h); false: a pole */
    double cut_s; /* after this time nothing is known (failure, overrun, jump); below 0: none */
    step_doubling_aliased aliased; /* set by aliasing_find() */
    bool unaliased;                /* aliasing_find() could not finish: the budget was too small */
    const pole_crossing *jumped;   /* the run's search for poles; NULL: the scene needs none */
    records *finers;               /* like shape, for the finer run */
    void *finer_run;
    struct rounded *rounded;
    uint64_t stride; /* number of steps between two comparisons */
    double look_s;   /* time of the last comparison */
    double before_s; /* time of the comparison before the last one */
    uint64_t looks;
} step_doubling;

/* The method of the finer run, and the order by which its error falls as the step gets shorter. */
wh_method step_doubling_method(const image *im);
int step_doubling_order(const image *im);

/* Starts the finer run; the caller steps `run`. `jumped` may be NULL. The arguments must outlive the result. */
step_doubling *step_doubling_open(const image *im, const engine_kind *kind, void *run,
                                  const pole_crossing *jumped);
/* Call it at the start of the run and after each step. */
void step_doubling_enter(step_doubling *t);
/* The run has ended; `status` is that of its last step. */
void step_doubling_end(step_doubling *t, wh_status status);
void step_doubling_free(step_doubling *t); /* NULL is fine */

/* Estimated operations of a run and its search for events, plus step_doubling_finer_operations(). */
double step_doubling_operations(const image *im);
/* Estimated operations of the finer run, without its search for events. */
double step_doubling_finer_operations(const image *im);

#endif
