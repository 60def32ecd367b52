/* trusting.h: parts that several commands share: the step in fixed point, and the limit of --effort. */
#ifndef CLI_TRUSTING_H
#define CLI_TRUSTING_H

#include "host/check/horizon.h"
#include "host/cli/load.h"
#include "host/fixed/fixed_plan.h"
#include "host/study/simulate.h"

/* Sets *plan and im->fixed to the plan of the step in fixed point. The caller frees *plan. If ranges are not declared,
 * a run in double measures them. Returns an exit status. After an error (reported), *plan is NULL. */
int trusting_plan(const char *command, image *im, bool progress, diags *errors, fixed_plan **plan);

/* Is this number of operations within --effort? If not, reports the estimated time of `what`, and `hint`. */
bool effort_suffices(const char *command, double effort, double operations, const char *hint,
                     const char *what, ...) __attribute__((format(printf, 5, 6)));

#endif
