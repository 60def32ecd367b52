/* step_doubling.h: a run beside a finer one of the same scene, and by how much the two differ, when.
 *
 * The finer run takes half the step, in double with compensated sums, computes what the run looks up in tables, and
 * takes the run's method where that is of order 4 or more, else RK4. So it differs from the run in all that puts the run
 * off: rounding, the step, tables, formats. Its own error is a part of that. Of a step that is the motion itself
 * (--matrix exact) it takes the same, and tells what rounding does. */
#ifndef TRUST_TWINS_H
#define TRUST_TWINS_H

#include "energy_residual.h"
#include "host/engine/loop.h"
#include "host/io/records.h"
#include "pole_crossing.h"

/* The two are compared at so many evenly spaced ends of steps, at most. */
enum { STEP_DOUBLING_LOOKS = 20000 };

typedef struct step_doubling_wish {
    const image *image;
    const engine_kind *kind;
    const image *plain; /* as step_doubling_plain() says: the image itself where it says nothing */
    bool books;         /* keep the run's books, and tell what they leave over */
    bool watched;       /* the caller owns the run, and what it jumped over: */
    pole_crossing *jumped;                      /* NULL: over nothing */
    void (*progress)(double share, void *told); /* now and then; or NULL */
    void *told;
} step_doubling_wish;

/* Behind `time_s` it was for the first time as large as `size`. */
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

/* Levels are told apart to this part of themselves. */
#define PASSAGE_GRAIN 1e-3

/* The difference is `size` at one look, the look before that was at before_s. What is no number passes every level. */
void passages_enter(passages *p, double before_s, double size);
void passages_free(passages *p);

/* The last look before it was more than `level`; infinite where it never was. */
double passages_until_s(const passages *p, double level);

/* A coordinate or rate. */
typedef struct step_doubling_column {
    double start; /* in the finer run, in the column's unit, as are: */
    double low;
    double high;
    double rounding; /* what may move of it by rounding alone, in the finer run */
    double last;     /* difference at the last look */
    bool has_rate;   /* in the state: its origin may be anywhere */
    bool written;    /* it starts where the scene has written, and not where sums have rounded */
    int place;       /* the column that it is a rate of; itself where it is none */
    double one;      /* of SI's unit, in the column's */
    double alike;    /* the largest range of what is no rate and has its unit */
    passages off;
} step_doubling_column;

/* More goes on within a step than its stages see (aliasing.h). */
typedef struct step_doubling_aliased {
    int column;    /* that is furthest off; 0: none is */
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
    double
        left_out; /* of the run's error, as a part of what the two differ by: the finer one's own */
    records *shape; /* names and units of the columns: 0 is the time, outputs come last */
    bool
        otherwise; /* the finer one's constants are folded in another way: it knows no better, and ranges are the scene's own */
    int columns;   /* the time and those that follow: coordinates and rates, no outputs */
    step_doubling_column *column; /* [columns] */
    double end_s;                 /* of the run: its last step that was done */
    wh_status status;             /* the run's: its last step */
    void *run;                    /* where it ended */
    bool unwrapped;        /* the other failed for an angle beyond those whose sine double knows */
    double finer_failed_s; /* the other left all bounds behind this time; below 0: it did not */
    double
        overrun_s; /* behind this time one of them had more events in a step than it takes; below 0: neither */
    double
        jumped_s; /* in a step behind this time one of them jumped over a pole (host/check/pole_crossing.h); below 0: neither */
    bool missed;  /* or passed through something (host/check/missed.h) */
    double
        cut_s; /* the last look before the first of these three: nothing is known behind it; below 0: they are none */
    const double *finer_end;       /* [columns] the finer run's, at the last look */
    step_doubling_aliased aliased; /* after aliasing_find() */
    bool stopped;
    books *books; /* NULL: none */
    bool jumps;   /* is the finer run asked for poles and missed contacts now? */
    struct pair *pair;
} step_doubling;

/* The settings of the image that the finer run goes by, where the run's own will not do: without tables, and a matrix that
 * is written for compensated sums. False: it does. */
bool step_doubling_plain(const image_settings *of, image_settings *plain);

/* The method of the finer run, and the order by which its error falls as the step gets shorter. */
wh_method step_doubling_method(const image *im);
int step_doubling_order(const image *im);

/* The two, from the start to the end of the run, or to where one of them fails. The images must outlive them. */
step_doubling *step_doubling_run(const step_doubling_wish *w);
/* The same beside a run that the caller steps: enter it at its start and after each step. `w` is copied. */
step_doubling *step_doubling_open(const step_doubling_wish *w, void *run);
void step_doubling_enter(step_doubling *t);
/* The run has ended; `status`: its last step's. */
void step_doubling_end(step_doubling *t, wh_status status);
void step_doubling_free(step_doubling *t); /* NULL is fine */

/* Operations that the two take, about; the finer one alone, without its events. */
double step_doubling_operations(const image *im, const image *plain);
double step_doubling_finer_operations(const image *im, const image *plain);

#endif
