/* cost_fixed.h: what a step in fixed point costs, predicted by the features and figures of cost_fixed_row.h. */
#ifndef PRICE_COST_FIXED_H
#define PRICE_COST_FIXED_H

#include "cost.h"
#include "cost_fixed_row.h"

extern const char *const cost_fixed_words[COST_FIXED_FEATURES];
extern const unsigned cost_fixed_taken[COST_FIXED_FEATURES];

/* Of an image that has its step in fixed point. */
void cost_fixed_features(const image *im, double feature[static COST_FIXED_FEATURES]);

/* The sum, or -1 where a feature was in no fitted scene. */
double cost_fixed_sum(const cost_fixed_fit *fit, cost_quantity q,
                      const double feature[static COST_FIXED_FEATURES]);

/* Of an image that has its step in fixed point. */
cost cost_fixed_of(const image *im, const cost_board *board);

#endif
