/* cost_figure.c: see cost_figure.h. */
#include "cost_figure.h"

cost_figure cost_known(double value, cost_basis basis) {
    return (cost_figure){basis, basis, value, value, value, 1.0};
}

cost_figure cost_ranged(const cost_board *board, const cost_figure *instructions) {
    if (instructions->basis == COST_NOT_KNOWN) {
        return (cost_figure){0};
    }
    return (cost_figure){.basis = COST_RANGE,
                         .of = instructions->basis,
                         .least = instructions->least * board->cycles_least,
                         .most = instructions->most * board->cycles_most,
                         .bound = 1.0};
}

cost_figure cost_longest(cost_figure mean, double spread) {
    mean.value *= spread;
    mean.most *= spread;
    return mean;
}

double cost_bound_of(double value, double largest, double bound) {
    return value > largest ? 2.0 * bound - 1.0 : bound;
}
