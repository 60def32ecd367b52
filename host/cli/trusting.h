/* trusting.h: the common part of `whirl trust` and `whirl run`: the scene's image for the finer run. */
#ifndef CLI_TRUSTING_H
#define CLI_TRUSTING_H

#include "host/check/horizon.h"
#include "host/check/simulate.h"
#include "host/cli/load.h"
#include "host/fixed/fixed_plan.h"

/* The data that load() must store for trusting_plain(). */
load_keep trusting_keep(const image_settings *settings);
/* The image of step_doubling_plain(), to be freed. NULL: it is the image itself. */
image *trusting_plain(const loaded *made);
/* The scene's step in fixed point, which the image then has: takes as long as a run if ranges are undeclared. Returns an exit
 * code; *plan is to be freed. */
int trusting_plan(const char *command, image *im, bool progress, diags *errors, fixed_plan **plan);

/* Of an effort that is too much: how long it takes, and the end of its hint, with the --effort that would do. */
double effort_minutes(double operations);
void effort_say(double operations);

#endif
