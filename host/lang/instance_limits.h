/* limits.h: what can only be checked with the numbers of one run: the ranges of contacts
 * and of noise that take part in it. */
#ifndef LANG_LIMITS_H
#define LANG_LIMITS_H

#include "value.h"

/* Report what is out of range in `made`, whose parameters are `known`. Inputs count with the
 * value they start with: whoever changes them while running answers for what they are then. */
void limits_check(const instance *made, valuation *known);

#endif
