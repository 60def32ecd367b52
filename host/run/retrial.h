/* retrial.h: a run whose contacts have been too busy for its steps (busy.h), tried again in finer and finer ones: is it
 * off for that, and which step would do? What a run alone has of it does not tell: where a row of impacts comes to rest
 * anyway, or a hold changes in every step and each moment is found, nothing is lost; and two runs that both let rest what
 * does not agree. So what is believed is a run without overruns, and a step that the next finer one agrees with. */
#ifndef RUN_RETRIAL_H
#define RUN_RETRIAL_H

#include <signal.h>

#include "busy.h"

/* Off by more of its range than this is told; a cure is off by less than that. */
#define RETRIAL_TOLD 1e-2
#define RETRIAL_CURED 1e-3

typedef struct retrial {
    bool told;  /* it is to be warned of */
    bool known; /* there was a finer run without overruns: it is off by, of its range, */
    double off;
    uint64_t parts;  /* of the step, that would do; 0: none was found, */
    uint64_t finest; /* down to this one; 1: none was tried, as it would take too long */
    bool agreed;     /* the next finer step tells the same; else it only has no such steps */
} retrial;

/* Of the run that was watched in `b`, with an image of which `kind` runs more. `largest_J`: the largest entry of its
 * books; 0 where they are not known. `stop` may be NULL. */
retrial retrial_of(const busy *b, const engine_kind *kind, double largest_J,
                   const volatile sig_atomic_t *stop);

#endif
