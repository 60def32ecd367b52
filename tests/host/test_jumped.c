/* test_jumped.c: steps that jump over a pole (host/run/jumped.h): of drawn equations and forces whose divisor the motion comes near
 * to and never reaches, told where the run got through and not where it stayed on its side; of places that only look like
 * poles, not told. What a run did is read from its last state alone. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "host/commands/commands.h"
#include "host/run/jumped.h"
#include "motion.h"
#include "unity.h"

void suite_jumped(void);

static dice die;

enum { TEXT = 1500 };

static said what;

/* `few`; all of them where WHIRL_FULL says so, and some of every class where WHIRL_FEW does. */
static unsigned cases_of(unsigned few, unsigned all, unsigned fewest) {
    return dice_cases(usual_or(few_or_all(few, all), fewest));
}

enum { WORDS = 6 };

/* `whirl run` in that number, with more options, which may be of another number. */
static void run(const char *text, const char *number, char *const more[static WORDS]) {
    const char *words[4 + WORDS] = {model_keep(text), "--number", number};
    const bool another = more[0] != NULL && strcmp(more[0], "--number") == 0;
    for (int i = 0; i < WORDS; i++) {
        words[(another ? 1 : 3) + i] = more[i];
    }
    command_say(command_run, words, &what);
    model_drop();
}

static char *no_more[WORDS];

/* The options that a warning names and has tried; false: none. */
static bool named(char text[static SAID_SIZE], char *words[static WORDS]) {
    static const char before[] = "no motion gets through there; ";
    char *at = strstr(what.err, before);
    char *end = at != NULL ? strstr(at, " stays on its side, and would do") : NULL;
    if (end == NULL) {
        return false;
    }
    *end = '\0';
    strcpy(text, at + strlen(before));
    char *next = text;
    for (int i = 0; i < WORDS; i++) {
        words[i] = strtok_r(next, " ", &next);
    }
    return true;
}

static bool is_told(void) { return strstr(what.err, "jumped over a place where") != NULL; }

/* Stepped to its end. */
static bool jumps(motion *m) {
    jumped *j = jumped_open(m->image);
    for (uint64_t step = 0; step <= m->image->steps; step++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, step == 0 ? WH_OK : motion_step(m, 1));
        jumped_enter(j, m->kind, m->run);
    }
    const bool some = jumped_some(j);
    jumped_close(j);
    return some;
}

/* The last value of a component, as the summary has it. */
static double last_of(const char *name) {
    char wanted[40];
    snprintf(wanted, sizeof wanted, "\n  %s ", name);
    const char *at = strstr(what.out, wanted);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what.err);
    return strtod(at + strlen(wanted), NULL);
}

/* How wide a bend is beside what a step goes: mostly jumped over, and mostly not. */
static double width(unsigned c) {
    return exp(c % 2 == 0 ? dice_between(&die, -(double)few_or_all(3, 6), -0.7)
                          : dice_between(&die, 0.5, 2.0));
}

/* --- poles ---------------------------------------------------------------------------------------------*/

/* What is used up at a rate that falls only where it has nearly gone: s' = -v s/(k + s), in words of several kinds, which
 * never falls below zero. Its pole is at -k, or behind. */
static const char *const knees[] = {
    "let d = k + s\nequation s' = -rate*v*s/d\n",
    "equation s' = -rate*v*s*(k + s)^(-1)\n",
    "equation s' = -rate*(v*k + v*s - v*k)/(2*k + 2*s)*2\n",
    "equation s' = -rate*v*s*sign(k + s)/(sqrt(abs(k + s))*sqrt(abs(k + s)))\n",
    "equation s' = -rate*v*s/(k/(k/(s + k)))\n",
    "equation s' = -rate*v*s^2/(k + s)^2\n",
    "equation s' = -rate*v*s/(k + s)/(1 + 0.001*cos(s))\n",
    "equation s' = -rate*v/(1 + k/s)\n", /* which changes its sign twice */
    "equation (k + s)*s' = -rate*v*s\n", /* which divides nowhere */
    /* even, and no power: which change no sign */
    "equation s' = -rate*v*s^2/(s^2 + 2*k*s + k^2)\n",
    "let c = 2*v\nequation s' = -rate*v*s^2/(2*c^2*(1 - cos((s + k)/c)))\n",
    "state p\nequation p' = -rate*p\nequation s' = -rate*v*s^2/((k + s)^2 + p^2)\n",
    "equation (k^2 + 2*k*s + s^2)*s' = -rate*v*s^2\n",
    "equation s' = -rate*v*s^3/(s^3 + 3*k*s^2 + 3*k^2*s + k^3)\n",
    /* two, at -k and -4 k, which may lie in one step */
    "equation s' = -rate*v*s^2/(4*k^2 + 5*k*s + s^2)\n",
};
enum { KNEES = sizeof knees / sizeof knees[0] };

