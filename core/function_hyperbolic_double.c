/* function_hyperbolic_double.c: the hyperbolic functions in double, from e^x and e^-x as pairs. Near zero, where e^x -
 * e^-x cancels, they are series. */
#include "function_double.h"

#if WH_DOUBLE

#define SMALL 0x1p-28  /* for smaller x, sinh x and tanh x round to x, and cosh x to one */
#define BY_SERIES 0.25 /* largest |x| for the series */
#define TANH_IS_ONE 22.0
#define BEYOND 711.0 /* for larger x, sinh x and cosh x are infinite */

/* Returns sinh x - x for |x| <= 1/4, to 51 bits; z is x^2. */
static double sine_less_x(double x, double z) {
    const double upper = 1.0 / 362880.0 + z * (1.0 / 39916800.0 + z / 6227020800.0);
    return x * (z * (1.0 / 6.0 + z * (1.0 / 120.0 + z * (1.0 / 5040.0 + z * upper))));
}

/* Returns cosh x for |x| <= 1/4. */
static wh_pair near_cosine(double x) {
    const wh_pair square = wh_product(x, x);
    const double z = square.high;
    const double upper = 1.0 / 40320.0 + z * (1.0 / 3628800.0 + z / 479001600.0);
    const double more = z * (z * (1.0 / 24.0 + z * (1.0 / 720.0 + z * upper)));
    const wh_pair sum = wh_pair_of(1.0, 0.5 * z);
    return wh_pair_of(sum.high, sum.low + (0.5 * square.low + more));
}

/* Returns e^x for |x| < 700. */
static wh_pair exp_of(double x) {
    int power;
    const wh_pair parts = wh_exp_parts((wh_pair){x, 0.0}, &power);
    const double scale = wh_power_of_two(power);
    return (wh_pair){parts.high * scale, parts.low * scale};
}

/* Returns (e^size + sign e^-size)/2 for size > 0. */
static double half_sum(double size, double sign) {
    int power;
    wh_pair sum = wh_exp_parts((wh_pair){size, 0.0}, &power);
    if (power < 64) { /* for larger powers e^-size is negligible */
        const wh_pair left = exp_of(-size);
        const double scale = wh_power_of_two(-power) * -sign;
        sum = wh_difference(sum, (wh_pair){left.high * scale, left.low * scale});
    }
    return wh_scaled_pair(sum, power - 1);
}

double wh_sinh(double x) {
    const double size = WH_ABS(x);
    if (wh_is_nan(x)) {
        return WH_NAN;
    }
    if (size < SMALL) {
        return x;
    }
    if (size <= BY_SERIES) {
        return x + sine_less_x(x, x * x);
    }
    return wh_signed(size > BEYOND ? WH_INFINITY : half_sum(size, -1.0), x < 0.0);
}

double wh_cosh(double x) {
    const double size = WH_ABS(x);
    if (wh_is_nan(x)) {
        return WH_NAN;
    }
    if (size < SMALL) {
        return 1.0;
    }
    if (size <= BY_SERIES) {
        return near_cosine(x).high;
    }
    return size > BEYOND ? WH_INFINITY : half_sum(size, 1.0);
}

double wh_tanh(double x) {
    const double size = WH_ABS(x);
    if (wh_is_nan(x)) {
        return WH_NAN;
    }
    if (size < SMALL) {
        return x;
    }
    if (size > TANH_IS_ONE) {
        return wh_signed(1.0, x < 0.0);
    }
    if (size <= BY_SERIES) {
        const wh_pair sine = wh_pair_of(x, sine_less_x(x, x * x));
        return wh_quotient(sine, near_cosine(x)).high;
    }
    const wh_pair left = exp_of(-2.0 * size);
    const wh_pair one = {1.0, 0.0};
    const wh_pair minus = {-left.high, -left.low};
    return wh_signed(wh_quotient(wh_difference(one, left), wh_difference(one, minus)).high,
                     x < 0.0);
}

#endif
