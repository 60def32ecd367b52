/* function_pow_double.c: powers in double, as e^(y log x) with log x and the product as pairs. The result has about
 * sixty bits before its rounding, so a true power that is a double is returned exactly. */
#include "function_double.h"

#if WH_DOUBLE

typedef enum parity { BROKEN, ODD, EVEN } parity;

static parity parity_of(double y) {
    const double size = WH_ABS(y);
    if (size >= 0x1p53) {
        return EVEN;
    }
    const int64_t whole = (int64_t)size;
    if ((double)whole != size) {
        return BROKEN;
    }
    return whole % 2 != 0 ? ODD : EVEN;
}

/* Returns size^y for a positive finite size and a finite y. */
static double positive_power(double size, double y) {
    const wh_pair logarithm = wh_log_pair(size);
    const double rough = logarithm.high * y;
    if (rough > 720.0) {
        return WH_INFINITY;
    }
    if (rough < -760.0) {
        return 0.0;
    }
    if (WH_ABS(rough) < 0x1p-64) {
        return 1.0;
    }
    const wh_pair product = wh_product(logarithm.high, y);
    return wh_exp_pair(wh_pair_of(product.high, product.low + logarithm.low * y));
}

/* Returns base^y if the base is zero or infinite, or y is infinite. y is not zero; base and y are not NaN. */
static double edge_power(double base, double y) {
    if (y == WH_INFINITY || y == -WH_INFINITY) {
        const double size = WH_ABS(base);
        if (size == 1.0) {
            return 1.0;
        }
        return (size > 1.0) == (y > 0.0) ? WH_INFINITY : 0.0;
    }
    const bool large = (base == 0.0) == (y < 0.0);
    const bool negative = wh_bits(base) >> 63 != 0 && parity_of(y) == ODD;
    return wh_signed(large ? WH_INFINITY : 0.0, negative);
}

double wh_pow(double base, double exponent) {
    if (base == 1.0 || exponent == 0.0) {
        return 1.0; /* also for NaN */
    }
    if (wh_is_nan(base) || wh_is_nan(exponent)) {
        return WH_NAN;
    }
    const double size = WH_ABS(base);
    if (size == 0.0 || size == WH_INFINITY || WH_ABS(exponent) == WH_INFINITY) {
        return edge_power(base, exponent);
    }
    const parity kind = base < 0.0 ? parity_of(exponent) : EVEN;
    return kind == BROKEN ? WH_NAN : wh_signed(positive_power(size, exponent), kind == ODD);
}

#endif
