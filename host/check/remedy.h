/* remedy.h: options with which a run has no finding. Each is tried before it is named: the run again with it, judged as the run was. */
#ifndef CHECK_REMEDY_H
#define CHECK_REMEDY_H

#include "run_checks.h"

typedef enum remedy_outcome {
    REMEDY_DOES, /* the run has no findings with it */
    REMEDY_NONE, /* all those tried failed */
    REMEDY_DEAR  /* the budget is spent, or it was interrupted */
} remedy_outcome;

enum { REMEDY_TEXT = 120 };

/* For a finished run, with the budget that its checks have left: "--step 50us --compensated". `parts`: this many of a
 * step are tried first, 1 or more. */
remedy_outcome remedy_find(const run_checks *v, double parts, char text[REMEDY_TEXT]);

/* Is a run of this image without findings? */
bool remedy_not_needed(const image *im, const image *plain, const engine_kind *kind);

#endif
