/* step_work.h: the arithmetic that a step does beside its lists (core/step.h, step_end.h): where stages stand, what they
 * give added up, and the state moved on. Where numbers are software each of these costs as much as one of a list. */
#ifndef PRICE_STEP_WORK_H
#define PRICE_STEP_WORK_H

#include "operands.h"

typedef struct step_work {
    double sums; /* without the next */
    double products;
    double zero_sums; /* with a zero among what is added */
    double zero_products;
    double conversions; /* between whole numbers and others: of turn angles */
    double zero_conversions;
} step_work;

/* Of a step by stages, not as one matrix. `turned`: sines are turned on, and angles with them (core/stage_turn.h).
 * `keeps`: the compiler keeps positions of stages that no list reads, and sees
 * in turned steps, too, what is the same. `tabled`: shares are looked up in a table and multiplied by, whatever they are. */
step_work step_work_of(const image *im, bool turned, bool keeps, bool tabled,
                       const operands *given);

/* Of a step as one matrix, without the list's own. */
step_work step_work_of_matrix(const image *im, const operands *given);

#endif
