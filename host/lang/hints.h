/* hints.h: what is no error, but has a better way. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* The first Q or F that takes part and is dry friction written by hand, or NULL; *of is the coordinate that it rubs on.
 * A Q contains the sign of its own coordinate's rate, and about rest at the start it jumps against the motion; an F grows
 * with the size of a rate. */
const term *hint_friction(const instance *made, const symbol **of);

#endif
