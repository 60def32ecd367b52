/* fitted.h: figures of each class of work, fitted to counted rows. For mk/price only. */
#ifndef PRICE_FITTED_H
#define PRICE_FITTED_H

#include "counted.h"

/* Has this row such a figure of this board and number? */
bool takes_part(const counted *r, int board, cost_number number, cost_quantity q);

/* The sum of a row: what is predicted of it; below zero where nothing is. */
double sum_of(const cost_fit *f, const counted *r, cost_quantity q);

/* Fitted in rounds, each with the weights that follow from the one before. `like`: the figures of a board that is alike, to
 * begin at, or NULL. Bounds are not known yet: judged.h. */
cost_fit fit(int board, cost_number number, cost_quantity q, const cost_fit *like);

#endif
