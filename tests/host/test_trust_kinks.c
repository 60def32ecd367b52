/* test_trust_kinks.c: until when a run is right whose force has a kink: a body on a spring, and a second one that begins a way
 * off. Both ways between kinks are sines, so the reference is a closed form. A kink leaves no order to the steps, and one run
 * beside another may be off alike. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "horizons.h"
#include "host/cli/commands.h"
#include "linear.h"
#include "unity.h"

void suite_trust_kinks(void);

#define TURN 6.28318530717958648

/* A mass of 1 kg. */
typedef struct two_springs {
    double soft; /* N/m */
    double hard; /* N/m more, beyond gap */
    double gap_m;
    double x_m;
    double v_mps;
} two_springs;

static void go_on(two_springs *s, double span_s) {
    while (span_s > 0.0) {
        const bool beyond = s->x_m > s->gap_m || (s->x_m == s->gap_m && s->v_mps > 0.0);
        const double w = sqrt(beyond ? s->soft + s->hard : s->soft);
        const double middle = beyond ? s->hard * s->gap_m / (w * w) : 0.0;
        const double size = hypot(s->x_m - middle, s->v_mps / w);
        const double phase = atan2(-s->v_mps / w, s->x_m - middle);
        const double share = (s->gap_m - middle) / size;
        double wait_s = (double)INFINITY;
        if (fabs(share) < 1.0) {
            const double at = beyond ? acos(share) : -acos(share);
            const double turns = ceil((phase + 1e-9 - at) / TURN);
            wait_s = (at + turns * TURN - phase) / w;
        }
        const double part_s = fmin(wait_s, span_s);
        s->v_mps = -w * size * sin(phase + w * part_s);
        s->x_m = wait_s <= span_s ? s->gap_m : middle + size * cos(phase + w * part_s);
        span_s -= part_s;
    }
}

/* When x or x' of the records is first off by a thousandth of its range; infinity: never. */
static double right_until_s(const two_springs *start, const char *csv, double *most) {
    enum { ROWS_MOST = 400 };
    static double was[ROWS_MOST][3]; /* the time, x and x' */
    static double is[2][ROWS_MOST];
    two_springs s = *start;
    int n = 0;
    for (const char *row = csv; n < ROWS_MOST && (row = said_row(row, 3, was[n])) != NULL; n++) {
        go_on(&s, n == 0 ? 0.0 : was[n][0] - was[n - 1][0]);
        is[0][n] = s.x_m;
        is[1][n] = s.v_mps;
    }
    double first_s = (double)INFINITY;
    *most = 0.0;
    for (int c = 0; c < 2; c++) {
        double low = is[c][0];
        double high = is[c][0];
        for (int k = 0; k < n; k++) {
            low = fmin(low, is[c][k]);
            high = fmax(high, is[c][k]);
        }
        for (int k = 0; k < n; k++) {
            const double off = fabs(was[k][1 + c] - is[c][k]) / (high - low);
            *most = fmax(*most, off);
            first_s = off > 1e-3 ? fmin(first_s, was[k][0]) : first_s;
        }
    }
    return first_s;
}

static void test_trust_beside_a_kink(void) {
    static const char *const methods[] = {"rk4", "rk4", "rk38", "nystroem4", "nystroem5"};
    dice d = dice_of("trust beside a kink", 7103);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 15), 400));
    unsigned ended = 0;
    unsigned late = 0;
    for (unsigned i = 0; i < cases; i++) {
        static said what;
        char text[700];
        char every[40];
        const two_springs s = {.soft = pow(10.0, dice_between(&d, -0.5, 1.0)),
                               .hard = pow(10.0, dice_between(&d, 0.0, 2.0)),
                               .gap_m = dice_between(&d, -0.5, 0.8),
                               .x_m = dice_between(&d, -2.0, 2.0),
                               .v_mps = dice_between(&d, -1.0, 1.0)};
        const double step_s = pow(10.0, dice_between(&d, -1.4, -0.3)) / sqrt(s.soft + s.hard);
        const int between = 1 + (int)dice_one_of(&d, 4);
        const double end_s = step_s * between * 100;
        snprintf(
            text, sizeof text,
            "mechanism kink\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
            "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*max(x - %.17g [m], 0 [m])^2/2\n"
            "scene s { start x = %.17g [m]; start x' = %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
            s.soft, s.hard, s.gap_m, s.x_m, s.v_mps, step_s, end_s);
        snprintf(every, sizeof every, "%.17gs", step_s * between);
        const char *words[] = {model_keep(text),
                               "--csv",
                               "-",
                               "--every",
                               every,
                               "--method",
                               methods[i % 5],
                               "--number",
                               i / 5 % 2 == 0 ? "double" : "float",
                               NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        double most;
        const double truth_s = right_until_s(&s, what.out, &most);
        const char *line = strstr(what.err, "\ntrusted");
        TEST_ASSERT_NOT_NULL_MESSAGE(line, what.err);
        const char *at = strstr(line, "until t = ");
        const double told_s = at != NULL                           ? strtod(at + 10, NULL)
                              : strstr(line, "to the end") != NULL ? end_s
                                                                   : 0.0;
        TEST_ASSERT_FALSE_MESSAGE(told_s >= end_s && most > 3e-3, text);
        ended += truth_s < end_s ? 1U : 0U;
        late += told_s > 1.3 * fmin(truth_s, end_s) + step_s * between ? 1U : 0U;
    }
    model_drop();
    printf(
        "  %u bodies beside a kink: %u off before the end, %u trusted for 1.3 times as long or more\n",
        cases, ended, late);
    TEST_ASSERT_TRUE(ended > cases / 10);
    TEST_ASSERT_TRUE(late <= cases / 100);
}

/* --- runs by one matrix a step ---------------------------------------------------------------- */

/* Until when runs by one matrix a step can be trusted: drawn linear mechanisms. By the exact
 * matrix to the end, whatever the step; by what Runge-Kutta 4 makes of it until the reference says
 * so. */
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

void suite_trust_kinks(void) {
    RUN_TEST(test_trust_beside_a_kink);
    RUN_TEST(test_exact_steps_are_right_to_the_end);
    RUN_TEST(test_coarse_steps_until_the_reference_says_so);
}
