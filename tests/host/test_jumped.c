/* test_jumped.c: steps that jump over a pole (host/check/pole.h). The divisors of these equations and forces come
 * near zero, but the true motion never reaches zero. A warning must appear if the run has crossed the pole, which
 * its last state shows, and only then. test_unjumped.c tests for false alarms. */
#include "blocks.h"
#include "host/check/pole.h"
#include "host/cli/commands.h"
#include "jumps.h"
#include "test.h"

static dice die;

static char *no_more[JUMPS_WORDS];

static double last_of(const char *name) {
    char wanted[40];
    snprintf(wanted, sizeof wanted, "\n  %s ", name);
    const char *at = strstr(jumps_said.out, wanted);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, jumps_said.err);
    return strtod(at + strlen(wanted), NULL);
}

/* Width of the bend near the pole, in steps. Steps jump over most of the narrow bends and over few of the wide ones. */
static double width(unsigned c) {
    return exp(c % 2 == 0 ? dice_between(&die, -(double)few_or_all(3, 6), -0.7)
                          : dice_between(&die, 0.5, 2.0));
}

/* Michaelis-Menten decay in several forms: s' = -v s/(k + s) never falls below zero. The pole is at -k or below. */
static const char *const knees[] = {
    "let d = k + s\nequation s' = -rate*v*s/d\n",
    "equation s' = -rate*v*s*(k + s)^(-1)\n",
    "equation s' = -rate*(v*k + v*s - v*k)/(2*k + 2*s)*2\n",
    "equation s' = -rate*v*s*sign(k + s)/(sqrt(abs(k + s))*sqrt(abs(k + s)))\n",
    "equation s' = -rate*v*s/(k/(k/(s + k)))\n",
    "equation s' = -rate*v*s^2/(k + s)^2\n",
    "equation s' = -rate*v*s/(k + s)/(1 + 0.001*cos(s))\n",
    "equation s' = -rate*v/(1 + k/s)\n", /* the denominator changes its sign twice */
    "equation (k + s)*s' = -rate*v*s\n", /* without a division */
    /* the denominator is (s + k)^2 and does not change its sign */
    "equation s' = -rate*v*s^2/(s^2 + 2*k*s + k^2)\n",
    "let c = 2*v\nequation s' = -rate*v*s^2/(2*c^2*(1 - cos((s + k)/c)))\n",
    "state p\nequation p' = -rate*p\nequation s' = -rate*v*s^2/((k + s)^2 + p^2)\n",
    "equation (k^2 + 2*k*s + s^2)*s' = -rate*v*s^2\n",
    "equation s' = -rate*v*s^3/(s^3 + 3*k*s^2 + 3*k^2*s + k^3)\n",
    /* two poles, -k and -4 k, perhaps in one step */
    "equation s' = -rate*v*s^2/(4*k^2 + 5*k*s + s^2)\n",
};
enum { KNEES = sizeof knees / sizeof knees[0] };

/* Least distance of the pole from zero. It is larger with 1 - cos(x), which has few digits for small x. */
static double apart(unsigned which, double v, double k) {
    return strstr(knees[which], "cos((") != NULL ? fmax(k, 1e-3 * v) : k;
}

static void knee_text(char text[JUMPS_TEXT], unsigned which, double v, double k, double s,
                      double step_s) {
    const double until_s = step_s * floor(1.5 * s / v / step_s);
    snprintf(text, JUMPS_TEXT,
             "mechanism knee \"used up\"\nstate s\nparameter v = %.17g\nparameter k = %.17g\n"
             "parameter rate = 1 [1/s]\n%sscene a {\nstart s = %.17g\nstep %.17g [s]\n"
             "until %.17g [s]\n}\n",
             v, k, knees[which], s, step_s, until_s);
}

