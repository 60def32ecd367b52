/* test_unjumped.c: expressions that look like a pole, but have a limit or can be integrated, must not be reported
 * (host/check/pole.h), nor rates that an impact carries past a pole. A true pole must be reported. */
#include "jumps.h"
#include "test.h"

static dice die;

static char *no_more[JUMPS_WORDS];

/* s' = v passes s = a. Each form has a limit there, or can be integrated. */
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
    "1/(exp(s - a) - 1) - 1/(s - a)", /* its round-off grows near a */
    "(exp(s - a) - 1 - (s - a))/(s - a)^2",
    "1/(s - a + 1e-9/(s - a))", /* its slope grows up to the end */
    /* in these, the divisor touches zero, or nearly does */
    "(s - a)^2/(1 - cos(s - a))",
    "sin(s - a)^2/(s^2 - 2*a*s + a^2)",
    "1/sqrt(sqrt(s^2 - 2*a*s + a^2))",
    "1/(1 - cos(s - a))^0.4",
    "1/(1.0001 - cos(s - a))",
    "1/(s^2 - 2*a*s + a^2 + 1e-7)",
    "1/((s - a)^2 + y^2*1e-3 + 1e-6)",
    "(s - a)^3/(s^3 - 3*a*s^2 + 3*a^2*s - a^3)",
    "(3 - 4*cos(s - a) + cos(2*(s - a)))/(1 - cos(s - a))^2",
    "(s - a)/sqrt((s - a)^2 + 1e-12)", /* bounded, but with a narrow bend */
    "1e-6/sqrt((s - a)^2 + 1e-12)",
    "1e-9/sqrt((s - a)^2 + 1e-18)",
};
enum { HARMLESS = sizeof harmless / sizeof harmless[0] };

TEST(unjumped, expressions_with_limits) {
    for (unsigned c = 0; c < jumps_cases(HARMLESS, 3 * HARMLESS, HARMLESS / 2); c++) {
        char text[JUMPS_TEXT];
        snprintf(text, sizeof text,
                 "mechanism passes \"passes\"\nstate s\nstate y\nparameter a = %.17g\n"
                 "parameter rate = 1 [1/s]\nequation s' = %.17g*rate\n"
                 "equation y' = rate*(%s)\nscene a {\nstart s = %.17g\nstep 10 [ms]\n"
                 "until 3 [s]\n}\n",
                 dice_between(&die, -0.9, 0.9) + 1e-3, dice_between(&die, 0.8, 1.2),
                 harmless[c % HARMLESS], dice_between(&die, -1.1, -1.0));
        jumps_run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(jumps_said.err), jumps_said.status, jumps_said.err);
        TEST_ASSERT_FALSE_MESSAGE(jumps_told(), text);
    }
}

/* Losses of one body while another body passes s = a. laws[0], laws[2], ... can be integrated across a and only slow
 * the body down; laws[1], laws[3], ... are poles. */
TEST(unjumped, losses) {
    static const char *const laws[] = {
        "/sqrt(abs(s - a))", "/abs(s - a)",          "/(1 - cos(s - a))^0.25", "/(s - a)^2",
        "/abs(s - a)^0.7",   "/(s^2 - 2*a*s + a^2)", "*sqrt(abs(s - a))",      "/(1 - cos(s - a))"};
    enum { LAWS = sizeof laws / sizeof laws[0] };
    for (unsigned c = 0; c < jumps_cases(LAWS, 6 * LAWS, LAWS); c++) {
        char text[JUMPS_TEXT];
        snprintf(text, sizeof text,
                 "mechanism passes \"passes\"\ncoordinate s [rad]\ncoordinate w [rad]\n"
                 "parameter a = %.17g\nparameter J = 1 [kg*m^2]\nT = 1e6*J*s'^2/2 + J*w'^2/2\n"
                 "F = %.17g [1/s]*J*w'^2/2%s\nscene a {\n"
                 "start s = %.17g, s' = 1 [1/s], w' = 1 [1/s]\nstep 10 [ms]\nuntil 2 [s]\n}\n",
                 dice_between(&die, 0.2, 0.9), 1e-9 * dice_between(&die, 0.5, 1.0), laws[c % LAWS],
                 dice_between(&die, -0.5, 0.0));
        motion m;
        motion_open_text(&m, text, (stepping){.kind = &engine_double, .method = WH_RK4});
        TEST_ASSERT_EQUAL_INT_MESSAGE(c % 2 == 1, jumps_some(&m), text);
        motion_close(&m);
    }
}

/* An impact turns a rate to the other side of a zero of its divisor. The rate never is at the zero. */
TEST(unjumped, impacts) {
    static const char *const laws[] = {"v0/(x' + v0)", "v0/(x' - v0)",
                                       "tan(x'/v0 + 1)"}; /* jumps from about tan(2) to tan(0) */
    for (unsigned c = 0; c < jumps_cases(3, 12, 3); c++) {
        char text[JUMPS_TEXT];
        const double v = dice_between(&die, 1.0, 2.0);
        const double v0 =
            c % 3 == 2 ? v * dice_between(&die, 0.9, 1.1) : dice_between(&die, 0.01, 0.3);
        snprintf(text, sizeof text,
                 "mechanism ball \"a ball\"\ncoordinate x [m]\nparameter v0 = %.17g [m/s]\n"
                 "T = 1 [kg]*x'^2/2\nQ(x) = 1e-3 [N]*%s\nstop x >= 0 [m] restitution 1\n"
                 "stop x <= 1 [m] restitution 1\nscene a {\nstart x = 0.5 [m], x' = %.17g [m/s]\n"
                 "step 2 [ms]\nuntil 2 [s]\n}\n",
                 v0, laws[c % 3], v);
        jumps_run(text, "double", no_more);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(jumps_said.err), jumps_said.status, jumps_said.err);
        TEST_ASSERT_FALSE_MESSAGE(jumps_told(), text);
    }
}

/* A constant rate passes a pole of a force, of a friction's normal force or of its coefficient, in steps with and
 * without impacts of another body. Also poles after the end. */
TEST(unjumped, places_at_events) {
    static const char *const laws[] = {
        "Q(x) = 1e-6 [N*m]/(x - %.17g [m])\n",
        "Q(x) = max(1e-6 [N*m]/(x - %.17g [m]), 0)\n", /* a pole on one side only */
        "friction x static 0.1 kinetic 0.1 normal 1e-6 [N*m]/abs(x - %.17g [m])\n",
        "friction x static 0.1 kinetic 1e-6 [m]/abs(x - %.17g [m]) normal 0.1 [N]\n"};
    for (unsigned c = 0; c < jumps_cases(8, 48, 8); c++) {
        char law[150];
        char text[JUMPS_TEXT];
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
        TEST_ASSERT_EQUAL_INT_MESSAGE(passes, jumps_some(&m), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(motion_value(&m, "x") > at, passes, text);
        motion_close(&m);
    }
}

SUITE(unjumped) { die = dice_of("unjumped", 52); }