/* How far its zero is from its pole, at least: of 1 - cos(x) no digits are left below 1e-7, and a pole is followed for 1e2 times
 * as far. */
static double apart(unsigned which, double v, double k) {
    return strstr(knees[which], "cos((") != NULL ? fmax(k, 1e-3 * v) : k;
}

static void knee_text(char text[TEXT], unsigned which, double v, double k, double s,
                      double step_s) {
    const double until_s = step_s * floor(1.5 * s / v / step_s);
    snprintf(text, TEXT,
             "mechanism knee \"used up\"\nstate s\nparameter v = %.17g\nparameter k = %.17g\n"
             "parameter rate = 1 [1/s]\n%sscene a {\nstart s = %.17g\nstep %.17g [s]\n"
             "until %.17g [s]\n}\n",
             v, k, knees[which], s, step_s, until_s);
}

static void test_knees(void) {
    unsigned told = 0;
    unsigned kept = 0;
    unsigned cured = 0;
    const unsigned cases = cases_of(KNEES, 6 * KNEES, KNEES / 2);
    for (unsigned c = 0; c < cases; c++) {
        char text[TEXT];
        const double v = exp(dice_between(&die, -1.0, 1.0));
        const double s = v * dice_between(&die, 3.0, 8.0);
        const double step_s = ldexp(1.0, -5 - (int)dice_one_of(&die, 4));
        const double k = apart(c % KNEES, v, v * step_s * width(c));
        knee_text(text, c % KNEES, v, k, s, step_s);
        const char *number = c % 3 == 0 ? "float" : "double";
        run(text, number, no_more);
        if (what.status != 0) { /* it left all bounds on the way, and says so */
            TEST_ASSERT_EQUAL_INT(1, what.status);
            continue;
        }
        const double end = last_of("s");
        const bool through = end < -k;
        TEST_ASSERT_EQUAL_INT_MESSAGE(through, is_told(), text);
        told += through ? 1U : 0U;
        kept += through ? 0U : 1U;
        if (!through) {
            continue;
        }
        TEST_ASSERT_NULL_MESSAGE(strstr(what.out, "to the end"), text);
        TEST_ASSERT_NOT_NULL(strstr(what.err, "the equation grows without bound: equation "));
        char cure[SAID_SIZE];
        char *words[WORDS];
        if (named(cure, words)) {
            run(text, number, words);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, text);
            TEST_ASSERT_TRUE(last_of("s") > -1e-9 * s);
            cured++;
        }
    }
    printf("  %u jumped, %u of them with a step that would do; %u stayed on their side\n", told,
           cured, kept);
    TEST_ASSERT_TRUE(6U * told > cases && 6U * kept > cases && 2U * cured > told);
}

