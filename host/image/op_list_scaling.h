/* op_list_scaling.h: factors of a list's values that cancel, as in a numerator and its denominator, or in the equations
 * of a system. Some make the constants exact in float: (1.08 - 0.36 s^2) / M is (27 - 9 s^2) / (25 M). */
#ifndef IMAGE_OP_LIST_SCALING_H
#define IMAGE_OP_LIST_SCALING_H

#include "host/image/op_list.h"

/* Returns the relative error of a finished list's results from rounding its constants to float, with exact operations.
 * It is the root mean square over the results and over three sizes of rates, each summed over artificial states. A
 * result has a small weight if it changes nothing the list reads. The reference is `like`: the same list, or one with
 * equal results. NaN if undefined. */
double op_list_bias(const op_list *t, const op_list *like);

/* Returns the allowed number of additional operations: one, and one for each forty operations. */
int op_list_scaling_price(const op_list *t);

/* Replaces *t by a list with the same results, except for double's round-off, and at most half the bias, if there is
 * one with at most `price` additional operations. */
void op_list_scale(op_list **t, int price);

/* Vectors of exponents: for any x > 0, each value may be multiplied by x to its exponent. A vector has an exponent for
 * each operation, then two for each operation's operands, which are nonzero only for raw values that are multiplied. */
typedef struct op_list_freedoms {
    double *exponent; /* [count * length]; the caller frees it */
    int count;
    int length; /* 3 * operations of the list */
} op_list_freedoms;

/* Returns the possible scalings: first those without an additional product; then, for each raw value, those that
 * multiply it at some or all of its uses, alone or together with an earlier raw value. */
op_list_freedoms op_list_freedoms_of(const op_list *t);

/* Returns a finished list with the same results, in which each value is multiplied by its entry of times[3 * count] > 0
 * (laid out as an exponent vector). */
op_list *op_list_multiplied(const op_list *t, const double *times);

#endif
