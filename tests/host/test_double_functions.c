/* test_double_functions.c: the functions of the double build, compared with long double.
 *
 *   WHIRL_FUNCTION_CASES=100000000 build/tests/host double_functions
 *
 * tests that many arguments of each kind; the usual number is a hundred thousand. Long double has at least 64 bits, so
 * the errors of its functions are below 2^-10 of a double's last place. The arguments are random bit patterns, values
 * with results that are neither 0 nor infinite, and values at which digits are easily lost. */
#define WH_DOUBLE 1
#include "core/function_double.h"

#include "command.h"
#include "tests/scattered.h"

#if LDBL_MANT_DIG >= 64

#define PI_L 3.141592653589793238462643383279502884L

static unsigned long cases(void) {
    const char *asked = getenv("WHIRL_FUNCTION_CASES");
    return asked != NULL ? strtoul(asked, NULL, 10) : usual_or(100000, 30000);
}

static double unit(void) { return (double)(scattered() >> 11) * 0x1p-53; }
static double within(double least, double most) { return least + (most - least) * unit(); }
static double either(double x) { return (scattered() & 1U) != 0 ? -x : x; }
/* Any bits: every exponent equally often, with zeros, subnormals, infinities and NaN. */
static double any(void) { return wh_of_bits(scattered()); }
/* A random number whose exponent is uniform from `least` to `most`. */
static double scaled_between(int least, int most) {
    const int exponent = least + (int)(scattered() % (uint64_t)(most - least));
    return either(ldexp(1.0 + unit(), exponent));
}
static double near(double x) { return wh_of_bits(wh_bits(x) + (scattered() % 4096U) - 2048U); }
static double near_widely(double x) { return x * (1.0 + scaled_between(-53, -3)); }
/* A double near a random multiple of a quarter turn. */
static double quarter_turn(void) {
    const long double many = floorl(ldexpl((long double)unit(), (int)(scattered() % 60U)));
    return either(near((double)((many + 1.0L) * PI_L / 2.0L)));
}

static double worst_error;
static double worst_x;
static double worst_y;

static double error_of(double got, long double wanted) {
    if (isnan(wanted) || isnan(got)) {
        return isnan(wanted) && isnan(got) ? 0.0 : HUGE_VAL;
    }
    const double nearest = (double)wanted;
    /* the last half unit below infinity may round to either side */
    if (isinf(nearest) || isinf(got)) {
        return got == nearest ? 0.0 : fabsl(wanted) < 0x1.fffffffffffffp1023L ? HUGE_VAL : 0.5;
    }
    if (wanted == 0.0L) {
        return got == 0.0 ? 0.0 : HUGE_VAL;
    }
    int exponent;
    (void)frexpl(wanted, &exponent);
    const int unit_exponent = exponent - 53 < -1074 ? -1074 : exponent - 53;
    return (double)ldexpl(fabsl((long double)got - wanted), -unit_exponent);
}

static void count(double error, double x, double y) {
    if (!(error <= worst_error)) {
        worst_error = error;
        worst_x = x;
        worst_y = y;
    }
}

typedef struct function {
    const char *name;
    double (*ours)(double);
    long double (*theirs)(long double);
    double (*kinds[5])(void);
} function;

static double exp_range(void) { return within(-745.5, 710.0); }
static double small(void) { return scaled_between(-60, 4); }
static double subnormal_exp(void) { return within(-745.2, -708.0); }
static double about_one(void) { return near_widely(1.0); }
static double next_to_one(void) { return either(near(1.0)); }
static double positive(void) { return fabs(any()); }
static double few(void) { return within(0.5, 2.0); }
static double turn(void) { return within(-7.0, 7.0); }
static double many_turns(void) { return within(-1e5, 1e5); }
static double huge_angle(void) { return scaled_between(30, 1023); }
static double proper(void) { return within(-1.0, 1.0); }
static double near_one(void) { return either(1.0 - fabs(scaled_between(-53, -1)) / 2.0); }
static double up_to_twelve(void) { return within(-12.0, 12.0); }

static double sinh_range(void) { return within(-711.0, 711.0); }
static double overflowing(void) { return either(within(709.0, 711.0)); }
static double near_series_end(void) { return either(0.25 + scaled_between(-53, -4)); }

