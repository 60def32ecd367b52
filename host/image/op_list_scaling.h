/* op_list_scaling.h: factors for a list's values that leave its results unchanged, and make constants exact in float.
 * With the factor 25, (1.08 - 0.36 x^2) / y becomes (27 - 9 x^2) / (25 y). */
#ifndef IMAGE_OP_LIST_SCALING_H
#define IMAGE_OP_LIST_SCALING_H

#include "host/image/op_list.h"

/* Returns the relative error of a finished list's results if its constants are float and its operations are double, or
 * NaN if nothing can be compared. The reference is `like` in double: the same list, or one with equal results. For each
 * result and each of three sizes of rates, the sum of absolute errors at artificial states is divided by the sum of
 * absolute reference values. The weighted root mean square of these quotients is returned. */
double op_list_bias(const op_list *t, const op_list *like);

/* Returns the allowed number of additional operations: one, and one for each forty operations. */
int op_list_scaling_price(const op_list *t);

/* Replaces *t if the search finds a list with at most half the bias and at most `price` additional operations. The new
 * results differ only by double's round-off. */
void op_list_scale(op_list **t, int price);

/* Vectors of exponents: for any x > 0, multiplying each value by x^exponent changes no result. In a list of n
 * operations, entry i belongs to operation i, and entries n + 2 i and n + 2 i + 1 to its operands a and b. Only raw
 * operands have nonzero entries. A value is raw if multiplying it needs a new product, as for a leaf or a sine. */
typedef struct op_list_freedoms {
    double *exponent; /* [count * length]; the caller frees it */
    int count;
    int length; /* 3 * operations of the list */
} op_list_freedoms;

/* Returns the vectors that the search tries. Each multiplies no raw value, or one raw value at some or all of its uses,
 * or two raw values at all of their uses. */
op_list_freedoms op_list_freedoms_of(const op_list *t);

/* Returns a finished list with the same results. Each value is multiplied by its entry of times[3 * t->count], which
 * has the layout of a vector of exponents. All entries must be positive. */
op_list *op_list_multiplied(const op_list *t, const double *times);

#endif
