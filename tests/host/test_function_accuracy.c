/* test_function_accuracy.c: the float functions, compared with the library's in long double, at arguments of every
 * exponent and at arguments where digits are easily lost.
 *
 *   WHIRL_FUNCTION_CASES=10000000 build/tests/host function_accuracy
 *
 * tests so many arguments of each kind instead of thirty thousand. `make functions-exhaustive` tests all arguments;
 * the bounds below are its results, rounded up. A worst error below half a unit would mean that the function was not
 * tested. */
#include "core/function.h"

#include "test.h"
#include "tests/scattered.h"

#define SEED UINT64_C(10)
static unsigned long cases(void) {
    const char *asked = getenv("WHIRL_FUNCTION_CASES");
    return asked != NULL ? strtoul(asked, NULL, 10) : 30000UL;
}

static float unit(void) { return (float)(scattered() >> 40) * 0x1p-24f; }
static float either(float x) { return (scattered() & 1U) != 0 ? -x : x; }
static float between(int least, int most) {
    return ldexpf(1.0f + unit(), least + (int)(scattered() % (uint64_t)(most - least)));
}
static float any(void) { return either(between(-149, 128)); }
static float positive(void) { return between(-149, 128); }
static float below_104(void) { return either(unit() * 104.0f); }
static float near_one(void) { return 1.0f + either(between(-24, -2)); }
static float up_to_one(void) { return either(unit()); }
static float near_unit(void) { return either(1.0f - between(-24, -1) * 0.5f); }
/* A float next to a random multiple of a quarter turn. */
static float quarter_turn(void) {
    const long double many = floorl(ldexpl((long double)unit(), (int)(scattered() % 127U)));
    float x = (float)((many + 1.0L) * 1.5707963267948966192313216916398L);
    for (uint64_t i = scattered() % 3U; i > 0; i--) {
        x = nextafterf(x, HUGE_VALF);
    }
    return either(x);
}

static double error_of(float got, long double wanted) {
    /* from 2^128 on, the nearest float is infinite */
    const long double truth = fminl(fabsl(wanted), 0x1p128L);
    const long double reached = isinf(got) ? 0x1p128L : fabsl((long double)got);
    int exponent = -125;
    if (truth != 0.0L) {
        frexpl(fminl(truth, 0x1.fffffep127L), &exponent);
    }
    if (!signbit(got) != !signbit(wanted)) {
        return 1e9;
    }
    const int least = exponent < -125 ? -125 : exponent;
    return (double)fabsl(ldexpl(reached - truth, 24 - least));
}

typedef struct subject {
    const char *name;
    float (*of)(float);
    long double (*reference)(long double);
    float (*argument[3])(void);
    double bound;
} subject;

TEST(function_accuracy, functions_of_one) {
    static const subject subjects[] = {
        {"exp", wh_exp, expl, {any, below_104, near_one}, 0.52},
        {"log", wh_log, logl, {positive, near_one, below_104}, 0.52},
        {"tan", wh_tan, tanl, {any, quarter_turn, below_104}, 0.57},
        {"asin", wh_asin, asinl, {up_to_one, near_unit, any}, 0.54},
        {"acos", wh_acos, acosl, {up_to_one, near_unit, any}, 0.53},
        {"atan", wh_atan, atanl, {any, near_one, below_104}, 0.53},
        {"sinh", wh_sinh, sinhl, {any, below_104, up_to_one}, 0.52},
        {"cosh", wh_cosh, coshl, {any, below_104, up_to_one}, 0.52},
        {"tanh", wh_tanh, tanhl, {any, below_104, up_to_one}, 0.53},
    };
#define ONE_MORE(name) +1
#define NONE_MORE(name)
    _Static_assert(sizeof subjects / sizeof subjects[0] == 0 WH_FUNCTIONS(ONE_MORE, NONE_MORE),
                   "every function of core/function.h");
    scattered_state = SEED;
    for (unsigned k = 0; k < sizeof subjects / sizeof subjects[0]; k++) {
        const subject *s = &subjects[k];
        double worst = 0.0;
        float worst_at = 0.0f;
        for (unsigned long i = 0; i < 3 * cases(); i++) {
            const float x = s->argument[i % 3]();
            const float got = s->of(x);
            const long double wanted = s->reference((long double)x);
            TEST_ASSERT_EQUAL_INT_MESSAGE(isnan(wanted) != 0, isnan(got) != 0, s->name);
            const double error = isnan(got) ? 0.0 : error_of(got, wanted);
            if (error > worst) {
                worst = error;
                worst_at = x;
            }
        }
        char text[120];
        snprintf(text, sizeof text, "%s errs by %.4f units at %a (seed %d)", s->name, worst,
                 (double)worst_at, (int)SEED);
        TEST_ASSERT_TRUE_MESSAGE(worst <= s->bound && worst > 0.49, text);
    }
}

/* A random exponent with which the power of `base` is in float's range. */
static float exponent_for(float base) {
    return (float)(either(unit() * 150.0f) / log2f(fabsf(base)));
}

TEST(function_accuracy, functions_of_two) {
    double worst_arc = 0.0;
    double worst_power = 0.0;
    float worst_at[2] = {0.0f, 0.0f};
    scattered_state = SEED;
    for (unsigned long i = 0; i < 3 * cases(); i++) {
        const float y = any();
        const float x = i % 3 == 0 ? any() : y * (i % 3 == 1 ? between(-24, 24) : near_one());
        if (x != 0.0f) {
            worst_arc =
                fmax(worst_arc, error_of(wh_atan2(y, x), atan2l((long double)y, (long double)x)));
        }
        const float base = i % 3 == 0 ? near_one() : positive();
        const float exponent = i % 3 == 2 ? either(between(-30, 8)) : exponent_for(base);
        const long double power = powl((long double)base, (long double)exponent);
        const double error = isnan(power) ? 0.0 : error_of(wh_pow(base, exponent), power);
        if (error > worst_power) {
            worst_power = error;
            worst_at[0] = base;
            worst_at[1] = exponent;
        }
    }
    char text[160];
    snprintf(text, sizeof text, "atan2 errs by %.4f units; power by %.4f at %a, %a (seed %d)",
             worst_arc, worst_power, (double)worst_at[0], (double)worst_at[1], (int)SEED);
    TEST_ASSERT_TRUE_MESSAGE(worst_arc <= 0.53 && worst_arc > 0.49, text);
    TEST_ASSERT_TRUE_MESSAGE(worst_power <= 0.65 && worst_power > 0.49, text);
}
