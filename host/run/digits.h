/* digits.h: does a run have too few digits for where it is? A float keeps seven: a metre's motion a thousand kilometres from
 * the origin is made of sixteen places, steps of a millimetre there add nothing, and no smaller step helps. The energy's
 * balance allows for rounding, and so does not tell. */
#ifndef RUN_DIGITS_H
#define RUN_DIGITS_H

#include <signal.h>

#include "belief.h"
#include "watch.h"

typedef struct digits {
    bool not_known; /* it may: to run it again would take too long */
    int component;  /* which is off for it; -1: none */
    double off;     /* by so much, */
    double range;   /* of the range that it has with more digits */
    double place;   /* to which it is rounded */
    bool energy;    /* and of the energy so much is missing, which more digits keep: */
    double left_J;
    double part;      /* of its largest entry */
    bool by_sums;     /* its steps were not what its slopes asked for; else its slopes are off */
    bool compensated; /* compensated sums would do, */
    bool in_double;   /* or a float's run in double, */
    bool in_both;     /* or both together: these were tried */
} digits;

/* Does some coordinate move so far from its origin that its slopes may have too few digits? */
bool digits_far(const image *im, const engine_kind *kind, const watch *w);

/* So far that another run in double, which has as few, does not tell. */
bool digits_none(const image *im, const engine_kind *kind, const watch *w);

/* Of a run to its end, of which nothing else is said. Where it did not follow its slopes, was not started where it was told
 * to, took place far from the origin, or left something of its energy over that only rounding explains, it is run again in
 * double with compensated sums, and told where that has what is missing or goes elsewhere. A motion of less than 3e-7 of where
 * it takes place is none, nor is energy that goes to and fro beside ten million times as much. `stop` may be NULL. */
digits digits_of(const image *im, const engine_kind *kind, const watch *w, const belief *b,
                 const volatile sig_atomic_t *stop);
void digits_say(FILE *out, const image *im, const engine_kind *kind, const digits *d);

#endif
