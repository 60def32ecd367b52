/* test_verdict.c: `whirl sweep` says of a point what `whirl run` says of it alone: they ask one judge. Drawn springs,
 * dampers, swings of systems, flights past a pole and balls between stops, in steps from fine to useless, by all
 * methods; beside it, that the judge has said something of every kind, and nothing of many. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "unity.h"

void suite_verdict(void);

enum { TEXT = 1200, SHAPES = 5, SAID_KINDS = 4 };

/* What `whirl run` says of each kind, and what `whirl sweep` does. */
static const char *const run_says[SAID_KINDS] = {
    "this run cannot be believed", "these coordinates are singular: the inertia",
    "warning: the step is too coarse for", "moments with events, most of"};
static const char *const sweep_says[SAID_KINDS] = {
    "1 of 1 points cannot be believed", "1 of 1 points passed where their coordinates are singular",
    "1 of 1 points have a motion that the method takes or feeds",
    "1 of 1 points end elsewhere than in finer steps"};

static void draw(dice *d, unsigned shape, char text[TEXT]) {
    const double coarse = pow(10.0, dice_between(d, -2.0, 0.4));
    const double until = coarse * (10.0 + dice_one_of(d, 200));
    switch (shape) {
    case 0:
        snprintf(
            text, TEXT,
            "mechanism m\ncoordinate x [m]\nparameter p = 1\nT = 1 [kg]*x'^2/2\n"
            "V = 1 [N/m]*x^2/2\nscene s { start x = 1 [m]\nstep %.12g [s]\nuntil %.12g [s] }\n",
            coarse, until);
        break;
    case 1: /* the books' own rule is in doubt */
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\nparameter p = 1\nT = 1 [kg]*x'^2/2\n"
                 "F = 1 [N*s/m]*x'^2/2\n"
                 "scene s { start x' = 1 [m/s]\nstep %.12g [s]\nuntil %.12g [s] }\n",
                 coarse, until);
        break;
    case 2:
        snprintf(text, TEXT,
                 "mechanism m\nstate a [m]\nstate b [m/s]\nparameter p = 1\nequation a' = b\n"
                 "equation b' = -1 [1/s^2]*a\n"
                 "scene s { start a = 1 [m]\nstep %.12g [s]\nuntil %.12g [s] }\n",
                 coarse, until);
        break;
    case 3: { /* in the plane past the origin, in polar coordinates */
        const double past = pow(10.0, dice_between(d, -4.0, -0.5));
        const double r = sqrt(1.0 + past * past);
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate r [m]\ncoordinate phi [rad]\nparameter p = 1\n"
                 "T = 1 [kg]*(r'^2 + r^2*phi'^2)/2\n"
                 "scene s { start r = %.15g [m], phi = 0, r' = %.15g [m/s], phi' = %.15g [rad/s]\n"
                 "step 1 [ms]\nuntil 0.5 [s] }\n",
                 r, -4.0 / r, 4.0 * past / (r * r));
        break;
    }
    case 4: /* an elastic ball between stops */
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\nparameter p = 1\nT = 1 [kg]*x'^2/2\n"
                 "stop x >= 0 [m] restitution 1\nstop x <= 1 [mm] restitution 1\n"
                 "scene s { start x = 0.5 [mm], x' = %.12g [m/s]\nstep 1 [ms]\nuntil 50 [ms] }\n",
                 pow(10.0, dice_between(d, 0.0, 1.7)));
        break;
    }
}

static void test_a_point_is_judged_as_its_run(void) {
    static const char *const methods[] = {"rk4", "heun", "leapfrog", "semi-implicit-euler",
                                          "nystroem5"};
    dice d = dice_of("verdict", 15004);
    const unsigned cases = dice_cases(few_or_all(20, 120));
    unsigned of[SAID_KINDS + 1] = {0};
    for (unsigned i = 0; i < cases; i++) {
        char text[TEXT];
        char about[TEXT + 2 * SAID_SIZE + 100];
        said ran;
        said swept;
        bool silent = true;
        const unsigned shape = i % SHAPES;
        draw(&d, shape, text);
        const unsigned method = shape == 0 || shape == 2 ? dice_one_of(&d, shape == 0 ? 5 : 2) : 0;
        const char *file = model_keep(text);
        const char *number = dice_one_of(&d, 2) == 0 ? "double" : "float";
        const char *run[] = {file,       "--quiet", "--method", methods[method],
                             "--number", number,    NULL};
        const char *sweep[] = {file,       "--quiet", "--method", methods[method],
                               "--number", number,    "--over",   "p=1..1:1",
                               "--jobs",   "1",       NULL};
        command_say(command_run, run, &ran);
        command_say(command_sweep, sweep, &swept);
        snprintf(about, sizeof about, "%s--method %s --number %s\n%s\n%s", text, methods[method],
                 number, ran.err, swept.err);
        TEST_ASSERT_EQUAL_INT_MESSAGE(ran.status, swept.status, about);
        for (int k = 0; k < SAID_KINDS && ran.status == 0; k++) {
            const bool told = strstr(ran.err, run_says[k]) != NULL;
            TEST_ASSERT_EQUAL_INT_MESSAGE(told, strstr(swept.err, sweep_says[k]) != NULL, about);
            of[k] += told ? 1U : 0U;
            silent = silent && !told;
        }
        of[SAID_KINDS] += silent ? 1U : 0U;
    }
    model_drop();
    printf("  %u runs and points: %u of the energy, %u singular, %u swings, %u of contacts, %u "
           "silent\n",
           cases, of[0], of[1], of[2], of[3], of[4]);
    for (int k = 0; k <= SAID_KINDS; k++) {
        TEST_ASSERT_TRUE(of[k] > cases / 40);
    }
}

void suite_verdict(void) { RUN_TEST(test_a_point_is_judged_as_its_run); }
