#define WH_DOUBLE 1
#include "double_double.h"

#include <math.h>
#include <string.h>

#include "core/number/two_part.h"

static twofold two_product(double a, double b) { return (twofold){a * b, wh_product_rest(a, b)}; }

twofold double_double_of(double value) { return (twofold){value, 0.0}; }

static twofold of_whole(uint64_t value) {
    return wh_pair_sum((double)(value >> 32) * 4294967296.0, (double)(uint32_t)value);
}

twofold double_double_ratio(uint64_t numerator, uint64_t denominator) {
    return double_double_div(of_whole(numerator), of_whole(denominator));
}

static twofold double_double_neg(twofold a) { return (twofold){-a.high, -a.low}; }

twofold double_double_scale(twofold a, double power_of_two) {
    return (twofold){a.high * power_of_two, a.low * power_of_two};
}

twofold double_double_add(twofold a, twofold b) {
    twofold high = wh_pair_sum(a.high, b.high);
    const twofold low = wh_pair_sum(a.low, b.low);
    high = wh_pair_of(high.high, high.low + low.high);
    return wh_pair_of(high.high, high.low + low.low);
}

twofold double_double_sub(twofold a, twofold b) {
    return double_double_add(a, double_double_neg(b));
}

twofold double_double_mul(twofold a, twofold b) {
    if (double_double_is_zero(a) || double_double_is_zero(b)) {
        return double_double_of(0.0);
    }
    const twofold product = two_product(a.high, b.high);
    return wh_pair_of(product.high, product.low + (a.high * b.low + a.low * b.high));
}

twofold double_double_div(twofold a, twofold b) {
    const double first = a.high / b.high;
    const twofold left = double_double_sub(a, double_double_mul(b, double_double_of(first)));
    const double second = left.high / b.high;
    const twofold rest = double_double_sub(left, double_double_mul(b, double_double_of(second)));
    const twofold quotient = wh_pair_of(first, second);
    return double_double_add(quotient, double_double_of(rest.high / b.high));
}

bool double_double_is_zero(twofold a) { return a.high == 0.0; }
bool double_double_is_finite(twofold a) { return isfinite(a.high) && isfinite(a.low); }

double double_double_constant(twofold a) {
    static const uint64_t beyond_float = (UINT64_C(1) << 29) - 1; /* the 29 bits that float lacks */
    uint64_t bits;
    double nearest;
    memcpy(&bits, &a.high, sizeof bits);
    if (a.low != 0.0 && (bits & beyond_float) == (beyond_float + 1) / 2) {
        bits += (a.low > 0.0) == (a.high > 0.0) ? UINT64_C(1) : UINT64_MAX;
    }
    memcpy(&nearest, &bits, sizeof nearest);
    return nearest;
}

double double_double_beyond_float(twofold a) {
    const float nearest = (float)double_double_constant(a);
    return double_double_sub(a, double_double_of((double)nearest)).high;
}
