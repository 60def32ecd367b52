/* test_trust_matrix.c: until when runs by one matrix a step can be trusted: drawn linear mechanisms. By the exact matrix to the
 * end, whatever the step; by what Runge-Kutta 4 makes of it until the reference says so. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "horizons.h"
#include "linear.h"
#include "unity.h"

void suite_trust_matrix(void);

typedef struct way {
    const char *words;
    horizons_setting how;
} way;

static const way exact[] = {
    {"double", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_EXACT}},
    {"double compensated", {&engine_double, true, WH_RK4, TABLES_NONE, MATRIX_EXACT}},
    {"float", {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_EXACT}},
    {"float compensated", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_EXACT}}};
static const way by_rk4[] = {
    {"rk4, double", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_RK4}},
    {"rk4, float compensated", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_RK4}}};
enum {
    EXACT = sizeof exact / sizeof exact[0],
    BY_RK4 = sizeof by_rk4 / sizeof by_rk4[0],
    STEPS = 3
};
static const int step_ms[STEPS] = {2, 20, 100};

/* The n-th: one to four coordinates, masses coupled or not; its scene of two seconds in this step. */
static horizons one_of(uint64_t *seed, unsigned n, int ms, horizons_setting how) {
    char text[4000];
    linear of;
    linear_draw(seed, 1 + (int)(n % 4), (linear_kind){n % 3 == 0 ? 3 : 0, n % 2 != 0}, text,
                sizeof text - 40, &of);
    char *step = strstr(text, "step ");
    TEST_ASSERT_NOT_NULL(step);
    snprintf(step, 40, "step %d [ms]; until 2 [s] }\n", ms);
    return horizons_of(text, "s", how, HORIZON_TOLERANCE);
}

static void test_exact_steps_are_right_to_the_end(void) {
    uint64_t seed = 1408;
    double worst = 0.0;
    for (unsigned n = 0; n < few_or_all(12, 48); n++) {
        const way *w = &exact[n % EXACT];
        horizons h = one_of(&seed, n, step_ms[n / EXACT % STEPS], w->how);
        TEST_ASSERT_TRUE_MESSAGE(h.true_until_s >= h.twins->end_s, w->words);
        TEST_ASSERT_TRUE_MESSAGE(h.estimate.to_the_end, w->words);
        for (int k = 1; k < h.twins->columns && w->how.kind == &engine_double; k++) {
            worst = fmax(worst, h.estimate.column[k].off / h.estimate.column[k].range);
        }
        horizons_free(&h);
    }
    printf("  in double off by at most %.1e of the range\n", worst);
    TEST_ASSERT_TRUE(worst > 0.0 && worst < 1e-11);
}

/* Two masses on springs, nothing damped: phases drift apart from the truth, until both say so. */
static void test_coarse_steps_until_the_reference_says_so(void) {
    dice d = dice_of("trust matrix", 1409);
    int ended = 0;
    double least = 1.0;
    double most = 1.0;
    const unsigned cases = dice_cases(few_or_all(8, 24));
    for (unsigned n = 0; n < cases; n++) {
        const way *w = &by_rk4[n % BY_RK4];
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism pair\ncoordinate x [m]\ncoordinate y [m]\n"
                 "T = %.3g [kg]*x'^2/2 + %.3g [kg]*y'^2/2\n"
                 "V = %.3g [N/m]*x^2/2 + %.3g [N/m]*(x - y)^2/2\n"
                 "scene s { start x = 1 [m]; step %u [ms]; until 100 [s] }\n",
                 dice_between(&d, 1.0, 4.0), dice_between(&d, 1.0, 4.0), dice_between(&d, 1.0, 9.0),
                 dice_between(&d, 1.0, 9.0), 50 + dice_one_of(&d, 60));
        horizons h = horizons_of(text, "s", w->how, HORIZON_TOLERANCE);
        TEST_ASSERT_TRUE_MESSAGE(fabs(h.estimate.until_s - h.true_until_s) <=
                                     0.1 * h.true_until_s + 1.5 * h.look_s,
                                 text);
        ended += h.true_until_s < h.twins->end_s ? 1 : 0;
        least = fmin(least, horizons_ratio(&h));
        most = fmax(most, horizons_ratio(&h));
        horizons_free(&h);
    }
    printf("  %u runs, %d end on the way, estimate / truth %.3f to %.3f\n", cases, ended, least,
           most);
    TEST_ASSERT_TRUE(ended > 0 && ended < (int)cases);
}

void suite_trust_matrix(void) {
    RUN_TEST(test_exact_steps_are_right_to_the_end);
    RUN_TEST(test_coarse_steps_until_the_reference_says_so);
}
