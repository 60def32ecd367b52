/* test_cause_at_start.c: a run that its first steps throw away is told of the motion that was too fast where it started, not where
 * it was thrown: drag by a power of the speed and springs by a power of the way, in steps up to 1e3 times too coarse, to their
 * time constants and frequencies in closed form. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"

#include "unity.h"

void suite_cause_at_start(void);

static void test_causes_of_the_first_step(void) {
    dice d = dice_of("causes at the start", 20261201);
    const unsigned cases = dice_cases(few_or_all(usual_or(30, 15), 400));
    unsigned named = 0;
    for (unsigned i = 0; i < cases; i++) {
        const bool is_drag = i % 2 == 0;
        const unsigned power = 2U + dice_one_of(&d, is_drag ? 2 : 4); /* of the force, above 1 */
        const double mass_kg = pow(10.0, dice_between(&d, -2.0, 2.0));
        const double start = dice_between(&d, 0.2, 5.0); /* m, m/s */
        const double size = pow(10.0, dice_between(&d, -1.0, 5.0));
        /* the slope of a force size*s^power over the mass */
        const double slope = power * size * pow(start, power - 1.0) / mass_kg;
        const double rate = is_drag ? slope : sqrt(slope);
        const double coarse = pow(10.0, dice_between(&d, 0.7, 3.0));
        const double step_s = coarse / rate;
        char text[500];
        said what;
        if (is_drag) {
            snprintf(text, sizeof text,
                     "mechanism cause\ncoordinate x [m]\nT = %.17g [kg]*x'^2/2\n"
                     "F = %.17g [kg/s]*abs(x'/(1 [m/s]))^%u*1 [m^2/s^2]/%u\n"
                     "scene s { start x' = %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
                     mass_kg, size, power + 1U, power + 1U, start, step_s, 100.0 * step_s);
        } else {
            snprintf(text, sizeof text,
                     "mechanism cause\ncoordinate x [m]\nT = %.17g [kg]*x'^2/2\n"
                     "V = %.17g [J]*abs(x/(1 [m]))^%u/%u\n"
                     "scene s { start x = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
                     mass_kg, size, power + 1U, power + 1U, start, step_s, 100.0 * step_s);
        }
        const char *words[] = {model_keep(text), "--quiet", "--number",
                               i % 3 == 0 ? "float" : "double", NULL};
        command_say(command_run, words, &what);
        const char *about = strstr(what.err, "about t = 0 s: ");
        if (about == NULL || what.status == 0) {
            continue;
        }
        about += strlen("about t = 0 s: ");
        const char *constant = "a time constant of ";
        const bool is_time = strncmp(about, constant, strlen(constant)) == 0;
        const double is = strtod(is_time ? about + strlen(constant) : about, NULL);
        const double wanted = is_time ? 1.0 / rate : rate;
        TEST_ASSERT_TRUE_MESSAGE(is_time == is_drag, what.err);
        TEST_ASSERT_TRUE_MESSAGE(fabs(is / wanted - 1.0) < 0.02, what.err);
        named++;
    }
    model_drop();
    printf("  %u of %u thrown away in the first steps, their causes right to 2 %%\n", named, cases);
    TEST_ASSERT_TRUE(4 * named > 3 * cases);
}

void suite_cause_at_start(void) { RUN_TEST(test_causes_of_the_first_step); }
