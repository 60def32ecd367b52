/* test_pole.c: poles on a path (host/check/pole.h), for random products of powers with integer and fractional
 * exponents. Also zeros nearby, one-sided poles, differences that are only round-off, and divisors that change their
 * sign twice. */
#include "command.h"
#include "host/check/pole.h"
#include "host/number/functions.h"

static dice die;

enum { SIGNS = 2, VALUES = 2 };

/* Two functions on the path x. value[0] is smooth. value[1] = (x - zero)^zeros / |x - place|^order + beside. If
 * `side` is not 0, value[1] has the pole on one side only. */
typedef struct drawn {
    double place;
    double order;
    double zero;
    int zeros;
    double side;
    double beside; /* constant term */
    bool touches;  /* the divisor touches zero at the pole and does not cross it */
    int asked;     /* number of evaluated points */
} drawn;

static void at(void *of, double share, double *sign, double *value) {
    drawn *d = of;
    const double x = share - d->place;
    double factor = x * d->side < 0.0 ? 0.0 : 1.0;
    for (int i = 0; i < d->zeros; i++) {
        factor *= share - d->zero;
    }
    sign[0] = 1.0 + share;
    sign[1] = d->touches ? 1.0 - number_cosine(x) : x;
    value[0] = number_sine(3.0 * share);
    value[1] = factor * number_power(fabs(x), -d->order) + d->beside;
    d->asked++;
}

static int pole_of(void *of, void (*is_at)(void *of, double share, double *sign, double *value),
                   double way) {
    const double nearest[SIGNS] = {2e-13 / way, 2e-13 / way};
    return pole_on(&(pole_way){of, SIGNS, VALUES, nearest, is_at});
}

TEST(pole, powers) {
    static const double orders[] = {0.0, 0.3, 0.5, 2.0 / 3.0, 0.8,  1.0,
                                    1.5, 2.0, 3.0, 7.0,       60.0, 200.0};
    enum { ORDERS = sizeof orders / sizeof orders[0] };
    for (unsigned c = 0; c < dice_cases(600); c++) {
        drawn d = {.place = dice_between(&die, 0.001, 0.999),
                   .order = orders[c % ORDERS],
                   .beside = dice_between(&die, -10.0, 10.0)};
        const bool near = dice_one_of(&die, 2) == 0;
        const bool upon = !near && dice_one_of(&die, 2) == 0;
        d.zeros = (int)dice_one_of(&die, 3);
        d.beside = near ? 0.0 : d.beside; /* a constant would hide such a weak pole */
        d.zero = upon   ? d.place
                 : near ? d.place + exp(dice_between(&die, -18.0, -2.0))
                        : dice_between(&die, -3.0, -1.0);
        d.side = dice_one_of(&die, 2) == 0 ? 0.0 : dice_one_of(&die, 2) == 0 ? 1.0 : -1.0;
        const bool has = d.order - (upon ? d.zeros : 0) >= 1.0;
        TEST_ASSERT_EQUAL_INT(has ? 1 : -1, pole_of(&d, at, dice_between(&die, 0.1, 2.0)));
        TEST_ASSERT_TRUE(d.asked < 2000);
    }
}

/* A divisor that touches zero must be found as a pole, as accurately as its digits allow. */
TEST(pole, touching_divisors_are_poles) {
    static const double orders[] = {0.0, 0.3, 0.5, 0.8, 1.0, 2.0, 3.0, 4.0};
    enum { ORDERS = sizeof orders / sizeof orders[0] };
    for (unsigned c = 0; c < dice_cases(600); c++) {
        drawn d = {.place = dice_between(&die, 0.02, 0.98),
                   .order = orders[c % ORDERS],
                   .beside = dice_between(&die, -10.0, 10.0),
                   .zero = dice_between(&die, -3.0, -1.0),
                   .zeros = (int)dice_one_of(&die, 2),
                   .touches = true};
        const bool has = d.order >= 1.0;
        TEST_ASSERT_EQUAL_INT(has ? 1 : -1, pole_of(&d, at, dice_between(&die, 0.5, 2.0)));
        TEST_ASSERT_TRUE(d.asked < 2000);
    }
}

