/* op_list_scaling.h: factors for a list's values. The factors make constants exact in float, and change no result.
 * With the factor 25, (1.08 - 0.36 x^2) / y becomes (27 - 9 x^2) / (25 y). */
#ifndef IMAGE_OP_LIST_SCALING_H
#define IMAGE_OP_LIST_SCALING_H

#include "host/image/op_list.h"

/* Returns the relative error of the results of `t` after its constants are rounded to float. `t` must be finished.
 * The reference is `like`: `t` or a list with equal results. Returns NaN if no result can be compared. */
double op_list_bias(const op_list *t, const op_list *like);

/* Returns the allowed number of additional operations: one, and one for each forty operations. */
int op_list_scaling_price(const op_list *t);

/* Searches for a list with at most half of op_list_bias() and at most `price` additional operations. If there is
 * such a list, frees and replaces *t. The new results differ only by double's round-off. */
void op_list_scale(op_list **t, int price);

/* Vectors of exponents. For any x > 0, multiplying each value by x^exponent changes no result. In a list of n
 * operations, entry i belongs to operation i. Entries n + 2 i and n + 2 i + 1 belong to operands a and b of operation
 * i. An operand's entry is 0 unless the operand is raw: a leaf, sine, cosine, call, sign or power. */
typedef struct op_list_freedoms {
    double *exponent; /* [count * length]; the caller frees it */
    int count;
    int length; /* 3 * operations of the list */
} op_list_freedoms;

/* Returns the vectors that op_list_scale() tries. */
op_list_freedoms op_list_freedoms_of(const op_list *t);

/* Returns a finished list with multiplied values. times[] has 3 * t->count positive factors, in the order of
 * op_list_freedoms.exponent. The factors must change no result. */
op_list *op_list_multiplied(const op_list *t, const double *times);

#endif
