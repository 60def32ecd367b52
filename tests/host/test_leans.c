/* test_leans.c: what a run is measured by (host/check/energy_residual.h) does not depend on what no motion depends on: where the origin
 * is, and which vector potential stands for a magnetic field, as terms of the kinetic energy that are linear in the rates. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"
#include "unity.h"

void suite_leans(void);

typedef struct charge {
    double mass_kg;
    double field_kgps;
    double speed_mps;
    double spring_Npm; /* to where it starts */
    const char *method;
    double step_s;
} charge;

/* B (x y' - y x')/2, B x y' or -B y x'. */
static const char *const potentials[] = {"B*(x*y' - y*x')/2", "B*x*y'", "-B*y*x'"};
enum { POTENTIALS = sizeof potentials / sizeof potentials[0] };

/* What it says is left over, of the largest entry, and whether it warned; all of it where it leaves all bounds. */
static double left_over(const charge *c, const char *potential, double x0, bool *warned) {
    char text[700];
    said what;
    snprintf(text, sizeof text,
             "mechanism charge\ncoordinate x [m]\ncoordinate y [m]\nparameter m = %.17g [kg]\n"
             "parameter B = %.17g [kg/s]\nparameter k = %.17g [N/m]\nparameter a = %.17g [m]\n"
             "T = m*(x'^2 + y'^2)/2 + %s\nV = k*((x - a)^2 + y^2)/2\n"
             "scene s { start x = %.17g [m], y' = %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             c->mass_kg, c->field_kgps, c->spring_Npm, x0, potential, x0, c->speed_mps, c->step_s,
             300.0 * c->step_s);
    const char *words[] = {model_keep(text), "--method", c->method, NULL};
    command_say(command_run, words, &what);
    if (what.status == 1 && strstr(what.err, "the run diverged") != NULL) {
        *warned = true;
        return 1.0;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    const char *at = strstr(what.out, "\nenergy left over ");
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what.out);
    *warned = strstr(what.err, "cannot be believed") != NULL;
    return strtod(at + strlen("\nenergy left over "), NULL);
}

static void test_origins_and_potentials(void) {
    static const char *const methods[] = {"nystroem5", "rk4", "heun", "semi-implicit-euler"};
    dice d = dice_of("leans", 61);
    unsigned told = 0;
    const unsigned runs = dice_cases(few_or_all(12, 60));
    for (unsigned k = 0; k < runs; k++) {
        charge c = {.mass_kg = dice_between(&d, 0.5, 2.0),
                    .field_kgps = dice_between(&d, 5.0, 40.0),
                    .speed_mps = dice_between(&d, 0.1, 1.0),
                    .method = methods[k % 4U]};
        c.spring_Npm = k % 3U == 0 ? dice_between(&d, 1.0, 50.0) : 0.0;
        c.step_s = dice_between(&d, 0.1, 0.6) * c.mass_kg / c.field_kgps;
        bool warned;
        const double by_itself = left_over(&c, potentials[0], 0.0, &warned);
        told += warned;
        for (int i = 0; i < POTENTIALS; i++) {
            bool too;
            const double far_m = pow(10.0, dice_between(&d, -1.0, 2.5));
            const double other = left_over(&c, potentials[i], far_m, &too);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-3 * by_itself + 1e-9, by_itself, other, c.method);
            TEST_ASSERT_EQUAL_MESSAGE(warned, too, c.method);
        }
    }
    model_drop();
    printf("  %u of %u charges told\n", told, runs);
    TEST_ASSERT_TRUE(told > 0 && told < runs);
}

void suite_leans(void) { RUN_TEST(test_origins_and_potentials); }
