/* test_belief.c: a run that cannot be believed says so, and one that can says nothing. Generated falls into a centre
 * of force and springs too stiff for their step on one side; fine mechanisms of all sizes on the other. */
#include "command.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/commands/commands.h"

#include "unity.h"

void suite_belief(void);

static const char warned[] = "whirl run: warning: this run cannot be believed";

/* The number behind "energy left over": the ratio; -1 without the line. */
static double ratio_told(const char *summary) {
    const char *at = strstr(summary, "energy left over ");
    return at != NULL ? strtod(at + strlen("energy left over "), NULL) : -1.0;
}

static void run(const char *text, bool is_float, const char *strict, said *what) {
    const char *words[] = {model_keep(text), "--number", is_float ? "float" : "double", strict,
                           NULL};
    command_say(command_run, words, what);
}

/* Not believed: said, and the exit status is 1 unless --strict=off. */
static void refuse(const char *text, bool is_float) {
    said what;
    run(text, is_float, "--strict=off", &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, text);
    TEST_ASSERT_TRUE_MESSAGE(strncmp(what.err, warned, strlen(warned)) == 0, text);
    TEST_ASSERT_NOT_NULL(strstr(what.err, "\nhint: "));
    TEST_ASSERT_TRUE_MESSAGE(ratio_told(what.out) > 1e-3, text);
    run(text, is_float, NULL, &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "whirl run: exit status 1 because of [energy]"),
                                 what.err);
}

/* Believed: silent. Returns the ratio. */
static double believe(const char *text, bool is_float) {
    said what;
    run(text, is_float, "--strict", &what);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, text);
    const double ratio = ratio_told(what.out);
    TEST_ASSERT_TRUE_MESSAGE(ratio >= 0.0 && ratio <= 1e-3, text);
    return ratio;
}

/* --- not to be believed --------------------------------------------------------------------------*/

/* Straight into the centre, or past it much nearer than a step goes. */
static void test_falls_through_a_centre_of_force(void) {
    static const char *const powers[] = {"0.5", "1", "2"};
    dice d = dice_of("falls", 4001);
    const unsigned cases = dice_cases(few_or_all(9, 30));
    for (unsigned i = 0; i < cases; i++) {
        const unsigned which = dice_one_of(&d, 3);
        const double power = strtod(powers[which], NULL);
        const double a = dice_between(&d, 0.0, 6.283);
        const double r = dice_between(&d, 0.3, 3.0);
        const double k = pow(10.0, dice_between(&d, -1.0, 1.0));
        const double m = pow(10.0, dice_between(&d, -12.0, 3.0));
        const double past = i % 2 == 0 ? 0.0 : pow(10.0, dice_between(&d, -6.0, -4.0));
        const double fall_s = pow(r, 1.0 + 0.5 * power) / sqrt(k);
        char text[800];
        snprintf(
            text, sizeof text,
            "mechanism fall\ncoordinate x [m]\ncoordinate y [m]\nT = %.9g [kg]*(x'^2 + y'^2)/2\n"
            "V = -%.9g [J]/(sqrt(x^2 + y^2)/1 [m])^%s\n"
            "scene s { start x = %.15g [m], y = %.15g [m], x' = %.15g [m/s], y' = %.15g [m/s]\n"
            "step %.9g [s]\nuntil %.9g [s] }\n",
            m, k * m, powers[which], r * cos(a), r * sin(a), -past * sin(a), past * cos(a),
            fall_s * pow(10.0, dice_between(&d, -4.0, -2.7)), fall_s * dice_between(&d, 3.0, 6.0));
        refuse(text, false);
    }
    model_drop();
}

/* Within its bound of stability, 2.83/omega, Runge-Kutta's step takes (omega h)^6/72 of a spring's energy: more than a
 * hundredth in all from 0.7/omega on, in these runs. */