TEST(jumped, knees) {
    unsigned told = 0;
    unsigned kept = 0;
    unsigned cured = 0;
    const unsigned cases = jumps_cases(KNEES, 6 * KNEES, KNEES / 2);
    for (unsigned c = 0; c < cases; c++) {
        char text[JUMPS_TEXT];
        const double v = exp(dice_between(&die, -1.0, 1.0));
        const double s = v * dice_between(&die, 3.0, 8.0);
        const double step_s = ldexp(1.0, -5 - (int)dice_one_of(&die, 4));
        const double k = apart(c % KNEES, v, v * step_s * width(c));
        knee_text(text, c % KNEES, v, k, s, step_s);
        const char *number = c % 3 == 0 ? "float" : "double";
        jumps_run(text, number, no_more);
        /* the run has ended early, as unbounded */
        if (jumps_said.status != said_owes(jumps_said.err)) {
            TEST_ASSERT_EQUAL_INT(1, jumps_said.status);
            continue;
        }
        const double end = last_of("s");
        const bool through = end < -k;
        TEST_ASSERT_EQUAL_INT_MESSAGE(through, jumps_told(), text);
        told += through ? 1U : 0U;
        kept += through ? 0U : 1U;
        if (!through) {
            continue;
        }
        TEST_ASSERT_NULL_MESSAGE(strstr(jumps_said.out, "to the end"), text);
        TEST_ASSERT_NOT_NULL(strstr(jumps_said.err, "the equation grows without bound: equation "));
        char cure[SAID_SIZE];
        char *words[JUMPS_WORDS];
        if (jumps_named(cure, words)) {
            jumps_run(text, number, words);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", jumps_said.err, text);
            TEST_ASSERT_TRUE(last_of("s") > -1e-9 * s);
            cured++;
        }
    }
    TEST_ASSERT_TRUE(6U * told > cases && 6U * kept > cases && 2U * cured > told);
}

/* The report must have the step and the expression of the test's own run, and no memory may leak. */
TEST(jumped, when) {
    for (unsigned c = 0; c < dice_cases(few_or_all(2 * KNEES, 8 * KNEES)); c++) {
        char text[JUMPS_TEXT];
        const double v = dice_between(&die, 0.5, 2.0);
        const double step_s = ldexp(1.0, -5 - (int)dice_one_of(&die, 3));
        const double k = apart(c % KNEES, v, v * step_s * width(c / KNEES));
        double behind_s = -1.0;
        motion m;
        knee_text(text, c % KNEES, v, k, v * dice_between(&die, 1.0, 3.0), step_s);
        motion_open_text(&m, text, (stepping){.kind = &engine_double, .method = WH_RK4});
        const long before = blocks_in_use();
        pole_crossing *j = pole_crossing_open(m.image);
        TEST_ASSERT_NOT_NULL(j);
        for (uint64_t step = 0; step <= m.image->steps && behind_s < 0.0; step++) {
            TEST_ASSERT_FALSE(pole_crossing_some(j));
            TEST_ASSERT_EQUAL_INT(WH_OK, step == 0 ? WH_OK : motion_step(&m, 1));
            pole_crossing_enter(j, m.kind, m.run);
            behind_s = motion_value(&m, "s") < -k ? (double)step * step_s : -1.0;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(behind_s >= 0.0, pole_crossing_some(j), text);
        if (behind_s >= 0.0) {
            TEST_ASSERT_EQUAL_STRING("the equation", pole_crossing_over(j)->what);
            TEST_ASSERT_TRUE(fabs(pole_crossing_begin_s(j) + step_s - behind_s) < 1e-9);
        }
        pole_crossing_close(j);
        TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
        motion_close(&m);
    }
}

/* At such narrow bends, runs with half the step jump, too, and the two runs may agree. No result after the jump may
 * be trusted. */
TEST(jumped, trust) {
    for (unsigned c = 0; c < jumps_cases(KNEES, 8 * KNEES, 3); c++) {
        char text[JUMPS_TEXT];
        const double v = dice_between(&die, 0.5, 2.0);
        const double step_s = ldexp(1.0, -5 - (int)dice_one_of(&die, 3));
        const double k = v * step_s * exp(dice_between(&die, -12.0, -8.0));
        if (apart(c % KNEES, v, k) > k) {
            continue;
        }
        knee_text(text, c % KNEES, v, k, v * dice_between(&die, 1.0, 3.0), step_s);
        COMMAND_SAY(command_trust, &jumps_said, model_keep(text));
        model_drop();
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(jumps_said.err), jumps_said.status, jumps_said.err);
        TEST_ASSERT_NULL_MESSAGE(strstr(jumps_said.out, "trusted to the end"), text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(jumps_said.out, "jumped over a pole of an expression"),
                                     text);
    }
}

