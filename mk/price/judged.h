/* judged.h: how far off a fit is, and what is promised of it. For mk/price only. */
#ifndef PRICE_JUDGED_H
#define PRICE_JUDGED_H

#include "fitted.h"

/* The bounds of all classes, and a line of each for people, on standard error (with PRICE_SHOW each row's, with PRICE_PARTS what
 * that setting's sums are made of). No class is better known than the plain one; of one that few scenes tested, twice the
 * distance is promised. */
void judge_all(cost_fit *f, int board, cost_number number, cost_quantity q);

#endif