/* Beside a run of the test's own: when the step began, which of the expressions, and all memory given back. */
static void test_when(void) {
    for (unsigned c = 0; c < dice_cases(few_or_all(2 * KNEES, 8 * KNEES)); c++) {
        char text[TEXT];
        const double v = dice_between(&die, 0.5, 2.0);
        const double step_s = ldexp(1.0, -5 - (int)dice_one_of(&die, 3));
        const double k = apart(c % KNEES, v, v * step_s * width(c / KNEES));
        double behind_s = -1.0;
        double begin_s = -1.0;
        motion m;
        knee_text(text, c % KNEES, v, k, v * dice_between(&die, 1.0, 3.0), step_s);
        motion_open_text(&m, text, (stepping){.kind = &engine_double, .method = WH_RK4});
        const long before = blocks_in_use();
        jumped *j = jumped_open(m.image);
        TEST_ASSERT_NOT_NULL(j);
        for (uint64_t step = 0; step <= m.image->steps && behind_s < 0.0; step++) {
            TEST_ASSERT_FALSE(jumped_some(j));
            TEST_ASSERT_EQUAL_INT(WH_OK, step == 0 ? WH_OK : motion_step(&m, 1));
            jumped_enter(j, m.kind, m.run);
            behind_s = motion_value(&m, "s") < -k ? (double)step * step_s : -1.0;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(behind_s >= 0.0, jumped_some(j), text);
        if (behind_s >= 0.0) {
            const blame_question *q = jumped_over(j, &begin_s);
            TEST_ASSERT_EQUAL_STRING("the equation", q->what);
            TEST_ASSERT_TRUE(fabs(begin_s + step_s - behind_s) < 1e-9);
        }
        jumped_close(j);
        TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
        motion_close(&m);
    }
}

/* Bends so narrow that half the step jumps over them as well, and the two runs may agree: behind that no run is trusted. */
static void test_trust(void) {
    for (unsigned c = 0; c < cases_of(KNEES, 8 * KNEES, 3); c++) {
        char text[TEXT];
        const double v = dice_between(&die, 0.5, 2.0);
        const double step_s = ldexp(1.0, -5 - (int)dice_one_of(&die, 3));
        const double k = v * step_s * exp(dice_between(&die, -12.0, -8.0));
        if (apart(c % KNEES, v, k) > k) {
            continue;
        }
        knee_text(text, c % KNEES, v, k, v * dice_between(&die, 1.0, 3.0), step_s);
        const char *const words[] = {model_keep(text), NULL};
        command_say(command_trust, words, &what);
        model_drop();
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        TEST_ASSERT_NULL_MESSAGE(strstr(what.out, "trusted to the end"), text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, "a step jumped over a place where"), text);
    }
}

/* A brake whose force vanishes with the rate: its energies balance wherever it goes. */
static void test_forces(void) {
    static const char *const forces[] = {"-B*x'/(v0 + x')", "-B*x'*(v0 + x')^(-1)",
                                         "-B*(1 - v0/(v0 + x'))"};
    unsigned told = 0;
    unsigned kept = 0;
    const unsigned cases = cases_of(9, 24, 6);
    for (unsigned c = 0; c < cases; c++) {
        char text[TEXT];
        const double force = dice_between(&die, 0.5, 2.0);
        const double step_s = ldexp(1.0, -6 - (int)dice_one_of(&die, 2));
        const double v0 = force * step_s * width(c);
        const double v = force * dice_between(&die, 3.0, 6.0);
        snprintf(text, sizeof text,
                 "mechanism brake \"a brake\"\ncoordinate x [m]\nparameter v0 = %.17g [m/s]\n"
                 "parameter B = %.17g [N]\nT = 1 [kg]*x'^2/2\nQ(x) = %s\nscene a {\n"
                 "start x' = %.17g [m/s]\nstep %.17g [s]\nuntil 8 [s]\n}\n",
                 v0, force, forces[c % 3], v, step_s);
        run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        const bool through = last_of("x'") < -v0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(through, is_told(), text);
        TEST_ASSERT_TRUE_MESSAGE(
            !through || strstr(what.err, "the force grows without bound: Q(x)") != NULL, what.err);
        told += through ? 1U : 0U;
        kept += through ? 0U : 1U;
    }
    printf("  %u forces jumped, %u stayed on their side\n", told, kept);
    TEST_ASSERT_TRUE(told > 0 && kept > 0 &&
                     (cases < 24 || (4U * told > cases && 4U * kept > cases)));
}

/* An angle that turns past where a cosine, or a tangent, is divided by, with a step that is never near: w is what it has
 * to turn with. */
