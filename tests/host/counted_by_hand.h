/* counted_by_hand.h: what is to be counted in an image to price its steps (host/price/cost_features.h), counted otherwise: of
 * an operation by what it depends on, found backwards from it; of a method by its row. */
#ifndef TESTS_HOST_COUNTED_BY_HAND_H
#define TESTS_HOST_COUNTED_BY_HAND_H

#include "host/price/cost_features.h"

/* Each fails the test where a count differs; `what` says of what. */

/* Of a step by stages. `given`: NULL where hardware computes the numbers. */
void expect_counts(const image *im, const cost_board *b, cost_number number, const cost_counts *c,
                   const operands *given, const char *what);
/* What is so of any step. */
void expect_common_counts(const image *im, cost_number number, const cost_counts *c,
                          const char *what);
void expect_list_counts(const cost_list *want, const cost_list *have, const char *what);

/* As long as compilers take a list for, a sine of radians as 25 operations. */
int length_by_hand(const tape *t);

#endif
