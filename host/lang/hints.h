/* hints.h: hints on statements that are valid but have a better form. */
#ifndef LANG_HINTS_H
#define LANG_HINTS_H

#include "model.h"

/* Returns the first active term that is dry friction, written as Q or F instead of with `friction`, or NULL. Such a Q
 * contains sign() of its coordinate's rate, and jumps at rate 0. Such an F has a kink there. *of: the coordinate. */
const term *hint_friction(const instance *made, const symbol **of);

#endif
