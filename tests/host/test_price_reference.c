/* test_price_reference.c: the reference of `whirl price`, compared with closed forms in long double, and its
 * functions with libm. The reference shares no code with the runs that it judges. */
#include "derived.h"

#include "host/study/reference_run.h"

#define MOST_OPERATIONS 6e8

static double units_off(long double got, long double want) {
    int exponent;
    if (isnan(got) || isnan(want)) {
        return isnan(got) && isnan(want) ? 0.0 : (double)INFINITY;
    }
    (void)frexpl(want, &exponent);
    return (double)(fabsl(got - want) / ldexpl(1.0L, exponent - LDBL_MANT_DIG));
}

typedef struct long_case {
    function_id function;
    long double (*library)(long double);
    double low, high;
    double allowed; /* allowed error, in units of the last place of long double */
} long_case;

static const long_case long_cases[] = {
    {FN_SIN, sinl, -400.0, 400.0, 4.0}, {FN_COS, cosl, -400.0, 400.0, 4.0},
    {FN_TAN, tanl, -50.0, 50.0, 8.0},   {FN_ASIN, asinl, -1.0, 1.0, 8.0},
    {FN_ACOS, acosl, -1.0, 1.0, 8.0},   {FN_ATAN, atanl, -50.0, 50.0, 6.0},
    {FN_EXP, expl, -50.0, 50.0, 6.0},   {FN_LOG, logl, 1e-3, 100.0, 16.0},
    {FN_LOG, logl, 0.9, 1.1, 6.0},      {FN_SINH, sinhl, -30.0, 30.0, 8.0},
    {FN_COSH, coshl, -30.0, 30.0, 8.0}, {FN_TANH, tanhl, -30.0, 30.0, 8.0},
    {FN_SQRT, sqrtl, 0.0, 1e6, 2.0},    {FN_SINH, sinhl, -1e-3, 1e-3, 4.0},
    {FN_ATAN, atanl, -1e-6, 1e-6, 4.0}, {FN_ABS, fabsl, -3.0, 3.0, 0.0},
};

TEST(price_reference, functions_against_libm) {
    uint64_t seed = 71;
    for (size_t c = 0; c < sizeof long_cases / sizeof long_cases[0]; c++) {
        const long_case *each = &long_cases[c];
        double worst = 0.0;
        for (int i = 0; i < 20000; i++) {
            const long double x = (long double)random_between(&seed, each->low, each->high) *
                                  (1.0L + 0x1p-60L * (long double)(i % 7));
            worst = fmax(worst, units_off(long_call(each->function, x, 0.0L), each->library(x)));
        }
        printf("  %-6s %g ... %g: off by %.3g units of the last place\n",
               function_name(each->function), each->low, each->high, worst);
        TEST_ASSERT_TRUE_MESSAGE(worst <= each->allowed, function_name(each->function));
    }
}

TEST(price_reference, functions_of_two) {
    uint64_t seed = 72;
    double worst_angle = 0.0;
    double worst_power = 0.0;
    for (int i = 0; i < 20000; i++) {
        const long double x = (long double)random_between(&seed, -9.0, 9.0);
        const long double y = (long double)random_between(&seed, -9.0, 9.0);
        worst_angle = fmax(worst_angle, units_off(long_call(FN_ATAN2, y, x), atan2l(y, x)));
        worst_power = fmax(worst_power, units_off(long_power(fabsl(x), y), powl(fabsl(x), y)));
        TEST_ASSERT_TRUE(long_call(FN_MIN, x, y) == fminl(x, y));
        TEST_ASSERT_TRUE(long_call(FN_MAX, x, y) == fmaxl(x, y));
        TEST_ASSERT_TRUE(long_power(x, 3.0L) == x * (x * x) || fabsl(x) > 0.0L);
    }
    printf("  atan2 off by %.3g, powers by %.3g units\n", worst_angle, worst_power);
    TEST_ASSERT_TRUE(worst_angle <= 6.0);
    TEST_ASSERT_TRUE(worst_power <= 200.0); /* in units of |exponent log(base)| */
}

TEST(price_reference, functions_at_their_edges) {
    const long double inf = (long double)INFINITY;
    TEST_ASSERT_TRUE(isnan(long_call(FN_LOG, -1.0L, 0.0L)));
    TEST_ASSERT_TRUE(long_call(FN_LOG, 0.0L, 0.0L) == -inf);
    TEST_ASSERT_TRUE(isnan(long_call(FN_SQRT, -1.0L, 0.0L)));
    TEST_ASSERT_TRUE(isnan(long_call(FN_ASIN, 1.5L, 0.0L)));
    TEST_ASSERT_TRUE(isnan(long_power(-2.0L, 0.5L)));
    TEST_ASSERT_TRUE(long_power(-2.0L, 3.0L) == -8.0L);
    TEST_ASSERT_TRUE(long_power(0.0L, 1.5L) == 0.0L);
    TEST_ASSERT_TRUE(long_power(2.0L, -2.0L) == 0.25L);
    TEST_ASSERT_TRUE(long_call(FN_EXP, -20000.0L, 0.0L) == 0.0L);
    TEST_ASSERT_TRUE(long_call(FN_EXP, 20000.0L, 0.0L) == inf);
    TEST_ASSERT_TRUE(isnan(long_call(FN_SIN, inf, 0.0L)));
    TEST_ASSERT_TRUE(isnan(long_call(FN_MIN, 1.0L, (long double)NAN)));
    TEST_ASSERT_TRUE(long_call(FN_SIGN, -3.0L, 0.0L) == -1.0L);
    TEST_ASSERT_TRUE(units_off(long_root(0x1p-16000L), 0x1p-8000L) <= 1.0 || !LONG_IS_LONGER);
}

