/* turned.h: the choice between turning a scene's sines (core/step/stage_turn.h) and looking them up at each stage
 * (core/step.h). */
#ifndef IMAGE_TURNED_H
#define IMAGE_TURNED_H

#include "image.h"

/* Most angles whose sines a step turns. */
#define TURNED_WAVES_MAX 256

/* Depends only on the image's step and settings, so the interpreter and generated code agree. False with --angles
 * lookup, with tables in place of sines, with contacts, without a turn angle, and if the method or the list does not
 * support it. */
bool image_turns(const image *im);

#endif
