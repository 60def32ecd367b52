/* step_doubling.h: the difference between a run and a finer run of the same scene, over time.
 *
 * The finer run takes half the step, in double with compensated sums, and computes functions that the run looks up in
 * tables. It takes the run's method if that is of order 4 or more, else RK4. So the difference contains all errors of
 * the run: round-off, step, tables, formats. The finer run's own error is a part of it. If a step is the motion itself
 * (--matrix exact), the finer run takes the same step, and the difference is round-off. */
#ifndef TRUST_TWINS_H
#define TRUST_TWINS_H

#include "energy_residual.h"
#include "host/engine/loop.h"
#include "host/io/records.h"
#include "pole.h"

/* Most evenly spaced step ends at which the two are compared. */
enum { STEP_DOUBLING_LOOKS = 20000 };

typedef struct step_doubling_wish {
    const image *image;
    const engine_kind *kind;
    const image *plain;    /* from step_doubling_plain(); the image itself if that returns false */
    bool books;            /* keep the run's balance, and report its residual */
    bool watched;          /* the caller owns the run, and its pole search: */
    pole_crossing *jumped; /* NULL: no pole */
    void (*progress)(double share, void *told); /* now and then; or NULL */
    void *told;
} step_doubling_wish;

/* After `time_s` it was `size` or more for the first time. */
typedef struct passage {
    double time_s;
    double size;
} passage;

typedef struct passages {
    passage *passed; /* [count] rising in both */
    int count;
    int room;
    double most;
} passages;

/* Resolution of levels, as a part of themselves. */
#define PASSAGE_GRAIN 1e-3

/* The difference is `size` at one look; the look before was at before_s. A NaN passes every level. */
void passages_enter(passages *p, double before_s, double size);
void passages_free(passages *p);

/* The last look before it exceeded `level`; infinite if it never did. */
double passages_until_s(const passages *p, double level);

typedef struct step_doubling_column {
    double start; /* in the finer run, in the column's unit, as are: */
    double low;
    double high;
    double rounding; /* bound of its round-off in the finer run */
    double last;     /* difference at the last look */
    bool has_rate;   /* in the state: its origin may be anywhere */
    bool written;    /* its start is the scene's value, without the round-off of sums */
    int place;       /* the column that it is a rate of; itself if it is no rate */
    double one;      /* of SI's unit, in the column's */
    double alike;    /* the largest range of places with its unit */
    passages off;
} step_doubling_column;

/* Forcing that aliases with the step (horizon.h). */
typedef struct step_doubling_aliased {
    int column;    /* with the largest difference; 0: no aliasing */
    double at_s;   /* then */
    double part;   /* of its range, by which it is */
    double value;  /* in the column's unit, and */
    double other;  /* with another step, */
    double step_s; /* this one */
} step_doubling_aliased;

typedef struct step_doubling {
    image finer;         /* the other's image; shares its lists */
    uint64_t each;       /* its steps in one of the run's */
    uint64_t operations; /* that all of its steps took */
    double left_out;     /* factor for the finer run's own error, as a part of the difference */
    records *shape;      /* names and units of the columns: 0 is the time, outputs come last */
    bool
        otherwise; /* the finer one's constants are folded in another way: it knows no better, and ranges are the scene's own */
    int columns;   /* the time and those that follow: coordinates and rates, no outputs */
    step_doubling_column *column; /* [columns] */
    double end_s;                 /* of the run: its last step that was done */
    wh_status status;             /* the run's: its last step */
    void *run;                    /* the final state */
    bool unwrapped;        /* the finer run failed at an angle beyond the range of double's sine */
    double finer_failed_s; /* the finer run left all bounds after this time; below 0: it did not */
    double
        overrun_s; /* after this time one of them had too many events in a step; below 0: neither */
    double
        jumped_s; /* in a step after this time one of them jumped over a pole (host/check/pole.h); below 0: neither */
    bool missed; /* or passed through something (host/check/missed.h) */
    double
        cut_s; /* the last look before the first of these three: nothing is known after it; below 0: not cut */
    const double *finer_end;       /* [columns] the finer run's, at the last look */
    step_doubling_aliased aliased; /* after aliasing_find(), and */
    bool unaliased;                /* the budget was too small for its third run */
    budget looks; /* of step_doubling_run(): the steps of both runs may be spent again */
    bool stopped;
    books *books; /* NULL: no balance */
    bool jumps;   /* does the finer run search for poles and missed contacts now? */
    struct pair *pair;
} step_doubling;

/* The settings of the finer run's image if the run's own do not fit: without tables, and with a matrix for compensated
 * sums. False: they fit. */
bool step_doubling_plain(const image_settings *of, image_settings *plain);

/* The method of the finer run, and the order by which its error falls as the step gets shorter. */
wh_method step_doubling_method(const image *im);
int step_doubling_order(const image *im);

/* Both, from the start to the end of the run, or to the failure of one. The images must outlive them. */
step_doubling *step_doubling_run(const step_doubling_wish *w);
/* The same for a run that the caller steps: enter it at its start and after each step. `w` is copied. */
step_doubling *step_doubling_open(const step_doubling_wish *w, void *run);
void step_doubling_enter(step_doubling *t);
/* The run has ended; `status`: its last step's. */
void step_doubling_end(step_doubling *t, wh_status status);
void step_doubling_free(step_doubling *t); /* NULL is fine */

/* Operations that the two take, about; the finer one alone, without its events. */
double step_doubling_operations(const image *im, const image *plain);
double step_doubling_finer_operations(const image *im, const image *plain);

#endif