static reference *reference_of(const image *im, double spacing_s, int count) {
    const reference_wish wish = {.image = im,
                                 .spacing = ratio_of(spacing_s),
                                 .records = count,
                                 .operations = MOST_OPERATIONS};
    reference *r = reference_new(&wish);
    TEST_ASSERT_EQUAL_INT(REFERENCE_EXTRAPOLATED, r->kind);
    TEST_ASSERT_EQUAL_INT_MESSAGE(count, r->records, r->why);
    return r;
}

static long double at(const reference *r, int record, const char *name) {
    bool noisy;
    const int column = reference_find(r, name, &noisy);
    TEST_ASSERT_TRUE_MESSAGE(column > 0 && !noisy, name);
    return r->row[(size_t)record * (size_t)r->columns + (size_t)column];
}

/* x(t) and x'(t) of m x'' + c x' + k x = 0, underdamped, from x0 and v0. Stiffness and damping are powers of two,
 * because the algebra rounds other constants by 1e-16. */
TEST(price_reference, damped_springs) {
    uint64_t seed = 73;
    double worst = 0.0;
    for (int i = 0; i < 12; i++) {
        char text[600];
        const double k = number_scaled(1.0, (int)random_between(&seed, 0.0, 10.0));
        const double c =
            i % 4 == 0 ? 0.0 : number_scaled(1.0, -(int)random_between(&seed, 1.0, 6.0));
        const double x0 = number_nearest(random_between(&seed, -16.0, 16.0)) / 4.0 + 0.125;
        const double v0 = number_nearest(random_between(&seed, -16.0, 16.0)) / 2.0;
        snprintf(text, sizeof text,
                 "mechanism spring\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %g [N/m]*x^2/2\n"
                 "F = %g [N*s/m]*x'^2/2\noutput twice [m] = 2*x\n"
                 "scene s { start x = %g [m], x' = %g [m/s]; step 1 [ms]; until 4 [s] }\n",
                 k, c, x0, v0);
        derived d = derived_surely(derived_scene(text, "s"), text);
        reference *r = reference_of(d.image, 0.01, 400);
        const long double half = (long double)c / 2.0L;
        const long double w = sqrtl((long double)k - half * half);
        const long double b = ((long double)v0 + half * (long double)x0) / w;
        for (int n = 0; n <= 400; n++) {
            const long double t = (long double)n / 100.0L;
            const long double e = expl(-half * t);
            const long double x = e * ((long double)x0 * cosl(w * t) + b * sinl(w * t));
            const long double v = e * (((long double)b * w - half * (long double)x0) * cosl(w * t) -
                                       ((long double)x0 * w + half * b) * sinl(w * t));
            const long double size = fabsl((long double)x0) + fabsl(b);
            worst = fmax(worst, (double)(fabsl(at(r, n, "x") - x) / size));
            worst = fmax(worst, (double)(fabsl(at(r, n, "x'") - v) / size / w));
            worst = fmax(worst, (double)(fabsl(at(r, n, "twice") - 2.0L * x) / size));
        }
        reference_free(r);
        derived_free(&d);
    }
    printf("  damped springs: off by %.2e of their amplitude over 4 s\n", worst);
    TEST_ASSERT_TRUE(worst <= 200.0 * (double)LDBL_EPSILON);
}

TEST(price_reference, pendulums_keep_their_energy) {
    uint64_t seed = 74;
    double worst = 0.0;
    for (int i = 0; i < 12; i++) {
        char text[400];
        const double rate = number_nearest(random_between(&seed, 0.0, 40.0)) / 4.0;
        snprintf(text, sizeof text,
                 "mechanism pendulum\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\n"
                 "V = -8 [J]*cos(a)\n"
                 "scene p { start a = 0.25 [rad], a' = %g [rad/s]; step 1 [ms]; until 10 [s] }\n",
                 rate);
        derived d = derived_surely(derived_scene(text, "p"), text);
        reference *r = reference_of(d.image, 0.05, 200);
        const long double start = at(r, 0, "a'") * at(r, 0, "a'") / 2.0L - 8.0L * cosl(0.25L);
        for (int n = 0; n <= 200; n++) {
            const long double v = at(r, n, "a'");
            const long double now = v * v / 2.0L - 8.0L * cosl(at(r, n, "a"));
            worst = fmax(worst, (double)(fabsl(now - start) / (8.0L + v * v / 2.0L)));
        }
        reference_free(r);
        derived_free(&d);
    }
    printf("  pendulums: energy off by %.2e of itself over 10 s\n", worst);
    TEST_ASSERT_TRUE(worst <= 500.0 * (double)LDBL_EPSILON);
}

/* A double pendulum that is thrown high is chaotic. The horizon must be shorter if it is thrown higher. */
TEST(price_reference, chaos_cuts_the_horizon) {
    derived d = derived_surely(derived_builtin("thomson_b"), "thomson_b");
    const reference_wish wish = {
        .image = d.image, .spacing = {1, 10}, .records = 100, .operations = MOST_OPERATIONS};
    reference *r = reference_new(&wish);
    TEST_ASSERT_EQUAL_INT(REFERENCE_EXTRAPOLATED, r->kind);
    TEST_ASSERT_TRUE(r->records > 10 && r->records < 100);
    TEST_ASSERT_NOT_NULL(r->why);
    reference_free(r);
    derived_free(&d);
}
