/* hints.h: hints on statements that are valid but have a better form. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* Returns the first active Q or F that models dry friction, or NULL. *of: the coordinate that has the friction. */
const term *hint_friction(const instance *made, const symbol **of);

#endif
