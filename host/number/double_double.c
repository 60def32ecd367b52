#define WH_DOUBLE 1
#include "double_double.h"

#include <math.h>

#include "core/number/two_part.h"

double_double double_double_of(double value) { return (double_double){value, 0.0}; }

static double_double of_whole(uint64_t value) {
    return wh_pair_sum((double)(value >> 32) * 4294967296.0, (double)(uint32_t)value);
}

double_double double_double_ratio(uint64_t numerator, uint64_t denominator) {
    return double_double_div(of_whole(numerator), of_whole(denominator));
}

double_double double_double_scale(double_double a, double power_of_two) {
    return (double_double){a.high * power_of_two, a.low * power_of_two};
}

double_double double_double_add(double_double a, double_double b) {
    double_double high = wh_pair_sum(a.high, b.high);
    const double_double low = wh_pair_sum(a.low, b.low);
    high = wh_pair_of(high.high, high.low + low.high);
    return wh_pair_of(high.high, high.low + low.low);
}

double_double double_double_sub(double_double a, double_double b) {
    return double_double_add(a, (double_double){-b.high, -b.low});
}

double_double double_double_mul(double_double a, double_double b) {
    if (double_double_is_zero(a) || double_double_is_zero(b)) {
        return double_double_of(0.0);
    }
    const double rest = wh_product_rest(a.high, b.high);
    return wh_pair_of(a.high * b.high, rest + (a.high * b.low + a.low * b.high));
}

double_double double_double_div(double_double a, double_double b) {
    const double first = a.high / b.high;
    const double_double left = double_double_sub(a, double_double_mul(b, double_double_of(first)));
    const double second = left.high / b.high;
    const double_double rest =
        double_double_sub(left, double_double_mul(b, double_double_of(second)));
    const double_double quotient = wh_pair_of(first, second);
    return double_double_add(quotient, double_double_of(rest.high / b.high));
}

bool double_double_is_zero(double_double a) { return a.high == 0.0; }
bool double_double_is_finite(double_double a) { return isfinite(a.high) && isfinite(a.low); }

double double_double_constant(double_double a) {
    static const uint64_t beyond_float = (UINT64_C(1) << 29) - 1; /* the 29 bits that float lacks */
    uint64_t bits = wh_bits(a.high);
    if (a.low != 0.0 && (bits & beyond_float) == (beyond_float + 1) / 2) {
        bits += (a.low > 0.0) == (a.high > 0.0) ? UINT64_C(1) : UINT64_MAX;
    }
    return wh_of_bits(bits);
}

double double_double_beyond_float(double_double a) {
    const float nearest = (float)double_double_constant(a);
    return double_double_sub(a, double_double_of((double)nearest)).high;
}