static void coarse_spring(dice *d, char *text, size_t size, bool clock, bool stop) {
    const double m = pow(10.0, dice_between(d, -9.0, 3.0));
    const double omega = pow(10.0, dice_between(d, -1.0, 3.0));
    const double h = dice_between(d, 0.7, 2.7) / omega;
    const double amplitude = pow(10.0, dice_between(d, -4.0, 1.0));
    char clock_text[120] = "";
    char stop_text[120] = "";
    if (clock) { /* heavy, as docs/language.md has it for energies that name the time */
        snprintf(clock_text, sizeof clock_text, " + %.9g [J]*t'^2/2",
                 1e9 * m * omega * omega * amplitude * amplitude);
    }
    if (stop) {
        snprintf(stop_text, sizeof stop_text, "stop x >= -%.9g [m] restitution 1\n",
                 dice_between(d, 2.0, 3.0) * amplitude);
    }
    snprintf(
        text, size,
        "mechanism spring\ncoordinate x [m]\n%sT = %.9g [kg]*x'^2/2%s\nV = %.9g [N/m]*x^2/2\n%s"
        "scene s { start x = %.9g [m]%s\nstep %.9g [s]\nuntil %.9g [s] }\n",
        clock ? "coordinate t [s]\n" : "", m, clock_text, m * omega * omega, stop_text, amplitude,
        clock ? ", t' = 1" : "", h, 60.0 * h);
}

static void test_springs_too_stiff_for_their_step(void) {
    dice d = dice_of("coarse springs", 4002);
    const unsigned cases = dice_cases(few_or_all(12, 40));
    for (unsigned i = 0; i < cases; i++) {
        char text[800];
        coarse_spring(&d, text, sizeof text, i % 4 == 1, i % 4 == 2);
        refuse(text, i % 2 == 1);
    }
    model_drop();
}

/* A constant in V is no entry: it neither hides what is lost nor makes something of rounding. */
static void test_an_energy_that_is_high_hides_nothing(void) {
    char text[600];
    for (int fine = 0; fine < 2; fine++) {
        for (int k = 0; k < 2; k++) {
            snprintf(text, sizeof text,
                     "mechanism high\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                     "V = 100 [N/m]*x^2/2 + 1 [kg]*9.81 [m/s^2]*1e6 [m]\n"
                     "scene s { start x = 0.1 [m]\nstep %s\nuntil 10 [s] }\n",
                     fine != 0 ? "1 [ms]" : "0.1 [s]");
            if (fine != 0) {
                believe(text, k == 1);
            } else {
                refuse(text, k == 1);
            }
        }
    }
    model_drop();
}

/* --- to be believed ------------------------------------------------------------------------------*/

typedef enum fine_kind {
    SPRING,
    PENDULUM,
    THROWN,
    BOUNCING,
    RUBBING,
    DRIVEN,
    FREE,
    RESTING,
    HANGING,
    ROUND,
    FINE
} fine_kind;