/* The force of this brake is zero at rest. Its energy balance is right on both sides of the pole and shows no jump. */
TEST(jumped, forces) {
    static const char *const forces[] = {"-B*x'/(v0 + x')", "-B*x'*(v0 + x')^(-1)",
                                         "-B*(1 - v0/(v0 + x'))"};
    unsigned told = 0;
    unsigned kept = 0;
    const unsigned cases = jumps_cases(9, 24, 6);
    for (unsigned c = 0; c < cases; c++) {
        char text[JUMPS_TEXT];
        const double force = dice_between(&die, 0.5, 2.0);
        const double step_s = ldexp(1.0, -6 - (int)dice_one_of(&die, 2));
        const double v0 = force * step_s * width(c);
        const double v = force * dice_between(&die, 3.0, 6.0);
        snprintf(text, sizeof text,
                 "mechanism brake \"a brake\"\ncoordinate x [m]\nparameter v0 = %.17g [m/s]\n"
                 "parameter B = %.17g [N]\nT = 1 [kg]*x'^2/2\nQ(x) = %s\nscene a {\n"
                 "start x' = %.17g [m/s]\nstep %.17g [s]\nuntil 8 [s]\n}\n",
                 v0, force, forces[c % 3], v, step_s);
        jumps_run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(jumps_said.err), jumps_said.status, jumps_said.err);
        const bool through = last_of("x'") < -v0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(through, jumps_told(), text);
        TEST_ASSERT_TRUE_MESSAGE(
            !through || strstr(jumps_said.err, "the force grows without bound: Q(x)") != NULL,
            jumps_said.err);
        told += through ? 1U : 0U;
        kept += through ? 0U : 1U;
    }
    printf("  %u forces jumped, %u stayed on their side\n", told, kept);
    TEST_ASSERT_TRUE(told > 0 && kept > 0 &&
                     (cases < 24 || (4U * told > cases && 4U * kept > cases)));
}

/* An angle passes a zero of a cosine or tangent in a denominator, and no step ends near that zero. w is the angle's
 * rate. */
TEST(jumped, angles) {
    static const char *const poles[] = {"1/cos(th - %.17g [rad])", "tan(th - %.17g [rad])",
                                        "1/tan(th - %.17g [rad])",
                                        "1/(2*sin(th/2 - %.17g [rad])*cos(th/2 - %.17g [rad]))"};
    for (unsigned c = 0; c < jumps_cases(4, 16, 2); c++) {
        char force[200];
        char text[JUMPS_TEXT];
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
        /* checks only that the run jumps, because the search for a better step takes long */
        TEST_ASSERT_TRUE_MESSAGE(jumps_some(&m), text);
        motion_close(&m);
    }
}

/* Among other equations in any sequence, the warning must name the equation whose denominator passes zero. */
TEST(jumped, right_equation_is_named) {
    static const char *const others[] = {"equation p'' = -p*9 [1/s^2]\n",
                                         "equation q' = (1 + p*p)*rate\n"};
    static const char *const states[] = {"state s\n", "state p\n", "state q\n"};
    for (unsigned c = 0; c < jumps_cases(6, 24, 2); c++) {
        char text[JUMPS_TEXT];
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
        jumps_run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(jumps_said.err), jumps_said.status, jumps_said.err);
        if (last_of("s") > 0.0) { /* a stage has crossed the pole, but the run has not */
            continue;
        }
        const char *told = strstr(jumps_said.err, "grows without bound: ");
        TEST_ASSERT_NOT_NULL_MESSAGE(told, text);
        TEST_ASSERT_TRUE_MESSAGE(strncmp(strchr(told, ':') + 2, knee, strlen(knee) - 1) == 0,
                                 jumps_said.err);
    }
}

/* Far from the origin, positions have few digits. The motion grows exponentially or saturates. */
TEST(jumped, far_away) {
    static const char *const laws[] = {"1/(s - a)", "sin(s - a)/(s - a)", "(s - a)^(-2)",
                                       "(s^2 - a^2)/(s - a)"};
    for (unsigned c = 0; c < jumps_cases(12, 60, 4); c++) {
        char text[JUMPS_TEXT];
        const double far = exp(dice_between(&die, 3.0, 16.0));
        snprintf(
            text, sizeof text,
            "mechanism far \"far away\"\nstate s\nstate y\nparameter a = %.17g\n"
            "parameter rate = 1 [1/s]\nequation s' = %.17g*rate\nequation y' = 1e-30*rate*(%s)\n"
            "scene a {\nstart s = %.17g\nstep 10 [ms]\nuntil 2 [s]\n}\n",
            far, dice_between(&die, 0.8, 1.2), laws[c % 4], far - dice_between(&die, 0.5, 1.0));
        jumps_run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(jumps_said.err), jumps_said.status, jumps_said.err);
        TEST_ASSERT_EQUAL_INT_MESSAGE(c % 2 == 0, jumps_told(), text);
    }
}

SUITE(jumped) { die = dice_of("jumped", 51); }
