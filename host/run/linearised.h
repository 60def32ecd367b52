/* linearised.h: the motions of a run about its records: the frequencies and time constants of the scene as it is linear
 * there, which of them take part, and what the method makes of each. */
#ifndef RUN_LINEARISED_H
#define RUN_LINEARISED_H

#include "limits.h"
#include "watch.h"

enum { LINEARISED_MOST = 8 * WATCH_RECORDS };

/* Components beyond which the eigenvalues of so many records take longer than most runs: then of fewer of them. */
#define LINEARISED_SMALL 24

typedef struct linear_motion {
    complex_number value; /* 1/s; im >= 0 */
    complex_number rates; /* 1/s; limits.h says of what */
    double time_s;        /* the record's */
    double
        share; /* of a component's energy, at most of all: the square of its part in the slope; at most 1 */
    double off;     /* limits_off() over the run, */
    double ripple;  /* limits_ripple() where that is more; else 0 */
    int unknown[2]; /* which carry it, most first; -1: none */
} linear_motion;

typedef struct linearised {
    linear_motion motion[LINEARISED_MOST];
    int motions;
    const linear_motion *worst;   /* largest share * off, or NULL */
    const linear_motion *fastest; /* that takes part, or NULL */
    wh_form form;
    double span_s; /* of the run; of one that ended in its first step, that step */
    double step_s;
    wh_method method;
} linearised;

/* As limits.h takes it. */
limits_motion linearised_as(const linear_motion *m);

/* Of a run that `method` stepped. Free with linearised_free(). */
linearised *linearised_of(const watch *w, wh_method method);
void linearised_free(linearised *l); /* NULL is fine */

#endif