static void fine_mechanism(dice *d, fine_kind kind, char *text, size_t size) {
    const double m = pow(10.0, dice_between(d, -9.0, 3.0));
    const double l = pow(10.0, dice_between(d, -2.0, 1.0));
    const double h = 0.01 * sqrt(l / 9.81) * dice_between(d, 0.3, 3.0);
    const double v = sqrt(9.81 * l) * dice_between(d, 0.3, 1.5);
    const double end = h * dice_between(d, 100.0, 3000.0);
    char law[400] = "";
    char start[120] = "";
    const char *more = kind == PENDULUM || kind == ROUND ? "coordinate th [rad]\n"
                       : kind == DRIVEN                  ? "coordinate phi [rad]\n"
                                                         : "";
    switch (kind) {
    case SPRING:
        snprintf(law, sizeof law, "\nV = %.9g [N/m]*x^2/2\nF = %.9g [N*s/m]*x'^2/2\n", m * 9.81 / l,
                 m * sqrt(9.81 / l) * dice_between(d, 0.0, 0.5));
        snprintf(start, sizeof start, "x = %.9g [m]", l);
        break;
    case PENDULUM:
        snprintf(law, sizeof law, " + %.9g [kg*m^2]*th'^2/2\nV = -%.9g [J]*cos(th)\n", m * l * l,
                 m * 9.81 * l);
        snprintf(start, sizeof start, "th = %.9g", dice_between(d, -3.0, 3.0));
        break;
    case THROWN:
        snprintf(law, sizeof law, "\nV = %.9g [N]*x\n", m * 9.81);
        snprintf(start, sizeof start, "x' = %.9g [m/s]", v);
        break;
    case BOUNCING:
        snprintf(law, sizeof law, "\nV = %.9g [N]*x\nstop x >= 0 restitution %.3f\n", m * 9.81,
                 dice_between(d, 0.0, 1.0));
        snprintf(start, sizeof start, "x = %.9g [m]", l);
        break;
    case RUBBING:
        snprintf(law, sizeof law,
                 "\nV = %.9g [N/m]*x^2/2\nfriction x static 0.3 kinetic 0.2 normal %.9g [N]\n",
                 m * 9.81 / l, m * 9.81);
        snprintf(start, sizeof start, "x = %.9g [m]", 3.0 * l);
        break;
    case DRIVEN:
        snprintf(law, sizeof law,
                 " + 1e-9 [kg*m^2]*phi'^2/2\nV = %.9g [N/m]*x^2/2\nQ(x) = %.9g [N]*sin(phi)\n",
                 m * 9.81 / l, m * 9.81 * dice_between(d, 0.1, 1.0));
        snprintf(start, sizeof start, "phi' = %.9g [rad/s]",
                 sqrt(9.81 / l) * dice_between(d, 0.2, 0.8));
        break;
    case FREE: /* not so far away that float has no digits for it */
        snprintf(start, sizeof start, "x = %.9g [m], x' = %.9g [m/s]", 5.0 * v * end, v);
        break;
    case RESTING: break;
    case HANGING: /* where it hangs, as well as a number says it */
        snprintf(law, sizeof law, "\nV = %.9g [N/m]*x^2/2 - %.9g [N]*x\n", m * 9.81 / l, m * 9.81);
        snprintf(start, sizeof start, "x = %.9g [m]", l);
        break;
    case ROUND: /* a sleeve on a rod that turns freely: kinetic energy only, and it moves between the two */
        snprintf(law, sizeof law, " + %.9g [kg*m^2]*th'^2/2 + %.9g [kg]*x^2*th'^2/2\n", m * l * l,
                 m);
        snprintf(start, sizeof start, "x = %.9g [m], th' = %.9g [rad/s]", 0.3 * l, sqrt(9.81 / l));
        break;
    case FINE: break;
    }
    snprintf(text, size,
             "mechanism fine\ncoordinate x [m]\n%sT = %.9g [kg]*x'^2/2%s\n"
             "scene s { %s%s\nstep %.9g [s]\nuntil %.9g [s] }\n",
             more, m, law, start[0] != '\0' ? "start " : "", start, h, end);
}

static void test_fine_mechanisms_say_nothing(void) {
    dice d = dice_of("fine mechanisms", 4003);
    const unsigned rounds = dice_cases(few_or_all(2, 8));
    double worst[2] = {0.0, 0.0};
    for (unsigned i = 0; i < rounds; i++) {
        for (fine_kind kind = SPRING; kind < FINE; kind++) {
            for (int k = 0; k < 2; k++) {
                char text[1000];
                fine_mechanism(&d, kind, text, sizeof text);
                worst[k] = fmax(worst[k], believe(text, k == 1));
            }
        }
    }
    model_drop();
    printf("  of %u fine runs the worst balances to %.1e in double, %.1e in float\n",
           2 * FINE * rounds, worst[0], worst[1]);
}

/* Every built-in scene at its own step, double and float. */
static void test_built_in_scenes_are_believed(void) {
    said list;
    said what;
    const char *none[] = {NULL};
    const char *given = getenv("WHIRL_UNTIL"); /* such as 60s: five times as long */
    const char *until = given != NULL ? given : "2s";
    unsigned scenes = 0;
    command_say(command_list, none, &list);
    char *rest = NULL;
    for (char *line = strtok_r(list.out, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        char name[80];
        if (sscanf(line, "scene %79s", name) != 1) {
            continue;
        }
        /* by turns in double and in float; both with all cases */
        for (unsigned k = few_or_all(scenes % 2, 0); k < few_or_all(scenes % 2 + 1, 2); k++) {
            const char *words[] = {name,      "--strict", "--number", k == 1 ? "float" : "double",
                                   "--until", until,      NULL};
            command_say(command_run, words, &what);
            if (strcmp(name, "ball_between") == 0) { /* too busy for its step (test_warnings.c) */
                TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "cannot be believed"), what.err);
            } else {
                TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, name);
            }
            TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, name);
        }
        scenes++;
    }
    TEST_ASSERT_TRUE(scenes > 40);
    printf("  %u scenes\n", scenes);
}

