/* remedy.h: options with which a run has no finding. Each is tried before it is named: the run again with it, judged as the run was. */
#ifndef RUN_REMEDY_H
#define RUN_REMEDY_H

#include "verdict.h"

typedef enum remedy_outcome {
    REMEDY_DOES, /* nothing is found of the run with it */
    REMEDY_NONE, /* of those tried, none does */
    REMEDY_DEAR  /* it would take too long, or was stopped */
} remedy_outcome;

enum { REMEDY_TEXT = 120 };

/* "--step 50us --compensated". `parts`: so many of a step are tried first, 1 or more. `stop` ends the search, or is NULL. */
remedy_outcome remedy_find(const image *im, const image *plain, const engine_kind *kind,
                           double parts, const volatile sig_atomic_t *stop, char text[REMEDY_TEXT]);

/* Is nothing found of a run of this image? */
bool remedy_not_needed(const image *im, const image *plain, const engine_kind *kind,
                       const volatile sig_atomic_t *stop);

#endif
