/* test_swings.c: swings of systems that are not linear: what `whirl run` warns of, against what is kept exactly: predator and
 * prey, whose H = u - ln u + v - ln v stays, in any method, step and number. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"
#include "motion.h"
#include "unity.h"

void suite_swings(void);

/* More of the swing's energy (H - 2, at a = b = 1) than this is warned of; less than that is not, where u and v are right to
 * so much of their range. */
#define TOLD 0.03
#define SILENT 1e-3
#define RIGHT 4e-3

typedef struct prey {
    double a; /* 1/s */
    double b;
    double u; /* at the start; v starts at 1 */
    double step_ms;
    wh_method method;
    const engine_kind *kind;
} prey;

static prey drawn(dice *d) {
    static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4, WH_NYSTROEM5};
    const prey p = {.a = dice_between(d, 0.5, 2.0),
                    .b = dice_between(d, 0.5, 2.0),
                    .u = dice_between(d, 1.3, 3.0),
                    .method = methods[dice_one_of(d, 4)],
                    .kind = dice_one_of(d, 4) == 0 ? &engine_float : &engine_double};
    return p;
}

static double kept(const prey *p, double u, double v) {
    return p->b * (u - 1.0 - log(u)) + p->a * (v - 1.0 - log(v));
}

/* The part of its energy that the run loses or gains, and by how much of u's and v's ranges it is off, at most, the same in
 * twentieths of the step by the method of order 5 and in double. NAN: the run fails. */
static double lost_of(const prey *p, const char *text, double *off) {
    enum { PARTS = 20 };
    motion m;
    motion fine;
    motion_open_text(&m, text, (stepping){.kind = p->kind, .method = p->method});
    motion_open_text(&fine, text,
                     (stepping){.kind = &engine_double,
                                .method = WH_NYSTROEM5,
                                .step_s = p->step_ms * 1e-3 / PARTS});
    static const char *const names[] = {"u", "v"};
    double low[] = {p->u, 1.0};
    double high[] = {p->u, 1.0};
    double apart[] = {0.0, 0.0};
    bool ran = true;
    for (uint64_t k = 0; k < m.image->steps && ran; k++) {
        ran = motion_step(&m, 1) == WH_OK;
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&fine, PARTS));
        for (int i = 0; i < 2; i++) {
            const double right = motion_value(&fine, names[i]);
            low[i] = fmin(low[i], right);
            high[i] = fmax(high[i], right);
            apart[i] = fmax(apart[i], fabs(motion_value(&m, names[i]) - right));
        }
    }
    const double left = kept(p, motion_value(&m, "u"), motion_value(&m, "v"));
    motion_close(&m);
    motion_close(&fine);
    *off = fmax(apart[0] / (high[0] - low[0]), apart[1] / (high[1] - low[1]));
    return ran ? fabs(left / kept(p, p->u, 1.0) - 1.0) : (double)NAN;
}

static void test_predator_and_prey(void) {
    dice d = dice_of("swings", 14004);
    const unsigned cases = dice_cases(few_or_all(16, 100));
    unsigned told = 0;
    unsigned silent = 0;
    for (unsigned i = 0; i < cases; i++) {
        prey p = drawn(&d);
        const double coarse_ms = p.method == WH_EULER ? 10.0 : p.method == WH_HEUN ? 60.0 : 200.0;
        p.step_ms = floor(coarse_ms * pow(10.0, dice_between(&d, -1.0, 0.2))) + 1.0;
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism prey\nstate u\nstate v\nequation u' = %.17g [1/s]*u*(1 - v)\n"
                 "equation v' = %.17g [1/s]*v*(u - 1)\n"
                 "scene s { start u = %.17g, v = 1; step %.17g [ms]; until 40 [s] }\n",
                 p.a, p.b, p.u, p.step_ms);
        double off = 0.0;
        const double lost = lost_of(&p, text, &off);
        if (!(lost >= 0.0)) {
            continue; /* out of all bounds, which is told otherwise */
        }
        said what;
        const char *words[] = {model_keep(text),
                               "--method",
                               wh_methods[p.method].word,
                               "--number",
                               p.kind == &engine_float ? "float" : "double",
                               NULL};
        command_say(command_run, words, &what);
        char about[sizeof what.err + 600];
        snprintf(about, sizeof about, "%s, %s: H changes by %.3g; it says %s", text,
                 wh_methods[p.method].word, lost, what.err);
        const bool is_told = strstr(what.err, "[accuracy]") != NULL;
        if (lost > TOLD) {
            told++;
            TEST_ASSERT_TRUE_MESSAGE(is_told, about);
        } else if (lost < SILENT && off < RIGHT) {
            silent++;
            TEST_ASSERT_FALSE_MESSAGE(is_told, about);
        }
    }
    model_drop();
    printf("  %u runs: %u change H by more than %g, all told; %u by less than %g, none is\n", cases,
           told, TOLD, silent, SILENT);
    TEST_ASSERT_TRUE(told > cases / 8 && silent > cases / 8);
}

void suite_swings(void) { RUN_TEST(test_predator_and_prey); }
