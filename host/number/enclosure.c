/* enclosure.c: interval functions by series, in which an interval replaces the omitted terms. */
#include "enclosure.h"

#include <math.h>

#include "host/number/functions.h"

static enclosure none(void) { return (enclosure){(double)NAN, (double)NAN}; }

enclosure enclosure_div(enclosure a, enclosure b) {
    if (!(b.low > 0.0 || b.high < 0.0) || !enclosure_is_finite(b)) {
        return none();
    }
    return enclosure_of_four(a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high,
                             enclosure_is_zero(a));
}

enclosure enclosure_square(enclosure a) {
    const enclosure whole = enclosure_mul(a, a);
    return whole.low < 0.0 ? (enclosure){a.low > 0.0 || a.high < 0.0 ? whole.low : 0.0, whole.high}
                           : whole;
}

enclosure enclosure_about(double value, int more) {
    enclosure a = enclosure_of(value);
    for (int i = 0; i <= more; i++) {
        a = (enclosure){enclosure_below(a.low), enclosure_above(a.high)};
    }
    return a;
}

double enclosure_middle(enclosure a) { return 0.5 * a.low + 0.5 * a.high; }

double enclosure_radius(enclosure a) {
    const double middle = enclosure_middle(a);
    return enclosure_is_point(a) ? 0.0
                                 : enclosure_larger(enclosure_above(middle - a.low),
                                                    enclosure_above(a.high - middle));
}

double enclosure_size(enclosure a) { return enclosure_larger(-a.low, a.high); }

bool enclosure_inside(enclosure a, enclosure b) { return a.low > b.low && a.high < b.high; }

bool enclosure_has(enclosure a, double x) { return a.low <= x && x <= a.high; }

/* pi / 2 in three parts. Multiples of the first two parts are exact for whole factors up to QUARTERS_MOST. */
#define QUARTER_HIGH 0x1.921fb544p+0
#define QUARTER_MIDDLE 0x1.0b4611a6p-34
#define QUARTER_LOW 0x1.3198a2e037073p-69
#define QUARTERS_MOST 0x1p20

enclosure enclosure_pi(void) { return (enclosure){0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1}; }

/* Number of terms of the series, for arguments from -1 to 1. */
enum { TERMS = 13 };

/* For t = x^2 from 0 to 1: encloses the series of cos x (`from` is 0) or of sin(x) / x (`from` is 1). Its terms have
 * alternating signs and become smaller, so the first omitted term bounds the error. */
static enclosure waves(enclosure t, int from) {
    enclosure sum = {0.0, 1.0};
    for (int i = TERMS; i > 0; i--) {
        const double divisor = (double)((from + 2 * i - 1) * (from + 2 * i));
        sum = enclosure_sub(enclosure_of(1.0),
                            enclosure_div(enclosure_mul(t, sum), enclosure_of(divisor)));
    }
    return sum;
}

/* Returns false if x is too large or too wide. *quarters: the subtracted quarter turns, modulo 4. */
static bool reduce(enclosure x, enclosure *rest, int *quarters) {
    const double number = number_nearest(enclosure_middle(x) * 0.63661977236758134);
    if (!(number > -QUARTERS_MOST && number < QUARTERS_MOST)) {
        return false;
    }
    *quarters = (int)number & 3;
    enclosure left = enclosure_sub(x, enclosure_of(number * QUARTER_HIGH));
    left = enclosure_sub(left, enclosure_of(number * QUARTER_MIDDLE));
    *rest =
        enclosure_sub(left, enclosure_mul(enclosure_of(number), enclosure_about(QUARTER_LOW, 0)));
    return enclosure_radius(*rest) <= 1.5 &&
           enclosure_size(enclosure_of(enclosure_middle(*rest))) <= 1.0;
}

/* Encloses sin(rest + quarters * pi/2), by the addition theorem for middle + swing. */
static enclosure wave(enclosure rest, int quarters) {
    const double middle = enclosure_middle(rest);
    const double radius = enclosure_radius(rest);
    const enclosure t = enclosure_square(enclosure_of(middle));
    const enclosure sine = enclosure_mul(enclosure_of(middle), waves(t, 1));
    const enclosure cosine = waves(t, 0);
    const enclosure swing = {-radius, radius};
    const enclosure half = enclosure_mul(enclosure_of(0.5), enclosure_square(enclosure_of(radius)));
    const enclosure held = {enclosure_below(1.0 - half.high), 1.0};
    const enclosure of_sine =
        enclosure_add(enclosure_mul(sine, held), enclosure_mul(cosine, swing));
    const enclosure of_cosine =
        enclosure_sub(enclosure_mul(cosine, held), enclosure_mul(sine, swing));
    switch (quarters & 3) {
    case 0: return of_sine;
    case 1: return of_cosine;
    case 2: return enclosure_neg(of_sine);
    default: return enclosure_neg(of_cosine);
    }
}

