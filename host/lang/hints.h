/* hints.h: hints on statements that are valid but have a better form. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* The first active Q or F that is dry friction written by hand, or NULL; *of is the coordinate with friction. Such a Q
 * contains the sign of its own coordinate's rate and jumps against the motion about rest at the start. Such an F grows
 * with the size of a rate. */
const term *hint_friction(const instance *made, const symbol **of);

#endif