static void test_angles(void) {
    static const char *const poles[] = {"1/cos(th - %.17g [rad])", "tan(th - %.17g [rad])",
                                        "1/tan(th - %.17g [rad])",
                                        "1/(2*sin(th/2 - %.17g [rad])*cos(th/2 - %.17g [rad]))"};
    for (unsigned c = 0; c < cases_of(4, 16, 2); c++) {
        char force[200];
        char text[TEXT];
        const double at = dice_between(&die, -3.0, 3.0);
        snprintf(force, sizeof force, poles[c % 4], at, at);
        snprintf(text, sizeof text,
                 "mechanism arm \"an arm\"\ncoordinate th [rad]\nT = 1 [kg*m^2]*th'^2/2\n"
                 "Q(th) = 1e-6 [N*m]*%s\nscene a {\nstart th' = %.17g [rad/s]\nstep 10 [ms]\n"
                 "until 1 [s]\n}\n",
                 force, dice_one_of(&die, 2) == 0 ? 7.3 : -7.3);
        motion m;
        motion_open_text(
            &m, text,
            (stepping){.kind = c % 2 == 0 ? &engine_float : &engine_double, .method = WH_RK4});
        TEST_ASSERT_TRUE_MESSAGE(jumps(&m),
                                 text); /* by itself: no step would do, which takes long to find */
        motion_close(&m);
    }
}

/* Among others, of any order and in any place: the one whose slope is divided by what it comes past is told. */
static void test_which_equation_is_told(void) {
    static const char *const others[] = {"equation p'' = -p*9 [1/s^2]\n",
                                         "equation q' = (1 + p*p)*rate\n"};
    static const char *const states[] = {"state s\n", "state p\n", "state q\n"};
    for (unsigned c = 0; c < cases_of(6, 24, 2); c++) {
        char text[TEXT];
        char knee[100];
        char coming[60];
        const unsigned turn = dice_one_of(&die, 3);
        const unsigned stands = dice_one_of(&die, 3);
        snprintf(knee, sizeof knee, "equation (%.17g + s)*s' = -rate*s\n",
                 dice_between(&die, 1e-4, 1e-3));
        snprintf(coming, sizeof coming, "start s = %.17g, p = 0.1\n", dice_between(&die, 1.0, 2.0));
        snprintf(text, sizeof text,
                 "mechanism knees \"one of three\"\nparameter rate = 1 [1/s]\n%s%s%s%s%s%s"
                 "scene a {\n%sstep 20 [ms]\nuntil 3 [s]\n}\n",
                 states[turn], states[(turn + 1) % 3], states[(turn + 2) % 3],
                 stands == 0 ? knee : others[0], stands == 1 ? knee : others[stands == 0 ? 0 : 1],
                 stands == 2 ? knee : others[1], coming);
        run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        if (last_of("s") > 0.0) { /* stages alone have seen it */
            continue;
        }
        const char *told = strstr(what.err, "grows without bound: ");
        TEST_ASSERT_NOT_NULL_MESSAGE(told, text);
        TEST_ASSERT_TRUE_MESSAGE(strncmp(strchr(told, ':') + 2, knee, strlen(knee) - 1) == 0,
                                 what.err);
    }
}

/* So far from the origin that the way has few digits: what grows and what has a limit. */
static void test_far_away(void) {
    static const char *const laws[] = {"1/(s - a)", "sin(s - a)/(s - a)", "(s - a)^(-2)",
                                       "(s^2 - a^2)/(s - a)"};
    for (unsigned c = 0; c < cases_of(12, 60, 4); c++) {
        char text[TEXT];
        const double far = exp(dice_between(&die, 3.0, 16.0));
        snprintf(
            text, sizeof text,
            "mechanism far \"far away\"\nstate s\nstate y\nparameter a = %.17g\n"
            "parameter rate = 1 [1/s]\nequation s' = %.17g*rate\nequation y' = 1e-30*rate*(%s)\n"
            "scene a {\nstart s = %.17g\nstep 10 [ms]\nuntil 2 [s]\n}\n",
            far, dice_between(&die, 0.8, 1.2), laws[c % 4], far - dice_between(&die, 0.5, 1.0));
        run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        TEST_ASSERT_EQUAL_INT_MESSAGE(c % 2 == 0, is_told(), text);
    }
}

/* --- no poles ------------------------------------------------------------------------------------------*/