static enclosure turned(enclosure a, int quarters) {
    enclosure rest;
    int found;
    if (!enclosure_is_finite(a)) {
        return none();
    }
    if (!reduce(a, &rest, &found)) {
        return (enclosure){-1.0, 1.0};
    }
    const enclosure all = wave(rest, found + quarters);
    return (enclosure){enclosure_larger(all.low, -1.0), enclosure_lesser(all.high, 1.0)};
}

enclosure enclosure_sine(enclosure a) { return enclosure_is_zero(a) ? a : turned(a, 0); }

enclosure enclosure_cosine(enclosure a) {
    return enclosure_is_zero(a) ? enclosure_of(1.0) : turned(a, 1);
}

/* Returns true if `root` is a whole number and exactly the root of `of`. `root` then needs no outward rounding. */
static bool is_whole_root(double root, double of) {
    return root <= 0x1p26 && number_nearest(root) == root && root * root == of;
}

enclosure enclosure_root(enclosure a) {
    if (!(a.low >= 0.0) || !enclosure_is_finite(a)) {
        return none();
    }
    const double low = number_root(a.low);
    const double high = number_root(a.high);
    return (enclosure){is_whole_root(low, a.low) ? low
                                                 : enclosure_larger(enclosure_below(low), 0.0),
                       is_whole_root(high, a.high) ? high : enclosure_above(high)};
}

/* Encloses f(x) for all x in `a`, if f is a rising function and at(x) encloses f(x). */
static enclosure rising(enclosure (*at)(double x), enclosure a) {
    const enclosure low = at(a.low);
    const enclosure high = enclosure_is_point(a) ? low : at(a.high);
    return enclosure_is_finite(low) && enclosure_is_finite(high) ? (enclosure){low.low, high.high}
                                                                 : none();
}

/* Encloses e^x: the series at x / 2^n, squared n times. */
static enclosure exponential(double x) {
    const double size = x < 0.0 ? -x : x;
    int halvings = 0;
    while (number_scaled(size, -halvings) > 0.25) {
        if (++halvings > 11) {
            return none(); /* the argument exceeds 512 */
        }
    }
    const enclosure y = enclosure_of(number_scaled(x, -halvings));
    enclosure sum = {0.0, 2.0}; /* 1 + y/n (1 + y/(n+1) ...), which is between 0 and 2 */
    for (int n = 20; n > 0; n--) {
        sum = enclosure_add(enclosure_of(1.0),
                            enclosure_div(enclosure_mul(y, sum), enclosure_of((double)n)));
    }
    for (; halvings > 0; halvings--) {
        sum = enclosure_square(sum);
    }
    return sum;
}

enclosure enclosure_exp(enclosure a) {
    if (!enclosure_is_finite(a)) {
        return none();
    }
    if (enclosure_is_zero(a)) {
        return enclosure_of(1.0);
    }
    return rising(exponential, a);
}

/* For any y, log x = y + log(1 + z) with z = x e^-y - 1. log(1 + z) is at least z / (1 + z) and at most z. */
static enclosure logarithm(double x) {
    const double y = number_call(FN_LOG, x, 0.0);
    const enclosure z = enclosure_sub(
        enclosure_mul(enclosure_of(x), enclosure_exp(enclosure_of(-y))), enclosure_of(1.0));
    if (!enclosure_is_finite(z) || !(z.low > -0.5)) {
        return none();
    }
    const enclosure low =
        enclosure_div(enclosure_of(z.low), enclosure_add(enclosure_of(1.0), enclosure_of(z.low)));
    return enclosure_add(enclosure_of(y), (enclosure){low.low, z.high});
}

enclosure enclosure_log(enclosure a) {
    if (!(a.low > 0.0) || !enclosure_is_finite(a)) {
        return none();
    }
    return rising(logarithm, a);
}

