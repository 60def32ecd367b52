/* choice_counted.h: a choice by prices that are counted. */
#ifndef PRICE_CHOICE_COUNTED_H
#define PRICE_CHOICE_COUNTED_H

#include "choice.h"

/* choice_make() with counted prices of what is chosen and of the runner-up; where nothing fits, of what comes nearest.
 * Whatever these figures change is chosen anew. *end: MEASURED_MISSING where a tool is missing; nothing is chosen then. */
choice choice_counted(trials *t, choice_wish *w, measured_prices *m, measured_end *end);

#endif
