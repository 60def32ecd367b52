/* op_list_scaling.h: factors for a list's values that cancel in the results, as in a numerator and its denominator. A
 * good factor makes constants exact in float. With 25, (1.08 - 0.36 x^2) / y becomes (27 - 9 x^2) / (25 y). */
#ifndef IMAGE_OP_LIST_SCALING_H
#define IMAGE_OP_LIST_SCALING_H

#include "host/image/op_list.h"

/* Returns the relative error that rounding the constants to float causes in a finished list's results. Operations are
 * in double. The reference is `like`: the same list, or one with equal results. A result's absolute errors at
 * artificial states are added, and divided by the sum of its absolute reference values. The return value is the
 * weighted root mean square of these quotients over results and three sizes of rates. NaN: nothing can be compared. */
double op_list_bias(const op_list *t, const op_list *like);

/* Returns the allowed number of additional operations: one, and one for each forty operations. */
int op_list_scaling_price(const op_list *t);

/* Replaces *t if the search finds a list with at most half the bias and at most `price` additional operations. The new
 * results differ only by double's round-off. */
void op_list_scale(op_list **t, int price);

/* Vectors of exponents: for any x > 0, each value may be multiplied by x to its exponent. Entry i belongs to the value
 * of operation i. In a list of n operations, entries n + 2 i and n + 2 i + 1 belong to operands a and b of operation i.
 * They are zero unless the operand is raw: multiplying a raw value, such as a leaf or a sine, costs another product. */
typedef struct op_list_freedoms {
    double *exponent; /* [count * length]; the caller frees it */
    int count;
    int length; /* 3 * operations of the list */
} op_list_freedoms;

/* Returns the scalings that are tried. The first multiply no raw value. The others multiply one raw value at some or
 * all of its uses, or two raw values at all of their uses. */
op_list_freedoms op_list_freedoms_of(const op_list *t);

/* Returns a finished list with the same results, in which each value is multiplied by its entry of times[3 * count] > 0
 * (laid out as an exponent vector). */
op_list *op_list_multiplied(const op_list *t, const double *times);

#endif