enclosure enclosure_whole_power(enclosure a, int n) {
    if (n < 0) {
        return enclosure_div(enclosure_of(1.0), enclosure_whole_power(a, -n));
    }
    if (n == 0 || n == 1) {
        return n == 0 ? enclosure_of(1.0) : a;
    }
    const enclosure half = enclosure_square(enclosure_whole_power(a, n / 2));
    return n % 2 == 0 ? half : enclosure_mul(half, a);
}

enclosure enclosure_power(enclosure a, enclosure exponent) {
    const double e = exponent.low;
    const bool is_point = enclosure_is_point(exponent) && e > -1e6 && e < 1e6;
    if (is_point && number_nearest(e) == e) {
        return enclosure_whole_power(a, (int)e);
    }
    if (is_point && number_nearest(2.0 * e) == 2.0 * e) {
        return enclosure_whole_power(enclosure_root(a), (int)(2.0 * e));
    }
    return enclosure_exp(enclosure_mul(exponent, enclosure_log(a)));
}

/* Encloses f(x) for all x in `a` from `least` to `most`, if f is monotonic there and is computed to 0.6 ulp. */
static enclosure steady(function_id function, enclosure a, double least, double most) {
    const double low = enclosure_lesser(enclosure_larger(a.low, least), most);
    const double high = enclosure_larger(enclosure_lesser(a.high, most), least);
    return enclosure_hull(enclosure_about(number_call(function, low, 0.0), 1),
                          enclosure_about(number_call(function, high, 0.0), 1));
}

static enclosure size_of(enclosure a) {
    const bool across = a.low < 0.0 && a.high > 0.0;
    const double low = a.low < 0.0 ? -a.low : a.low;
    const double high = a.high < 0.0 ? -a.high : a.high;
    return (enclosure){across ? 0.0 : enclosure_lesser(low, high), enclosure_larger(low, high)};
}

/* Encloses the angle of (x, y), by the four corners. If `y` contains 0 and x.low <= 0, the result is -pi to pi. */
static enclosure angle_of(enclosure y, enclosure x) {
    if (x.low <= 0.0 && y.low <= 0.0 && y.high >= 0.0) {
        return (enclosure){-enclosure_pi().high, enclosure_pi().high};
    }
    enclosure all = enclosure_about(number_call(FN_ATAN2, y.low, x.low), 1);
    for (int corner = 1; corner < 4; corner++) {
        const double angle = number_call(FN_ATAN2, (corner & 1) != 0 ? y.high : y.low,
                                         (corner & 2) != 0 ? x.high : x.low);
        all = enclosure_hull(all, enclosure_about(angle, 1));
    }
    return all;
}

enclosure enclosure_call(function_id function, enclosure a, enclosure b) {
    if (!enclosure_is_finite(a) || !enclosure_is_finite(b)) {
        return none();
    }
    enclosure f;
    switch (function) {
    case FN_SIN: return enclosure_sine(a);
    case FN_COS: return enclosure_cosine(a);
    case FN_TAN: return enclosure_div(enclosure_sine(a), enclosure_cosine(a));
    case FN_ASIN:
    case FN_ACOS: return steady(function, a, -1.0, 1.0);
    case FN_EXP:
        f = steady(function, a, -740.0, 700.0);
        return a.high > 700.0 ? none() : (enclosure){a.low < -700.0 ? 0.0 : f.low, f.high};
    case FN_COSH:
        f = steady(function, size_of(a), 0.0, 700.0);
        return size_of(a).high > 700.0 ? none() : (enclosure){enclosure_larger(f.low, 1.0), f.high};
    case FN_SINH: return size_of(a).high > 700.0 ? none() : steady(function, a, -700.0, 700.0);
    case FN_ATAN:
    case FN_TANH: return steady(function, a, a.low, a.high);
    case FN_LOG: return a.high > 0.0 ? steady(function, a, 0x1p-1074, a.high) : none();
    case FN_SQRT:
        return a.high >= 0.0 ? enclosure_root((enclosure){enclosure_larger(a.low, 0.0), a.high})
                             : none();
    case FN_ABS: return size_of(a);
    case FN_SIGN:
        return (enclosure){(a.low > 0.0) - (a.low < 0.0), (a.high > 0.0) - (a.high < 0.0)};
    case FN_MIN:
        return (enclosure){enclosure_lesser(a.low, b.low), enclosure_lesser(a.high, b.high)};
    case FN_MAX:
        return (enclosure){enclosure_larger(a.low, b.low), enclosure_larger(a.high, b.high)};
    case FN_ATAN2: return angle_of(a, b);
    }
    return none();
}
