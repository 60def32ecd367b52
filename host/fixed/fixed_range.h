/* fixed_range.h: the ranges that components and inputs of a scene keep to. */
#ifndef FIXED_FIXED_RANGE_H
#define FIXED_FIXED_RANGE_H

#include <signal.h>

#include "host/image/image.h"
#include "host/number/enclosure.h"

/* What goes on while a plan is made, which may take as long as a run. */
typedef struct fixed_watch {
    const volatile sig_atomic_t *stop; /* not 0: leave off, and report nothing; NULL: never */
    bool progress;                     /* shown on standard error */
} fixed_watch;

bool fixed_watch_stops(const fixed_watch *watch);

/* range[reals + inputs] of components, then inputs: as declared; else twice as far from zero as a reference run of the scene
 * gets (double, its method), or half as near, where that keeps on one side of it; -1 to 1 where it stays zero. False: that
 * run failed (reported), or was stopped. */
bool fixed_ranges(const image *im, enclosure *range, bool *declared, const fixed_watch *watch,
                  diags *errors);

#endif
