/* hints.h: what is no error, but has a better way. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* The first Q that takes part and is dry friction written by hand, or NULL: it contains the sign
 * of its own coordinate's rate, and about rest at the start it jumps against the motion. */
const term *hint_friction(const instance *made);

#endif
