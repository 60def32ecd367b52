#include "folding.h"

#include <math.h>
#include <stdint.h>

#include "double_double.h"
#include "enclosure.h"
#include "host/number/functions.h"

#define UNIT 0x1p-53        /* unit round-off of double */
#define GHOST (16.0 * UNIT) /* relative round-off of a few operations, such as 0.1 + 0.2 - 0.3 */

/* A residue above this, in SI units, is recorded as a loss: it may be a real quantity, such as a soft spring. */
#define REST_COUNTS 1e-12

int folding_way(const folding *f) { return f != NULL ? f->way : FOLDING_NEAREST; }

static uint64_t digits_of(double x) { return number_bits(x) & ((UINT64_C(1) << 52) - 1); }

/* Output bits depend on all input bits (Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014) */
static uint64_t mixed(uint64_t z) {
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static int moved_by(const folding *f, double x, double y, bool up) {
    static const signed char some[] = {-2, -1, 1, 2};
    if (folding_way(f) <= FOLDING_APART) {
        return folding_way(f) == FOLDING_APART ? 0 : up ? 2 : -2;
    }
    const uint64_t a = digits_of(x);
    const uint64_t b = digits_of(y);
    return some[mixed(mixed(a + b) ^ (a ^ b)) >> 2 * (folding_way(f) - FOLDING_SOME) & 3U];
}

static double moved(double x, int by) {
    for (int i = 0; i < by; i++) {
        x = enclosure_above(x);
    }
    for (int i = 0; i > by; i--) {
        x = enclosure_below(x);
    }
    return x;
}

static double other_neighbour(const folding *f, double_double exact, double x, double y) {
    if (!double_double_is_finite(exact) || exact.low == 0.0) {
        return exact.high;
    }
    return moved(exact.high, moved_by(f, x, y, exact.low > 0.0));
}

static bool is_short(double x) { return (digits_of(x) & ((UINT64_C(1) << 26) - 1)) == 0; }

/* As other_neighbour(f, ), for a result whose exact value is unknown. */
static double other_value(const folding *f, double value, double x) {
    return isfinite(value) ? moved(value, moved_by(f, value, x, (digits_of(value) >> 26 & 1U) != 0))
                           : value;
}

static void note_lost(folding *f, double part) {
    if (f != NULL) {
        f->lost = number_most(f->lost, part);
    }
}

static bool is_rest(const folding *f, double x) {
    for (int i = 0; f != NULL && i < f->rests; i++) {
        if (f->rest[i] == fabs(x)) {
            return true;
        }
    }
    return false;
}

static void note_rest(folding *f, double x) {
    if (f != NULL && x != 0.0 && f->rests < FOLDING_RESTS && !is_rest(f, x)) {
        f->rest[f->rests++] = fabs(x);
    }
    if (fabs(x) > REST_COUNTS) {
        note_lost(f, 1.0);
    }
}

/* Records the loss in x + y. If only one addend is a residue, the loss is |residue / other addend|. */
static void note_sum(folding *f, double x, double y, double sum) {
    if (x == 0.0 || y == 0.0) {
        return;
    }
    const bool rest_x = is_rest(f, x);
    const bool rest_y = is_rest(f, y);
    const double most = number_most(fabs(x), fabs(y));
    if (fabs(sum) <= GHOST * most || (rest_x && rest_y)) {
        note_rest(f, sum);
        return;
    }
    if (rest_x || rest_y) {
        note_lost(f, rest_x ? fabs(x / y) : fabs(y / x));
        return;
    }
    note_lost(f, UNIT * most / number_least(fabs(sum), number_least(fabs(x), fabs(y))));
}

static void note_power(folding *f, double base, double exponent, double power) {
    if (is_rest(f, base)) {
        if (exponent < 0.0) {
            note_lost(f, 1.0);
        } else {
            note_rest(f, power);
        }
    }
}

/* Records the loss in a function whose argument is only round-off. */
static void note_call(folding *f, double value, double at_zero) {
    if (!(fabs(value - at_zero) <= 1e-3)) {
        note_lost(f, 1.0);
    } else if (at_zero == 0.0) {
        note_rest(f, value);
    }
}

/* Records the loss of digits of x in a function with a small slope, such as cos(1e-9). */
static void note_slope(folding *f, double value, double x, double slope, bool turns) {
    if (!turns || fabs(slope) > GHOST * fabs(x) || fabs(x) < 1.0) {
        note_lost(f, UNIT * fabs(value) / fabs(x * slope));
    }
}

double folding_sum(folding *f, double x, double y) {
    if (folding_way(f) != FOLDING_NEAREST) {
        return other_neighbour(f, double_double_add(double_double_of(x), double_double_of(y)), x,
                               y);
    }
    note_sum(f, x, y, x + y);
    return x + y;
}

/* FOLDING_OPPOSITE does not change quotients: a quotient's change could cancel a sum's change. */
static bool moves_products(const folding *f) {
    return folding_way(f) != FOLDING_NEAREST && folding_way(f) != FOLDING_OPPOSITE;
}

double folding_product(folding *f, double x, double y) {
    if (moves_products(f)) {
        return other_neighbour(f, double_double_mul(double_double_of(x), double_double_of(y)), x,
                               y);
    }
    if (folding_way(f) == FOLDING_NEAREST && (is_rest(f, x) || is_rest(f, y))) {
        note_rest(f, x * y);
    }
    return x * y;
}

double folding_quotient(folding *f, double x, double y) {
    if (moves_products(f) && y != 0.0) {
        return other_neighbour(f, double_double_div(double_double_of(x), double_double_of(y)), x,
                               y);
    }
    if (folding_way(f) == FOLDING_NEAREST) {
        note_power(f, y, -1.0, 1.0 / y);
        if (is_rest(f, x)) {
            note_rest(f, x / y);
        }
    }
    return x / y;
}

double folding_power(folding *f, double base, double exponent) {
    const double power = number_power(base, exponent);
    if (folding_way(f) != FOLDING_NEAREST) {
        return is_short(power) || fabs(exponent) == 1.0 ? power : other_value(f, power, base);
    }
    note_power(f, base, exponent, power);
    return power;
}

/* Returns true if `value` has no round-off. */
static bool is_exact(function_id function, double x, double value) {
    switch (function_takes(function)) {
    case TAKES_SIZE:
    case TAKES_ANY:
    case TAKES_CHOICE: return true;
    case TAKES_SQUARE: return is_short(value);
    case TAKES_ANGLE:
    case TAKES_NUMBER:
    case TAKES_RATIO: break;
    }
    return is_short(value) && (x == 0.0 || fabs(x) == 1.0);
}

double folding_call(folding *f, function_id function, double x, double y) {
    const double value = number_call(function, x, y);
    const bool turns = function_takes(function) == TAKES_ANGLE;
    const bool rests = turns && fabs(value) <= GHOST * fabs(x);
    const bool exact = is_exact(function, x, value);
    if (folding_way(f) == FOLDING_APART) {
        return value;
    }
    if (folding_way(f) != FOLDING_NEAREST) {
        return exact ? value : rests ? -value : other_value(f, value, x);
    }
    if (rests) {
        note_rest(f, value);
    } else if (is_rest(f, x)) {
        note_call(f, value, number_call(function, 0.0, y));
    } else if (!exact) {
        note_slope(f, value, x, number_slope(function, 0, x, y), turns);
    }
    return value;
}

bool folding_cancels(folding *f, double left, double size, double part) {
    if (folding_way(f) != FOLDING_NEAREST || !(fabs(left) <= part * size)) {
        return left == 0.0;
    }
    if (fabs(left) > GHOST * size) {
        note_lost(f, 1.0);
    }
    return true;
}

bool folding_same(folding *f, double x, double y, double part) {
    return folding_cancels(f, x - y, number_most(fabs(x), fabs(y)), part);
}
