/* op_list_scaling.h: the scaling freedom of a list: factors of its values that cancel, as in a numerator and its
 * denominator, or in the equations of a system. Some factors make the constants exact in float: (1.08 - 0.36 s^2) / M
 * is (27 - 9 s^2) / (25 M). */
#ifndef IMAGE_OP_LIST_SCALING_H
#define IMAGE_OP_LIST_SCALING_H

#include "host/image/op_list.h"

/* Returns the relative error of the results of a finished list if its constants are rounded to float, and its
 * operations are exact. It is the root mean square over the results and over artificial states with rates of three
 * sizes. Results that do not feed back into the list have a small weight. The list `like` gives the reference; it is
 * the same list, or another one with equal results. NaN if undefined. */
double op_list_bias(const op_list *t, const op_list *like);

/* Returns the largest number of additional operations of a better list: one, and one for each forty operations. */
int op_list_scaling_price(const op_list *t);

/* Replaces *t by a list that gives the same results, except for double's round-off, with at most half the bias. If
 * there is no such list with at most `price` additional operations, *t stays unchanged. */
void op_list_scale(op_list **t, int price);

/* Vectors of exponents. A value may be multiplied by x to the power of its exponent, for any x > 0. A vector has an
 * exponent for each operation. Then come two for each operation, for its operands: nonzero if an operand is raw and
 * multiplied. */
typedef struct op_list_freedoms {
    double *exponent; /* [count * length] */
    int count;
    int length; /* 3 * operations of the list */
} op_list_freedoms;

/* Returns the possible scalings. First come those without an additional product. Then, for each raw value, come scalings
 * that multiply it at some or all of its uses, alone or together with an earlier raw value. */
op_list_freedoms op_list_freedoms_of(const op_list *t);
void op_list_freedoms_free(op_list_freedoms *f);

/* Returns a finished list (op_list_prune(), op_list_order()) with the same results, in which each operation's value
 * is multiplied by its entry of times[3 * count] > 0, laid out as an exponent vector. */
op_list *op_list_multiplied(const op_list *t, const double *times);

#endif
