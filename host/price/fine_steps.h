/* fine_steps.h: a reference by the interpreter itself: RK4 in double with compensated sums, by steps far finer than the
 * scene's. It shares much with what it judges, but for the step. */
#ifndef PRICE_FINE_STEPS_H
#define PRICE_FINE_STEPS_H

#include "reference_wish.h"

/* The steps of a record's spacing: the wished ones; else those that are fine enough for the scene and within the operations, for the finer of
 * the two computations; even. */
uint64_t fine_steps_of(const reference_wish *w);
/* Fills row[(wanted + 1)][columns] by so many steps a record; returns the records behind the start. */
int fine_steps_run(const reference_wish *w, const records *shape, uint64_t steps, long double *row);

#endif
