/* trusting.h: the common part of `whirl trust` and `whirl run`: the scene's image for the finer run. */
#ifndef CLI_TRUSTING_H
#define CLI_TRUSTING_H

#include "host/check/horizon.h"
#include "host/check/simulate.h"
#include "host/cli/load.h"
#include "host/fixed/fixed_plan.h"

/* The finer run's image (step_doubling_plain()), to be freed. NULL: the finer run uses the run's image. */
image *trusting_plain(const loaded *made);
/* Adds the scene's step in fixed point to the image. Takes as long as a run if ranges are undeclared. Returns an exit status;
 * *plan is to be freed. */
int trusting_plan(const char *command, image *im, bool progress, diags *errors, fixed_plan **plan);

/* Is this number of operations within --effort? If not, reports the estimated time, what takes it, and a hint, which ends
 * with an --effort that suffices. */
bool effort_suffices(const char *command, double effort, double operations, const char *hint,
                     const char *what, ...) __attribute__((format(printf, 5, 6)));

#endif
