/* interval.c: see interval.h. */
#include "interval.h"

#include <math.h>

#include "host/number/functions.h"

#define PI 3.14159265358979323846

interval interval_add(interval a, interval b) { return (interval){a.low + b.low, a.high + b.high}; }

interval interval_sub(interval a, interval b) { return (interval){a.low - b.high, a.high - b.low}; }

interval interval_hull(interval a, interval b) {
    return (interval){b.low < a.low ? b.low : a.low, b.high > a.high ? b.high : a.high};
}

interval interval_mul(interval a, interval b) {
    const double low[2] = {a.low * b.low, a.low * b.high};
    const double high[2] = {a.high * b.low, a.high * b.high};
    const interval of_low =
        low[0] < low[1] ? (interval){low[0], low[1]} : (interval){low[1], low[0]};
    const interval of_high =
        high[0] < high[1] ? (interval){high[0], high[1]} : (interval){high[1], high[0]};
    return interval_hull(of_low, of_high);
}

interval interval_square(interval a) {
    const interval size = interval_abs(a);
    return (interval){size.low * size.low, size.high * size.high};
}

interval interval_div(interval a, interval b) {
    return interval_mul(a, (interval){1.0 / b.high, 1.0 / b.low});
}

interval interval_abs(interval a) {
    const double least = interval_holds_zero(a)       ? 0.0
                         : fabs(a.low) < fabs(a.high) ? fabs(a.low)
                                                      : fabs(a.high);
    return (interval){least, interval_size(a)};
}

interval interval_min(interval a, interval b) {
    return (interval){a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}

interval interval_max(interval a, interval b) {
    return (interval){a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

/* Is there a whole k with a.low <= at + 2 pi k <= a.high? */
static bool meets(interval a, double at) {
    return at + 2.0 * PI * number_ceiling((a.low - at) / (2.0 * PI)) <= a.high;
}

interval interval_sin(interval a) {
    const double one = number_sine(a.low);
    const double other = number_sine(a.high);
    interval made = one < other ? (interval){one, other} : (interval){other, one};
    if (meets(a, 0.5 * PI)) {
        made.high = 1.0;
    }
    if (meets(a, -0.5 * PI)) {
        made.low = -1.0;
    }
    return made;
}

interval interval_cos(interval a) {
    return interval_sin((interval){a.low + 0.5 * PI, a.high + 0.5 * PI});
}

interval interval_widen(interval a, double by) { return (interval){a.low - by, a.high + by}; }

bool interval_holds_zero(interval a) { return a.low <= 0.0 && a.high >= 0.0; }

double interval_size(interval a) { return fabs(a.low) > fabs(a.high) ? fabs(a.low) : fabs(a.high); }