/* Two masses and springs with a stop, friction, a hold or a loss, all lengths times `length`, so that energies end
 * anywhere between 1 J and nothing; `stiffness` 1 [1/s^2] is fine, and much is too stiff for the step. */
static void tiny_mechanism(dice *d, double length, double stiffness, char *text, size_t size) {
    static const char *const contacts[] = {
        "stop x >= -0.5*a restitution 0.5\n",
        "friction x static 0.3 kinetic 0.2 normal m*a*9 [1/s^2]\n", "hold y while x < -0.3*a\n",
        "stop y <= 0.2*a restitution 0\nfriction y static 0.3 kinetic 0.1 normal m*a*4 [1/s^2]\n"};
    const char *contact = contacts[dice_one_of(d, sizeof contacts / sizeof contacts[0])];
    snprintf(text, size,
             "mechanism tiny\ncoordinate x [m]\ncoordinate y [m]\nparameter a = %.6e [m]\n"
             "parameter m = %.6e [kg]\nT = m*x'^2/2 + m*y'^2/2\n"
             "V = m*%.6e [1/s^2]*(x^2/2 + %.3f*(y - x)^2/2) + m*%.3f [1/s^2]*a*x\n"
             "F = %.3f [1/s]*m*x'^2/2\n%sscene s { start x = a\nstep 10 [ms]\nuntil 20 [s] }\n",
             length, dice_between(d, 0.1, 10.0), stiffness, dice_between(d, 0.5, 2.0),
             dice_between(d, 0.0, 2.0), dice_one_of(d, 2) * dice_between(d, 0.05, 0.2), contact);
}

/* A run with contacts keeps its books in its own number: where entries are too small for float, that is no fault of the
 * step; where they are not, a step that is too coarse is one all the same. */
static void test_energies_that_are_small_for_float(void) {
    dice d = dice_of("tiny", 3417);
    char text[800];
    const unsigned rounds = dice_cases(few_or_all(8, 60));
    for (unsigned i = 0; i < rounds; i++) {
        tiny_mechanism(&d, pow(10.0, dice_between(&d, -37.0, 1.0)), 1.0, text, sizeof text);
        believe(text, true);
        tiny_mechanism(&d, pow(10.0, dice_between(&d, -14.0, 1.0)), 8e3, text, sizeof text);
        refuse(text, true);
    }
    model_drop();
}

static void test_the_limit_of_strict(void) {
    static const char text[] =
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 100 [N/m]*x^2/2\n"
        "scene s { start x = 1 [m]\nstep 10 [ms]\nuntil 1 [s] }\n";
    static const char *const wrong[] = {"--strict=",     "--strict=x", "--strict=0",
                                        "--strict=-1",   "--strict=2", "--strict=nan",
                                        "--strict=1e-3s"};
    said what;
    run(text, false, "--strict", &what);
    TEST_ASSERT_EQUAL_INT(0, what.status);
    const double ratio = ratio_told(what.out);
    TEST_ASSERT_TRUE(ratio > 1e-7 && ratio < 1e-4); /* (omega h)^6/72 a step: 1.4e-8, times 100 */
    char limit[40];
    snprintf(limit, sizeof limit, "--strict=%.3e", 0.9 * ratio);
    run(text, false, limit, &what);
    TEST_ASSERT_EQUAL_INT(1, what.status);
    snprintf(limit, sizeof limit, "--strict=%.3e", 1.1 * ratio);
    run(text, false, limit, &what);
    TEST_ASSERT_EQUAL_INT(0, what.status);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        run(text, false, wrong[i], &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, what.status, wrong[i]);
    }
    model_drop();
}

void suite_belief(void) {
    RUN_TEST(test_falls_through_a_centre_of_force);
    RUN_TEST(test_springs_too_stiff_for_their_step);
    RUN_TEST(test_an_energy_that_is_high_hides_nothing);
    RUN_TEST(test_fine_mechanisms_say_nothing);
    RUN_TEST(test_built_in_scenes_are_believed);
    RUN_TEST(test_energies_that_are_small_for_float);
    RUN_TEST(test_the_limit_of_strict);
}