/* Passed by s' = v, at s = a: of each there is a limit, or what may be integrated. */
static const char *const harmless[] = {
    "sin(s - a)/(s - a)",
    "(s^2 - a^2)/(s - a)",
    "(s - a)^2/(s - a)",
    "(1 - cos(s - a))/(s - a)^2",
    "tan(s - a + 1.5707963267948966)*cos(s - a + 1.5707963267948966)",
    "1/sqrt(abs(s - a))",
    "(s - a)/abs(s - a)",
    "(s - a)*cos(s)/(s - a)",
    "1/(1 + (s - a)^2)",
    "log(abs(s - a))",
    "1/max(s - a, 1e-3)",
    "abs(s - a)^(-0.8)",
    "1/tanh(s - a) - 1/(s - a)",
    "1/tanh((s - a)/0.1) - 0.1/(s - a)",
    "1/(exp(s - a) - 1) - 1/(s - a)", /* what rounding leaves grows */
    "(exp(s - a) - 1 - (s - a))/(s - a)^2",
    "1/(s - a + 1e-9/(s - a))", /* grows, and ends growing */
    /* whose divisor touches zero, or nearly */
    "(s - a)^2/(1 - cos(s - a))",
    "sin(s - a)^2/(s^2 - 2*a*s + a^2)",
    "1/sqrt(sqrt(s^2 - 2*a*s + a^2))",
    "1/(1 - cos(s - a))^0.4",
    "1/(1.0001 - cos(s - a))",
    "1/(s^2 - 2*a*s + a^2 + 1e-7)",
    "1/((s - a)^2 + y^2*1e-3 + 1e-6)",
    "(s - a)^3/(s^3 - 3*a*s^2 + 3*a^2*s - a^3)",
    "(3 - 4*cos(s - a) + cos(2*(s - a)))/(1 - cos(s - a))^2",
    "(s - a)/sqrt((s - a)^2 + 1e-12)", /* bounded, and what turns it is small */
    "1e-6/sqrt((s - a)^2 + 1e-12)",
    "1e-9/sqrt((s - a)^2 + 1e-18)",
};
enum { HARMLESS = sizeof harmless / sizeof harmless[0] };

static void test_what_has_limits(void) {
    for (unsigned c = 0; c < cases_of(HARMLESS, 3 * HARMLESS, HARMLESS / 2); c++) {
        char text[TEXT];
        snprintf(text, sizeof text,
                 "mechanism passes \"passes\"\nstate s\nstate y\nparameter a = %.17g\n"
                 "parameter rate = 1 [1/s]\nequation s' = %.17g*rate\n"
                 "equation y' = rate*(%s)\nscene a {\nstart s = %.17g\nstep 10 [ms]\n"
                 "until 3 [s]\n}\n",
                 dice_between(&die, -0.9, 0.9) + 1e-3, dice_between(&die, 0.8, 1.2),
                 harmless[c % HARMLESS], dice_between(&die, -1.1, -1.0));
        run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        TEST_ASSERT_FALSE_MESSAGE(is_told(), text);
    }
}

/* Losses that a body feels while another passes s = a: along the rate alone, so that one over a root, whose slope along s
 * grows faster than a pole, slows it down and no more. */
static void test_losses(void) {
    static const char *const laws[] = {
        "/sqrt(abs(s - a))", "/abs(s - a)",          "/(1 - cos(s - a))^0.25", "/(s - a)^2",
        "/abs(s - a)^0.7",   "/(s^2 - 2*a*s + a^2)", "*sqrt(abs(s - a))",      "/(1 - cos(s - a))"};
    enum { LAWS = sizeof laws / sizeof laws[0] };
    for (unsigned c = 0; c < cases_of(LAWS, 6 * LAWS, LAWS); c++) {
        char text[TEXT];
        snprintf(text, sizeof text,
                 "mechanism passes \"passes\"\ncoordinate s [rad]\ncoordinate w [rad]\n"
                 "parameter a = %.17g\nparameter J = 1 [kg*m^2]\nT = 1e6*J*s'^2/2 + J*w'^2/2\n"
                 "F = %.17g [1/s]*J*w'^2/2%s\nscene a {\n"
                 "start s = %.17g, s' = 1 [1/s], w' = 1 [1/s]\nstep 10 [ms]\nuntil 2 [s]\n}\n",
                 dice_between(&die, 0.2, 0.9), 1e-9 * dice_between(&die, 0.5, 1.0), laws[c % LAWS],
                 dice_between(&die, -0.5, 0.0));
        motion m;
        motion_open_text(&m, text, (stepping){.kind = &engine_double, .method = WH_RK4});
        TEST_ASSERT_EQUAL_INT_MESSAGE(c % 2 == 1, jumps(&m), text);
        motion_close(&m);
    }
}

