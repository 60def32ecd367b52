/* turned.h: does a scene's step turn its sines on (core/stage_turn.h), or look them up at each stage (core/step.h)? */
#ifndef IMAGE_TURNED_H
#define IMAGE_TURNED_H

#include "image.h"

/* Most angles whose sines a step turns. */
#define TURNED_WAVES_MAX 256

/* Of an image's step and settings, and of nothing else: the interpreter and generated code agree. False where that was
 * set (--angles lookup), where tables take the place of sines, where there are contacts or no turn angle, and where the method or the list does not take it. */
bool image_turns(const image *im);

#endif
