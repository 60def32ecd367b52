/* sum.h: sums with optional compensation for round-off. */
#ifndef WH_SUM_H
#define WH_SUM_H

#include "../real.h"

/* Returns value + increment. If compensated, *carry is added, too, and becomes the round-off of the sum (Kahan; Higham,
 * Accuracy and Stability of Numerical Algorithms, section 4.3). */
WH_INLINE wh_real wh_sum(wh_real value, wh_real increment, bool compensated, wh_real *carry) {
    if (!compensated) {
        return value + increment;
    }
    const wh_real wanted = increment + *carry;
    const wh_real sum = value + wanted;
    *carry = wanted - (sum - value);
    return sum;
}

#endif
