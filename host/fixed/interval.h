/* interval.h: intervals of reals. What is computed is not rounded outwards: whoever uses them widens by more than doubles err
 * (fixed_list.c). */
#ifndef FIXED_INTERVAL_H
#define FIXED_INTERVAL_H

#include <stdbool.h>

typedef struct interval {
    double low;
    double high;
} interval;

interval interval_add(interval a, interval b);
interval interval_sub(interval a, interval b);
interval interval_mul(interval a, interval b);
interval interval_square(interval a);
/* b must not hold 0. */
interval interval_div(interval a, interval b);
interval interval_abs(interval a);
interval interval_min(interval a, interval b);
interval interval_max(interval a, interval b);
/* Of all sines of angles in a, radians. */
interval interval_sin(interval a);
interval interval_cos(interval a);
interval interval_hull(interval a, interval b);
interval interval_widen(interval a, double by);
bool interval_holds_zero(interval a);
/* The largest number's size. */
double interval_size(interval a);

#endif