/* Parabolas above zero, and parabolas whose minimum is zero. */
TEST(pole, parabolas_near_or_at_zero) {
    for (unsigned c = 0; c < dice_cases(600); c++) {
        const double least = dice_between(&die, 0.01, 3.0) * (c % 3 == 0 ? 1.0 : 0.0);
        const double zero_at = dice_between(&die, -0.5, 1.5);
        const double size = c % 2 == 0 ? 1.0 : -dice_between(&die, 0.1, 1e6);
        static const double share[4] = {0.0, POLE_ASIDE, 1.0 - POLE_ASIDE, 1.0};
        double value[4];
        for (int k = 0; k < 4; k++) {
            value[k] = size * ((share[k] - zero_at) * (share[k] - zero_at) + least);
        }
        const bool inside = zero_at > 0.0 && zero_at < 1.0;
        /* the tangents at both ends meet below zero, so the parabola may reach zero */
        const bool may = inside && least - zero_at * (1.0 - zero_at) < 0.0;
        if (fabs(least - zero_at * (1.0 - zero_at)) > 0.01 && fabs(zero_at - 0.5) < 0.98 &&
            fabs(fabs(zero_at - 0.5) - 0.5) > 0.01) {
            TEST_ASSERT_EQUAL_INT(may, pole_may_touch(value));
        }
    }
}

/* Each time x becomes a fifth, the value becomes 27 or 4.7 times larger, by turns. At a pole of order 1.5 it becomes
 * 11 times larger each time. */
static void at_leaps(void *of, double share, double *sign, double *value) {
    const drawn *d = of;
    const double x = share - d->place;
    const double turn = log(fabs(x)) / log(5.0) + d->beside;
    sign[0] = 1.0;
    sign[1] = x;
    value[0] = share;
    value[1] = number_power(fabs(x), -1.5) * (fmod(floor(turn), 2.0) == 0.0 ? 1.0 : 2.4);
}

/* sign[1] changes its sign beside the pole instead of at the pole. */
static void at_shifted(void *of, double share, double *sign, double *value) {
    const drawn *d = of;
    at(of, share, sign, value);
    sign[1] = share - d->zero;
}

TEST(pole, leaps_and_few_digits) {
    for (unsigned c = 0; c < dice_cases(100); c++) {
        drawn d = {.place = dice_between(&die, 0.1, 0.9), .beside = dice_between(&die, 0.0, 1.0)};
        TEST_ASSERT_EQUAL_INT(-1, pole_of(&d, at_leaps, 1.0));
        d.order = dice_between(&die, 1.0, 3.0);
        d.beside = 0.0;
        d.zero = d.place + exp(dice_between(&die, -27.0, -25.4)) * (c % 2 == 0 ? 1.0 : -1.0);
        TEST_ASSERT_EQUAL_INT(1, pole_of(&d, at_shifted, 1.0));
    }
}

typedef enum difference_kind {
    OF_EXP,
    OF_QUOTIENTS,
    OF_ROOT,
    OF_DECAY,
    OF_LOG,
    OF_SINE,
    OF_LANGEVIN,
    DIFFERENCES
} difference_kind;

typedef struct difference {
    difference_kind which;
    double from; /* start of the argument, which ends beyond zero */
    double to;
} difference;

static double call(function_id function, double x) { return number_call(function, x, 0.0); }

static double difference_at(difference_kind which, double x) {
    switch (which) {
    case OF_EXP: return (call(FN_EXP, x) - 1.0 - x) / (x * x);
    case OF_QUOTIENTS: return 1.0 / (call(FN_EXP, x) - 1.0) - 1.0 / x;
    case OF_ROOT: return (number_root(1.0 + x) - 1.0 - 0.5 * x) / (x * x);
    case OF_DECAY: return (1.0 - call(FN_EXP, -x)) / x;
    case OF_LOG: return (call(FN_LOG, 1.0 + x) - x) / (x * x);
    case OF_SINE: return 1.0 / number_sine(x) - 1.0 / x;
    case OF_LANGEVIN:
        return 1.0 / call(FN_TANH, x / 0.1) - 0.1 / x; /* x/0.1 and 0.1/x are rounded separately */
    case DIFFERENCES: break;
    }
    return (double)NAN;
}

