/* remedy.h: options with which a run has no finding. Each is tried before it is named: the run again with it, judged as the run was. */
#ifndef CHECK_REMEDY_H
#define CHECK_REMEDY_H

#include "run_checks.h"

typedef enum remedy_outcome {
    REMEDY_DOES, /* nothing is found of the run with it */
    REMEDY_NONE, /* of those tried, none does */
    REMEDY_DEAR  /* the budget is spent, or it was interrupted */
} remedy_outcome;

enum { REMEDY_TEXT = 120 };

/* Of the run that was judged, from what its looks have left: "--step 50us --compensated". `parts`: so many of a step are
 * tried first, 1 or more. */
remedy_outcome remedy_find(const run_checks *v, double parts, char text[REMEDY_TEXT]);

/* Is nothing found of a run of this image? */
bool remedy_not_needed(const image *im, const image *plain, const engine_kind *kind);

#endif
