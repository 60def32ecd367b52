/* dual.h: an enclosure with its derivatives by all states: entry 0 is the value, then come `width` - 1 derivatives.
 * With width 1 it is the value alone. Entries that are exactly zero cost almost nothing. */
#ifndef PROVE_DUAL_H
#define PROVE_DUAL_H

#include "host/number/enclosure.h"

void dual_zero(enclosure *to, int width);
/* to += a */
void dual_add(enclosure *to, const enclosure *a, int width);
/* to = a - to */
void dual_take_from(enclosure *to, const enclosure *a, int width);
/* to += number a */
void dual_add_multiple(enclosure *to, enclosure number, const enclosure *a, int width);
/* to += a b; to += number a b */
void dual_add_product(enclosure *to, const enclosure *a, const enclosure *b, int width);
void dual_add_products(enclosure *to, enclosure number, const enclosure *a, const enclosure *b,
                       int width);
/* to = number to */
void dual_scale(enclosure *to, enclosure number, int width);
/* to /= a */
void dual_divide(enclosure *to, const enclosure *a, int width);
/* The derivatives of a function of `a` with value to[0] and derivative `slope` there. */
void dual_chain(enclosure *to, enclosure slope, const enclosure *a, int width);

#endif
