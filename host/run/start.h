/* start.h: whether a run can start where its scene says. */
#ifndef RUN_START_H
#define RUN_START_H

#include "host/derive/program.h"

/* False, reported at each stop that the run would start beyond, by more than rounding, or where
 * it has no value. */
bool start_is_possible(const program *p, const instance *inst, diags *errors);

#endif
