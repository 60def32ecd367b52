/* hints.h: hints on statements that are valid but have a better form. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* Returns the first active Q or F that is dry friction without the statement `friction`, or NULL. Such a Q contains
 * sign() of its coordinate's rate and jumps against the motion at rate 0; such an F has a kink. *of: the coordinate. */
const term *hint_friction(const instance *made, const symbol **of);

#endif
