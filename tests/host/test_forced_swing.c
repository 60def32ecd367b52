/* test_forced_swing.c: a body on a spring, with or without damping, that a clock's force swings 0.3 to 1.8 rad in each step:
 * fast for the rule by which the books integrate its power, and not for the method. The reference is the closed form. What is
 * right is not warned of, whatever the books' rule leaves over, and what is off is, or is not trusted. */
#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "unity.h"

void suite_forced_swing(void);

enum { RECORDS = 20 }; /* which divide the steps */

typedef struct forced_case {
    double swing_radps;
    double damping; /* of the critical */
    double force_N; /* on 1 kg */
    double clock_radps;
    double step_s;
    int steps;
} forced_case;

static const double start_m = 0.05;

static forced_case draw(dice *d) {
    static const int lengths[] = {40, 100, 400, 2000};
    static const double dampings[] = {0.0, 0.0, 0.01, 0.1};
    static const double steps_s[] = {1e-3, 5e-3, 0.02, 0.1, 1.0};
    forced_case c = {.step_s = steps_s[dice_one_of(d, 5)],
                     .damping = dampings[dice_one_of(d, 4)],
                     .steps = lengths[dice_one_of(d, 4)]};
    c.swing_radps = pow(10.0, dice_between(d, -2.5, -0.2)) / c.step_s;
    c.clock_radps = dice_between(d, 0.3, 1.8) / c.step_s;
    c.force_N = start_m * c.swing_radps * c.swing_radps * pow(10.0, dice_between(d, -3.0, 2.0));
    return c;
}

static void write(const forced_case *c, char *text, size_t size) {
    snprintf(text, size,
             "mechanism forced\ncoordinate x [m]\ncoordinate phi [rad]\n"
             "T = 1 [kg]*x'^2/2 + 1e-9 [kg*m^2]*phi'^2/2\nV = %.17g [N/m]*x^2/2\n"
             "F = %.17g [N*s/m]*x'^2/2\nQ(x) = %.17g [N]*sin(phi)\n"
             "scene s { start x = %.17g [m], phi' = %.17g [rad/s]\nstep %.17g [s]\n"
             "until %.15g [s] }\n",
             c->swing_radps * c->swing_radps, 2.0 * c->damping * c->swing_radps, c->force_N,
             start_m, c->clock_radps, c->step_s, c->steps * c->step_s);
}

/* Place and rate. */
static void closed_form(const forced_case *c, double time_s, double is[2]) {
    const double w = c->swing_radps;
    const double z = c->damping;
    const double complex forced =
        c->force_N / CMPLX(w * w - c->clock_radps * c->clock_radps, 2.0 * z * w * c->clock_radps);
    const double complex now =
        forced * CMPLX(cos(c->clock_radps * time_s), sin(c->clock_radps * time_s));
    const double way = w * sqrt(1.0 - z * z);
    const double a = start_m - cimag(forced);
    const double b = (z * w * a - c->clock_radps * creal(forced)) / way;
    const double left = exp(-z * w * time_s);
    const double cosine = cos(way * time_s);
    const double sine = sin(way * time_s);
    is[0] = cimag(now) + left * (a * cosine + b * sine);
    is[1] = c->clock_radps * creal(now) +
            left * (way * (b * cosine - a * sine) - z * w * (a * cosine + b * sine));
}

/* The most, of either's range. */
static double off_by(const forced_case *c, const char *csv) {
    double low[2] = {(double)INFINITY, (double)INFINITY};
    double high[2] = {-(double)INFINITY, -(double)INFINITY};
    double off[2] = {0.0, 0.0};
    for (const char *line = strchr(csv, '\n'); line != NULL && line[1] != '\0';
         line = strchr(line + 1, '\n')) {
        double time_s;
        double phi_rad;
        double run[2];
        if (sscanf(line, "%lf,%lf,%lf,%lf", &time_s, &run[0], &phi_rad, &run[1]) == 4) {
            double is[2];
            closed_form(c, time_s, is);
            for (int i = 0; i < 2; i++) {
                low[i] = fmin(low[i], is[i]);
                high[i] = fmax(high[i], is[i]);
                off[i] = fmax(off[i], fabs(run[i] - is[i]));
            }
        }
    }
    return fmax(off[0] / (high[0] - low[0]), off[1] / (high[1] - low[1]));
}

static void hold(const char *number, const char *method) {
    dice d = dice_of("forced swings", 4441);
    const unsigned cases = dice_cases(few_or_all(usual_or(100, 20), 600));
    unsigned wrong = 0;
    unsigned told = 0;
    unsigned right = 0;
    for (unsigned i = 0; i < cases; i++) {
        const forced_case c = draw(&d);
        char text[900];
        char every[40];
        write(&c, text, sizeof text);
        snprintf(every, sizeof every, "%.15gs", c.steps / RECORDS * c.step_s);
        const char *words[] = {model_keep(text), "--number", number,    "--method", method,
                               "--csv",          "-",        "--every", every,      NULL};
        said what;
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        const bool warns = strstr(what.err, "warning: ") != NULL;
        const bool to_the_end = strstr(what.err, "to the end: every") != NULL;
        const double off = off_by(&c, what.out);
        if (off < 5e-4) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(warns, what.err);
        } else if (off > 0.02) {
            wrong++;
            told += warns ? 1U : 0U;
            TEST_ASSERT_TRUE_MESSAGE(!to_the_end, text);
        }
    }
    model_drop();
    printf("  %s, %s: of %u forced swings %u right, none warned of; %u off, %u warned of, none "
           "trusted to the end\n",
           method, number, cases, right, wrong, told);
    TEST_ASSERT_TRUE(right > cases / 3 && (wrong > 0 || cases < 100 || strcmp(method, "rk4") != 0));
}

static void test_in_float(void) { hold("float", "rk4"); }
static void test_in_double(void) { hold("double", "rk4"); }
static void test_other_methods(void) {
    hold("double", "rk38");
    hold("double", "nystroem5");
}

void suite_forced_swing(void) {
    RUN_TEST(test_in_float);
    RUN_TEST(test_in_double);
    RUN_TEST(test_other_methods);
}
