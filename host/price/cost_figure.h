/* cost_figure.h: one figure of a price, how it is known and between what it is; and what is made of figures. */
#ifndef PRICE_COST_FIGURE_H
#define PRICE_COST_FIGURE_H

#include "cost_board.h"

/* A figure. `value` is the best one number, and between `least` and `most` it is promised to be; where `basis` is
 * COST_RANGE there is no best number, and `value` is 0. COST_NOT_KNOWN: all are 0. */
typedef struct cost_figure {
    cost_basis basis;
    cost_basis
        of; /* of a prediction: of what kind the figures were that it was fitted to; else as basis */
    double value;
    double least;
    double most;
    double
        bound; /* of a prediction: most is value * bound, and least not far below value / bound; else 1 */
} cost_figure;

/* One number, and known to be it. */
cost_figure cost_known(double value, cost_basis basis);

/* Cycles where nobody counts them: instructions times the board's cycles of one. */
cost_figure cost_ranged(const cost_board *board, const cost_figure *instructions);

/* The longest step where the mean one is this: in soft arithmetic, operands make the difference. */
cost_figure cost_longest(cost_figure mean, double spread);

/* The bound that is promised of a value that is larger than all that was fitted: twice the distance. */
double cost_bound_of(double value, double largest, double bound);

#endif
