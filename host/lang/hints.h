/* hints.h: hints on statements that are valid but have a better form. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* Returns the first active Q or F that is dry friction without the statement `friction`, or NULL. *of is the coordinate
 * with the friction. Such a Q contains the sign of its coordinate's rate. At the start, it jumps against the motion
 * when this rate changes its sign. Such an F has a kink at rate 0. */
const term *hint_friction(const instance *made, const symbol **of);

#endif
