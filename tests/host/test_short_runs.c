/* test_short_runs.c: runs of one to nine steps, of a body that a force, or a spring, pulls back, with a stop that it never comes to or
 * without: to closed form. An odd number of steps has no pair for the books' last step, and one step beside a contact has nothing
 * behind it: what is right is silent, what is wrong is not trusted. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"
#include "unity.h"

void suite_short_runs(void);

typedef struct short_run {
    double swing_radps;
    double start_m;
    double step_s;
    int steps;
    bool by_force; /* which does work; else a spring */
    bool stop;
    double beside_N; /* a body beside it falls so: its energy may be most of all */
} short_run;

static short_run draw(dice *d) {
    short_run r = {.start_m = pow(10.0, dice_between(d, -3.0, 1.0)),
                   .step_s = pow(10.0, dice_between(d, -4.0, -1.0)),
                   .steps = 1 + (int)(dice_one_of(d, 4) == 0 ? 0 : dice_one_of(d, 9)),
                   .by_force = dice_one_of(d, 3) > 0,
                   .stop = dice_one_of(d, 2) == 0};
    r.swing_radps = pow(10.0, dice_between(d, -2.5, 0.5)) / r.step_s;
    r.beside_N = dice_one_of(d, 2) == 0 ? 0.0 : 1e3 * r.swing_radps * r.swing_radps * r.start_m;
    return r;
}

static void write(const short_run *r, char *text, size_t size) {
    char stop[80] = "";
    char law[160];
    const double stiffness = r->swing_radps * r->swing_radps;
    snprintf(law, sizeof law,
             r->by_force ? "Q(x) = -%.17g [N/m]*x\nV = -%.17g [N]*z"
                         : "V = %.17g [N/m]*x^2/2 - %.17g [N]*z",
             stiffness, r->beside_N);
    if (r->stop) {
        snprintf(stop, sizeof stop, "stop x >= -%.17g [m] restitution 0.3\n", 1000.0 * r->start_m);
    }
    snprintf(text, size,
             "mechanism short\ncoordinate x [m]\ncoordinate z [m]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg]*z'^2/2\n%s\n%s"
             "scene s { start x = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             law, stop, r->start_m, r->step_s, r->steps * r->step_s);
}

/* The most, of the ranges that place and rate have. */
static double off_by(const short_run *r, const char *csv) {
    double off[2] = {0.0, 0.0};
    double low[2] = {r->start_m, 0.0};
    double high[2] = {r->start_m, 0.0};
    double value[5]; /* the time, both places, both rates */
    for (const char *row = csv; (row = said_row(row, 5, value)) != NULL;) {
        const double phase = r->swing_radps * value[0];
        const double is[2] = {r->start_m * cos(phase), -r->start_m * r->swing_radps * sin(phase)};
        for (int i = 0; i < 2; i++) {
            off[i] = fmax(off[i], fabs(value[1 + 2 * i] - is[i]));
            low[i] = fmin(low[i], is[i]);
            high[i] = fmax(high[i], is[i]);
        }
    }
    return fmax(off[0] / (high[0] - low[0]), off[1] / (high[1] - low[1]));
}

static void hold(const char *number) {
    dice d = dice_of("short runs", 4463);
    const unsigned cases = dice_cases(few_or_all(usual_or(200, 50), 1000));
    unsigned wrong = 0;
    unsigned right = 0;
    for (unsigned i = 0; i < cases; i++) {
        const short_run r = draw(&d);
        char text[600];
        said what;
        write(&r, text, sizeof text);
        const char *words[] = {model_keep(text), "--number", number, "--csv", "-", NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const double off = off_by(&r, what.out);
        const bool warns = strstr(what.err, "warning: ") != NULL;
        if (off > 0.03) {
            wrong++;
            TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "to the end: every"), text);
        } else if (off < 3e-4) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(warns, what.err);
        }
    }
    model_drop();
    printf("  %s: of %u short runs %u right, none warned of; %u off, none trusted to the end\n",
           number, cases, right, wrong);
    TEST_ASSERT_TRUE(right > cases / 3 && wrong > cases / 20);
}

static void test_in_float(void) { hold("float"); }
static void test_in_double(void) { hold("double"); }

void suite_short_runs(void) {
    RUN_TEST(test_in_float);
    RUN_TEST(test_in_double);
}
