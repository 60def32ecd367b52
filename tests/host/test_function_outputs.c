/* test_function_outputs.c: every function and power of the language, in forces and outputs of a float run, at arguments
 * of every size. Results are accurate to the last places, the tangent also where it is small or large.
 *
 * WHIRL_FUNCTION_CASES=10000 build/tests/host function_outputs
 *
 * tests that many arguments of each kind instead of twenty-five. */
#include "core/function.h"
#include "derived.h"
#include "motion.h"

#define PI_L 3.141592653589793238462643383279502884L

typedef struct form {
    const char *text; /* with the coordinates x and y, lengths */
    long double (*of)(long double x, long double y);
    bool positive;
    double largest; /* x and y in size */
} form;

static long double of_exp(long double x, long double y) { return expl(x) + 0.0L * y; }
static long double of_log(long double x, long double y) { return logl(x) + 0.0L * y; }
static long double of_tan(long double x, long double y) { return tanl(x) + 0.0L * y; }
static long double of_asin(long double x, long double y) { return asinl(x) + 0.0L * y; }
static long double of_acos(long double x, long double y) { return acosl(x) + 0.0L * y; }
static long double of_atan(long double x, long double y) { return atanl(x) + 0.0L * y; }
static long double of_sinh(long double x, long double y) { return sinhl(x) + 0.0L * y; }
static long double of_cosh(long double x, long double y) { return coshl(x) + 0.0L * y; }
static long double of_tanh(long double x, long double y) { return tanhl(x) + 0.0L * y; }
static long double of_power(long double x, long double y) { return powl(x, 0.375L) + 0.0L * y; }

static const form forms[] = {
    {"exp(x/1 [m])", of_exp, false, 80.0},    {"log(x/1 [m])", of_log, true, 1e9},
    {"tan(x/1 [m])", of_tan, false, 1e9},     {"asin(x/1 [m])", of_asin, false, 1.0},
    {"acos(x/1 [m])", of_acos, false, 1.0},   {"atan(x/1 [m])", of_atan, false, 1e9},
    {"sinh(x/1 [m])", of_sinh, false, 80.0},  {"cosh(x/1 [m])", of_cosh, false, 80.0},
    {"tanh(x/1 [m])", of_tanh, false, 1e9},   {"atan2(y, x)", NULL, false, 1e9}, /* exchanged */
    {"(x/1 [m])^0.375", of_power, true, 1e9}, {"(x/1 [m])^(y/1 [m])", powl, true, 8.0},
};

#define ONE_MORE(name) +1
_Static_assert(sizeof forms / sizeof forms[0] == 1 WH_FUNCTIONS(ONE_MORE, ONE_MORE),
               "every function of core/function.h, and a power that is fixed");

static unsigned long cases(void) {
    const char *asked = getenv("WHIRL_FUNCTION_CASES");
    return asked != NULL ? strtoul(asked, NULL, 10) : 25UL;
}

/* The error of the output in units of FLT_EPSILON, two of which are a unit in the last place at most. */
static double error_at(const form *f, float x, float y) {
    char text[800];
    snprintf(text, sizeof text,
             "mechanism called \"a function\"\n"
             "coordinate x [m]\n"
             "coordinate y [m]\n"
             "let f = %s\n"
             "T = 1 [kg]*(x'^2 + y'^2)/2\n"
             "Q(x) = 1e-3 [N]*f\n"
             "output got = f\n"
             "output pushed [m/s^2] = x''\n"
             "scene called_once { start x = %.9g [m], y = %.9g [m]; step 1 [ms]; until 1 [s] }\n",
             f->text, (double)x, (double)y);
    motion m;
    motion_open_text(&m, text, IN_FLOAT);
    const double got = motion_value(&m, "got");
    const double pushed = motion_value(&m, "pushed");
    motion_close(&m);
    const long double wanted = f->of == NULL ? atan2l((long double)y, (long double)x)
                                             : f->of((long double)x, (long double)y);
    if (pushed != (double)((float)got * 1e-3f)) {
        return HUGE_VAL; /* force and output differ */
    }
    return (double)(fabsl((long double)got - wanted) / fabsl(wanted)) / (double)FLT_EPSILON;
}

static void expect(const form *f, float x, float y) {
    const double error = error_at(f, x, y);
    char text[160];
    snprintf(text, sizeof text, "%s at %.9g, %.9g errs by %.2f FLT_EPSILON", f->text, (double)x,
             (double)y, error);
    TEST_ASSERT_TRUE_MESSAGE(error <= 0.7, text);
}

TEST(function_outputs, functions_of_any_size) {
    uint64_t seed = 11;
    for (unsigned k = 0; k < sizeof forms / sizeof forms[0]; k++) {
        for (unsigned long i = 0; i < cases(); i++) {
            const double reach = log(forms[k].largest);
            const double size = exp(random_between(&seed, reach - 20.0, reach));
            const double other = exp(random_between(&seed, reach - 20.0, reach));
            const bool negative = !forms[k].positive && random_bits(&seed) % 2 == 0;
            const bool below = random_bits(&seed) % 2 == 0;
            expect(&forms[k], (float)(negative ? -size : size), (float)(below ? -other : other));
        }
    }
}

/* The floats nearest to multiples of a quarter turn, where a tangent is smallest or largest. */
TEST(function_outputs, tangent_at_quarter_turns) {
    uint64_t seed = 12;
    for (unsigned long i = 0; i < 4 * cases(); i++) {
        const uint64_t quarters = random_bits(&seed) % (UINT64_C(1) << random_bits(&seed) % 25U);
        const float rad = (float)((long double)(quarters + 1U) * PI_L / 2.0L);
        expect(&forms[2], i % 2 == 0 ? rad : -rad, 0.0f);
    }
}