static const function functions[] = {
    {"exp", wh_exp, expl, {any, exp_range, small, subnormal_exp, next_to_one}},
    {"log", wh_log, logl, {any, positive, about_one, next_to_one, few}},
    {"sin", wh_sine, sinl, {any, turn, many_turns, huge_angle, quarter_turn}},
    {"cos", wh_cosine, cosl, {any, turn, many_turns, huge_angle, quarter_turn}},
    {"tan", wh_tan, tanl, {any, turn, many_turns, huge_angle, quarter_turn}},
    {"asin", wh_asin, asinl, {any, proper, near_one, small, next_to_one}},
    {"acos", wh_acos, acosl, {any, proper, near_one, small, next_to_one}},
    {"atan", wh_atan, atanl, {any, proper, up_to_twelve, small, next_to_one}},
    {"sinh", wh_sinh, sinhl, {sinh_range, proper, overflowing, small, near_series_end}},
    {"cosh", wh_cosh, coshl, {sinh_range, proper, overflowing, small, near_series_end}},
    {"tanh", wh_tanh, tanhl, {up_to_twelve, proper, many_turns, small, near_series_end}},
};
#define ONE_MORE(name) +1
#define NONE_MORE(name)
_Static_assert(sizeof functions / sizeof functions[0] == 2 WH_FUNCTIONS(ONE_MORE, NONE_MORE),
               "every function of core/function.h is held against long double");

static void expect_within_one(const char *name) {
    char line[160];
    (void)snprintf(line, sizeof line, "%-5s errs by %.4f units at (%a, %a)", name, worst_error,
                   worst_x, worst_y);
    puts(line);
    TEST_ASSERT_TRUE_MESSAGE(worst_error < 1.0, line);
    TEST_ASSERT_TRUE_MESSAGE(worst_error > 0.4, "no error at all: not compared?");
}

TEST(double_functions, one_argument) {
    scattered_state = 1;
    for (size_t f = 0; f < sizeof functions / sizeof functions[0]; f++) {
        const function *of = &functions[f];
        worst_error = 0.0;
        for (unsigned kind = 0; kind < 5; kind++) {
            for (unsigned long i = cases(); i > 0; i--) {
                const double x = of->kinds[kind]();
                count(error_of(of->ours(x), of->theirs((long double)x)), x, 0.0);
            }
        }
        expect_within_one(of->name);
    }
}

TEST(double_functions, atan2) {
    scattered_state = 2;
    worst_error = 0.0;
    for (unsigned kind = 0; kind < 4; kind++) {
        for (unsigned long i = cases(); i > 0; i--) {
            double y = any();
            double x = any();
            if (kind == 1) {
                y = within(-1.0, 1.0);
                x = within(-1.0, 1.0);
            } else if (kind == 2) { /* x and y are of similar size */
                x = isfinite(y) ? y * either(within(0.01, 1.0)) : x;
            } else if (kind == 3) {
                x = isfinite(y) ? y * scaled_between(-70, 70) : x;
            }
            count(error_of(wh_atan2(y, x), atan2l((long double)y, (long double)x)), y, x);
        }
    }
    expect_within_one("atan2");
}

TEST(double_functions, pow) {
    scattered_state = 3;
    worst_error = 0.0;
    for (unsigned kind = 0; kind < 6; kind++) {
        for (unsigned long i = cases(); i > 0; i--) {
            double x = any();
            double y = any();
            if (kind == 1) { /* powers of any size */
                x = fabs(x);
                y = isfinite(x) && x > 0.0 ? within(-745.0, 710.0) / log(x) : y;
            } else if (kind == 2) {
                x = within(0.0, 10.0);
                y = within(-10.0, 10.0);
            } else if (kind == 3) { /* powers for which all digits of log(x) matter */
                x = near_widely(1.0);
                y = within(-745.0, 710.0) / log(x);
            } else if (kind == 4) {
                y = either((double)(scattered() % 40U));
            } else if (kind == 5) { /* powers too small for 53 bits */
                x = within(0.0, 1.0);
                y = x > 0.0 ? within(-745.2, -708.0) / log(x) : y;
            }
            count(error_of(wh_pow(x, y), powl((long double)x, (long double)y)), x, y);
        }
    }
    expect_within_one("pow");
}

#endif
