/* test_tiny_sizes.c: motions of nanometres and less, whose force is a difference of numbers near 1: sqrt(1 + 2*y/L) - 1. Double
 * keeps of y what is beyond 1e-16 of L; where that is too little, both runs beside each other have the same wrong slopes, and
 * may stand still alike. The force is as good as proportional to y, so the reference is its closed form. Whatever is trusted to
 * the end is right; what double has digits for is trusted. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"
#include "unity.h"

void suite_tiny_sizes(void);

/* Each has the slope 1/L at y = 0. */
static const char *const laws[] = {"sqrt(1 + 2*y/L) - 1",
                                   "exp(y/L) - 1",
                                   "1 - 1/(1 + y/L)",
                                   "log(1 + y/L)",
                                   "(1 + y/L)^3/3 - 1/3",
                                   "0.5 - cos(60 [deg] + y/L/sin(60 [deg]))",
                                   "sqrt((L + 2*y)^2/L^2)/2 - 1/2",
                                   "sqrt(1 + (1 + y/L)^2)*sqrt(2) - 2"};
enum { LAWS = sizeof laws / sizeof laws[0], RECORDS = 100 };

typedef struct tiny_case {
    const char *law;
    double length_m;
    double start_m;
    double swing_radps; /* of what is proportional */
    double damping;     /* of the critical */
    double step_s;
    double end_s;
} tiny_case;

static tiny_case draw(dice *d, unsigned i) {
    tiny_case c = {.law = laws[i % LAWS]};
    const double part = pow(10.0, dice_between(d, -17.5, -7.0)); /* of the length */
    c.start_m = pow(10.0, dice_between(d, -15.5, -7.5)) * (dice_one_of(d, 2) == 0 ? 1.0 : -1.0);
    c.length_m = fabs(c.start_m) / part;
    c.swing_radps = pow(10.0, dice_between(d, 0.0, 2.0));
    c.damping = dice_one_of(d, 2) == 0 ? 0.0 : dice_between(d, 0.001, 0.05);
    c.step_s = 0.01 / c.swing_radps;
    c.end_s = RECORDS * 10.0 * c.step_s;
    return c;
}

static void write(const tiny_case *c, char *text, size_t size) {
    snprintf(text, size,
             "mechanism tiny\nstate y [m]\nparameter L = %.17g [m]\nparameter w = %.17g [Hz]\n"
             "equation y'' = -2*%.17g*w*y' - w^2*L*(%s)\n"
             "scene s { start y = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             c->length_m, c->swing_radps, c->damping, c->law, c->start_m, c->step_s, c->end_s);
}

static double closed_form(const tiny_case *c, double time_s) {
    const double way = sqrt(1.0 - c->damping * c->damping);
    const double phase = c->swing_radps * way * time_s;
    return c->start_m * exp(-c->damping * c->swing_radps * time_s) *
           (cos(phase) + c->damping / way * sin(phase));
}

/* The most, of the size that it starts with. */
static double off_by(const tiny_case *c, const char *csv) {
    double most = 0.0;
    double value[2]; /* the time, and y */
    for (const char *row = csv; (row = said_row(row, 2, value)) != NULL;) {
        most = fmax(most, fabs(value[1] - closed_form(c, value[0])) / fabs(c->start_m));
    }
    return most;
}

static void hold(const char *number) {
    dice d = dice_of("tiny sizes", 4423);
    const unsigned cases = dice_cases(few_or_all(usual_or(120, 24), 600));
    unsigned wrong = 0;
    unsigned right = 0;
    unsigned untrusted = 0;
    for (unsigned i = 0; i < cases; i++) {
        const tiny_case c = draw(&d, i);
        char text[600];
        char every[40];
        write(&c, text, sizeof text);
        snprintf(every, sizeof every, "%.17gs", 10.0 * c.step_s);
        const char *words[] = {model_keep(text), "--number", number, "--csv", "-",
                               "--every",        every,      NULL};
        said what;
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const bool to_the_end = strstr(what.err, "to the end: every") != NULL;
        const double off = off_by(&c, what.out);
        TEST_ASSERT_FALSE_MESSAGE(off > 0.01 && to_the_end, text);
        const bool is_right = off < 1e-6;
        untrusted += is_right && !to_the_end ? 1U : 0U;
        wrong += off > 0.01 ? 1U : 0U;
        right += is_right ? 1U : 0U;
    }
    model_drop();
    printf(
        "  %s: of %u tiny swings %u wrong, none trusted to the end; %u right, %u of them not trusted\n",
        number, cases, wrong, right, untrusted);
    TEST_ASSERT_TRUE(wrong > cases / 8);
    TEST_ASSERT_EQUAL_UINT(0, untrusted);
}

static void test_in_float(void) { hold("float"); }
static void test_in_double(void) { hold("double"); }

/* A start is looked at: is it written as it is? Of parts of parts there are as many as two to the depth, drawn 40 to 90 deep;
 * whoever went through them all would not come back. */
static void test_starts_of_parts_of_parts(void) {
    static const char *const ways[] = {"%s%u = p%u*p%u\n", "%s%u = p%u/p%u\n",
                                       "%s%u = -p%u*p%u^2\n", "%s%u = p%u^2/-p%u\n"};
    dice d = dice_of("parts of parts", 9907);
    const unsigned cases = dice_cases(usual_or(40, 8));
    for (unsigned i = 0; i < cases; i++) {
        char text[4000];
        const char *kind = i % 2 == 0 ? "parameter p" : "let p";
        const unsigned depth = 40 + dice_one_of(&d, 50);
        int at = snprintf(text, sizeof text, "mechanism m\ncoordinate x [m]\n%s0 = 1\n", kind);
        for (unsigned k = 1; k < depth; k++) {
            const char *way = ways[dice_one_of(&d, sizeof ways / sizeof ways[0])];
            at += snprintf(text + at, sizeof text - (size_t)at, way, kind, k, k - 1, k - 1);
        }
        snprintf(text + at, sizeof text - (size_t)at,
                 "T = 1 [kg]*x'^2/2\nV = 1 [N/m]*x^2/2\n"
                 "scene s { start x = 1e-9 [m]*p%u\nstep 10 [ms]\nuntil 1 [s] }\n",
                 depth - 1);
        said what;
        command_say_model(command_run, text, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    }
}

void suite_tiny_sizes(void) {
    RUN_TEST(test_starts_of_parts_of_parts);
    RUN_TEST(test_in_float);
    RUN_TEST(test_in_double);
}
