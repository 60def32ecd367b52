/* figures_by_hand.h: figures of prices made of others, and held against what the program tells. */
#ifndef TESTS_HOST_FIGURES_BY_HAND_H
#define TESTS_HOST_FIGURES_BY_HAND_H

#include "host/price/cost.h"

/* Of the longest step; of cycles, where those of an instruction are a range. */
cost_figure longest_of(cost_figure f, double spread);
cost_figure range_of(const cost_board *b, cost_figure f);

/* All figures of a step that is predictable, but for the state's bytes. */
void expect_cost(const cost *want, const cost *have, const char *what);

#endif
