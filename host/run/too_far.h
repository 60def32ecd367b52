/* too_far.h: in words, that an angle turned too far for a step that turns its sines (core/stage_turn.h). */
#ifndef RUN_TOO_FAR_H
#define RUN_TOO_FAR_H

#include <stdio.h>

#include "engine.h"

/* "'theta' turns too far for sines that are turned in the step after t = 1.2 s: by 2.4 rad": of a run whose step was
 * refused with WH_E_TURN. */
void too_far_say(FILE *out, const image *im, const engine_kind *kind, const void *run);

/* What helps. */
#define TOO_FAR_HINT "--angles lookup takes it on, up to half a turn a step; or a smaller --step"

#endif