/* An impact turns a rate past where it is divided by, without having been there. */
static void test_impacts(void) {
    static const char *const laws[] = {"v0/(x' + v0)", "v0/(x' - v0)",
                                       "tan(x'/v0 + 1)"}; /* of 2 and of 0, about */
    for (unsigned c = 0; c < cases_of(3, 12, 3); c++) {
        char text[TEXT];
        const double v = dice_between(&die, 1.0, 2.0);
        const double v0 =
            c % 3 == 2 ? v * dice_between(&die, 0.9, 1.1) : dice_between(&die, 0.01, 0.3);
        snprintf(text, sizeof text,
                 "mechanism ball \"a ball\"\ncoordinate x [m]\nparameter v0 = %.17g [m/s]\n"
                 "T = 1 [kg]*x'^2/2\nQ(x) = 1e-3 [N]*%s\nstop x >= 0 [m] restitution 1\n"
                 "stop x <= 1 [m] restitution 1\nscene a {\nstart x = 0.5 [m], x' = %.17g [m/s]\n"
                 "step 2 [ms]\nuntil 2 [s]\n}\n",
                 v0, laws[c % 3], v);
        run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        TEST_ASSERT_FALSE_MESSAGE(is_told(), text);
    }
}

/* Passed by a rate of its own, in steps with impacts of another body and without: the place of a pole, of a force, and of
 * what a friction presses with, and of its coefficient; and where that place is behind the end. */
static void test_places_at_events(void) {
    static const char *const laws[] = {
        "Q(x) = 1e-6 [N*m]/(x - %.17g [m])\n",
        "Q(x) = max(1e-6 [N*m]/(x - %.17g [m]), 0)\n", /* on one side only */
        "friction x static 0.1 kinetic 0.1 normal 1e-6 [N*m]/abs(x - %.17g [m])\n",
        "friction x static 0.1 kinetic 1e-6 [m]/abs(x - %.17g [m]) normal 0.1 [N]\n"};
    for (unsigned c = 0; c < cases_of(8, 48, 8); c++) {
        char law[150];
        char text[TEXT];
        const bool passes = c / 4 % 2 == 0;
        const double at = passes ? dice_between(&die, 0.1, 0.8) : dice_between(&die, 1.2, 2.0);
        snprintf(law, sizeof law, laws[c % 4], at);
        snprintf(text, sizeof text,
                 "mechanism two \"two\"\ncoordinate x [m]\ncoordinate y [m]\n"
                 "T = 1 [kg]*(x'^2 + y'^2)/2\nV = 9.81 [N]*y\n%sstop y >= 0 [m] restitution 1\n"
                 "scene a {\nstart x' = 1 [m/s], y = %.17g [m]\nstep 20 [ms]\nuntil 1 [s]\n}\n",
                 law, dice_between(&die, 2e-4, 1e-3));
        motion m;
        motion_open_text(&m, text, (stepping){.kind = &engine_double, .method = WH_RK4});
        TEST_ASSERT_EQUAL_INT_MESSAGE(passes, jumps(&m), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(motion_value(&m, "x") > at, passes, text);
        motion_close(&m);
    }
}

void suite_jumped(void) {
    die = dice_of("jumped", 51);
    RUN_TEST(test_knees);
    RUN_TEST(test_when);
    RUN_TEST(test_trust);
    RUN_TEST(test_forces);
    RUN_TEST(test_angles);
    RUN_TEST(test_which_equation_is_told);
    RUN_TEST(test_far_away);
    RUN_TEST(test_what_has_limits);
    RUN_TEST(test_losses);
    RUN_TEST(test_impacts);
    RUN_TEST(test_places_at_events);
}
