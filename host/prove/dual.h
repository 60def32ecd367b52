/* dual.h: an enclosure with its slopes by all states: entry 0 is the value, then come `width` - 1 slopes; or the value
 * alone, of width 1. Entries that are exactly zero cost next to nothing. */
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
/* The slopes of a function of `a` whose value is to[0] and whose own slope there is this. */
void dual_chain(enclosure *to, enclosure slope, const enclosure *a, int width);

#endif