static void at_difference(void *of, double share, double *sign, double *value) {
    const difference *d = of;
    const double x = d->from + share * (d->to - d->from);
    sign[0] = 1.0;
    sign[1] = x;
    value[0] = share;
    value[1] = difference_at(d->which, x);
}

TEST(pole, round_off_is_no_pole) {
    for (unsigned c = 0; c < dice_cases(350); c++) {
        const double size = exp(dice_between(&die, -17.0, -0.1));
        difference d = {.which = (difference_kind)(c % DIFFERENCES),
                        .from = -size * dice_between(&die, 0.1, 0.9),
                        .to = size * dice_between(&die, 0.1, 0.9)};
        TEST_ASSERT_EQUAL_INT(-1, pole_of(&d, at_difference, 1.0));
    }
}

/* A function of s = a + x that touches zero at x = 0, where the value has a limit or a weak pole. */
static void at_touched(void *of, double share, double *sign, double *value) {
    const drawn *d = of;
    const double s = d->place + (share - d->zero) * d->order;
    const double x = s - d->place;
    const double square = s * s - 2.0 * d->place * s + d->place * d->place;
    sign[0] = 1.0 - number_cosine(x);
    sign[1] = square;
    value[0] = d->zeros == 0 ? x * x / sign[0] : number_power(sign[0], -0.4);
    value[1] = d->zeros == 0 ? x * x / square : number_power(fabs(square), -0.4);
}

TEST(pole, divisors_without_digits_are_no_pole) {
    for (unsigned c = 0; c < dice_cases(600); c++) {
        drawn d = {.place = dice_between(&die, -1.0, 1.0),
                   .order = exp(dice_between(&die, -5.0, 0.0)),
                   .zero = dice_between(&die, 0.1, 0.9),
                   .zeros = (int)(c % 2)};
        TEST_ASSERT_EQUAL_INT(-1,
                              pole_of(&d, at_touched, number_least(1.0, d.order / fabs(d.place))));
    }
}

/* A divisor that comes near zero and rises again: y^2 + x^2, or 1 + y^2 - cos(x), which has fewer digits there. */
static void at_standing(void *of, double share, double *sign, double *value) {
    const drawn *d = of;
    const double x = (share - d->place) * d->order;
    sign[0] = d->zero * d->zero + x * x;
    sign[1] = 1.0 + d->zero * d->zero - number_cosine(x);
    value[0] = d->zeros == 0 ? x / number_root(sign[0]) : d->zero / number_root(sign[0]);
    value[1] = d->zeros == 0 ? 1.0 / sign[1] : 1.0 / sign[0];
}

TEST(pole, positive_divisors_are_no_pole) {
    for (unsigned c = 0; c < dice_cases(600); c++) {
        drawn d = {.place = dice_between(&die, 0.1, 0.9),
                   .order = exp(dice_between(&die, -5.0, 0.0)),
                   .zeros = (int)(c % 2)};
        d.zero = d.order * exp(dice_between(&die, -8.0, 0.0));
        TEST_ASSERT_EQUAL_INT(-1, pole_of(&d, at_standing, 1.0));
    }
}

/* 1/(1 + k/x) for x from below -k to above zero. 1 + k/x has the same sign at both ends. */
static void at_twice(void *of, double share, double *sign, double *value) {
    const drawn *d = of;
    const double x = share - d->place;
    sign[0] = x;
    sign[1] = 1.0 + d->order / x;
    value[0] = share;
    value[1] = 1.0 / sign[1];
}

TEST(pole, double_sign_changes_are_poles) {
    for (unsigned c = 0; c < dice_cases(60); c++) {
        drawn d = {.place = dice_between(&die, 0.3, 0.7),
                   .order = exp(dice_between(&die, -15.0, -1.5))};
        TEST_ASSERT_EQUAL_INT(1, pole_of(&d, at_twice, 1.0));
        d.order = 1.0; /* now the pole is after the end */
        TEST_ASSERT_EQUAL_INT(-1, pole_of(&d, at_twice, 1.0));
    }
}

SUITE(pole) { die = dice_of("pole", 61); }
