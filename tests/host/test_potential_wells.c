/* test_potential_wells.c: a body in a potential well such as -log(1 - (x/l)^2), which the motion never leaves. A coarse step
 * leaves the well and meets the undefined potential. Then the run must fail, and name the expression and a remedy
 * that works. */
#include "command.h"
#include "host/cli/commands.h"
#include "named_cures.h"

/* Potentials with an energy E and a length l. Each confines a body whose energy is 0.9 E. */
static const char *const potentials[] = {
    "-E*log(1 - (x/l)^2)",
    "E/(1 - (x/l)^2)",
    "-E*sqrt(1 - (x/l)^2)",
    "E*tan(x/l)^2/2",
};
enum { POTENTIALS = sizeof potentials / sizeof potentials[0] };

static void draw(dice *d, unsigned i, char *text, size_t size) {
    const double length_m = pow(10.0, dice_between(d, -2.0, 1.0));
    const double energy_J = pow(10.0, dice_between(d, -2.0, 2.0));
    const double own_s = length_m / sqrt(2.0 * energy_J);
    const double step_s = own_s * pow(10.0, dice_between(d, -0.7, 0.6));
    const double part = dice_between(d, 0.1, 0.9);
    const double steps = 20.0 + dice_one_of(d, 400);
    snprintf(text, size,
             "mechanism walled\ncoordinate x [m]\nparameter l = %.17g [m]\n"
             "parameter E = %.17g [J]\nT = 1 [kg]*x'^2/2\nV = %s\n"
             "scene s { start x' = %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             length_m, energy_J, potentials[i % POTENTIALS], sqrt(2.0 * part * energy_J), step_s,
             steps * step_s);
}

TEST(potential_wells, failed_runs_name_a_cure) {
    dice d = dice_of("potential_wells", 4451);
    const unsigned cases = dice_cases(few_or_all(usual_or(120, 32), 600));
    unsigned failed = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[600];
        said what;
        draw(&d, i, text, sizeof text);
        const char *number = dice_one_of(&d, 2) == 0 ? "float" : "double";
        COMMAND_SAY(command_run, &what, model_keep(text), "--quiet", "--number", number);
        if (strstr(what.err, "is not a finite number") == NULL) {
            continue;
        }
        failed++;
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, what.err);
        named_cure list[NAMED_CURES];
        TEST_ASSERT_TRUE_MESSAGE(named_cures(what.err, list) > 0 && list[0].tried, what.err);
        const char *again[16] = {model_keep(text), "--quiet"};
        (void)named_words(&list[0], "rk4", number, again, 2);
        command_say(command_run, again, &what);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, text);
    }
    model_drop();
    TEST_ASSERT_TRUE(failed > cases / 16);
}

/* A slider-crank whose crank and rod have the same length. The run must end when both lie flat. Its message must not
 * suggest a step that would pass this position. */
TEST(potential_wells, flat_linkages_name_no_step) {
    dice d = dice_of("flat linkages", 4463);
    const unsigned cases = dice_cases(usual_or(24, 8));
    for (unsigned i = 0; i < cases; i++) {
        char text[900];
        said what;
        const double side_m = pow(10.0, dice_between(&d, -2.0, 0.5));
        const double at_rad = dice_between(&d, 0.2, 1.2);
        const double rate_radps = dice_between(&d, 0.5, 8.0);
        snprintf(
            text, sizeof text,
            "mechanism crank\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate s [m]\n"
            "parameter r = %.17g [m]\nparameter turn = %.17g\nparameter w = %.17g [rad/s]\n"
            "T = 1 [kg]*r^2*a'^2/2 + 0.1 [kg]*r^2*b'^2/2 + 1 [kg]*s'^2/2\n"
            "hold r*cos(a) + r*cos(b) - s while a > -1e3\nhold r*sin(a) + r*sin(b) while a > -1e3\n"
            "scene g { start a = turn; start a' = w; start b = -turn; start b' = -w\n"
            "start s = 2*r*cos(turn); start s' = -2*r*w*sin(turn); step %.17g [s]; until 9 [s] }\n",
            side_m, at_rad, rate_radps, dice_between(&d, 0.001, 0.1) / rate_radps);
        COMMAND_SAY(command_run, &what, model_keep(text), "--quiet", "--number",
                    dice_one_of(&d, 2) == 0 ? "float" : "double");
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, text);
        TEST_ASSERT_NOT_NULL_MESSAGE(
            strstr(what.err, "the holds allow more than one motion, because"), what.err);
        TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "--step"), what.err);
    }
    model_drop();
}
