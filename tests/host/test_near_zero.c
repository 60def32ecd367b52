/* test_near_zero.c: small differences must have full precision, also in float: powers of sums and of sines are not
 * expanded into large terms that cancel. */
#include "host/cli/commands.h"

#include "command.h"
#include "motion.h"

/* === suite near_zero ========================================================================== */

/* Number of roundings in an evaluation, of half a unit each: of constants, the distance, powers and the sum of the
 * factors. */
#define ROUNDINGS 16.0

static double worst_float;
static double worst_double;

static void show_worst(const char *what) {
    printf("  %s: largest relative error %.1e in float, %.1e in double\n", what, worst_float,
           worst_double);
    worst_float = worst_double = 0.0;
}

/* Relative error of an output at the start. `want` is the closed form for a start that is rounded to float. */
static double error_of(const motion *m, const char *output, double want) {
    const double error = fabs(motion_value(m, output) / want - 1.0);
    double *worst = m->kind == &engine_float ? &worst_float : &worst_double;
    *worst = fmax(*worst, error);
    return error;
}

static const char springs[] =
    "mechanism springs \"three that stiffen: against a wall, between two masses, along a law\"\n"
    "coordinate s [m]\n"
    "coordinate r [m]\n"
    "parameter b = 1 [m]\n"
    "parameter k = 1e6 [N/m^3]\n"
    "T = 1 [kg]*(s'^2 + r'^2)/2\n"
    "V = k*(s + b)^4/4 + k*(s - r - b)^3*(1 [m])/3\n"
    "output push = k*(s + b)^3\n"
    "output pull [N] = k*(s - r - b)^2*(1 [m])\n"
    "output left = s''\n"
    "output right = r''\n"
    "scene at { }\n";

TEST(near_zero, stiffening_springs_near_their_rest) {
    static const double distances[] = {0.25, 0.02, 1e-3, 3e-5};
    for (int number = 0; number < 2; number++) {
        const double half = number == 0 ? (double)FLT_EPSILON / 2.0 : DBL_EPSILON / 2.0;
        for (size_t i = 0; i < sizeof distances / sizeof distances[0]; i++) {
            const double s = (double)(float)(distances[i] - 1.0);
            const double stretch = s + 1.0; /* an exact sum */
            char start[64];
            motion m;
            stepping how = number == 0 ? IN_FLOAT : IN_DOUBLE;
            how.start = start;
            snprintf(start, sizeof start, "s = %.17g", s);
            motion_open_text(&m, springs, how);
            const double wall = 1e6 * stretch * stretch * stretch;
            /* r is 0, so the spring between the masses is stretched by s - 1 */
            const double between = 1e6 * (s - 1.0) * (s - 1.0);
            TEST_ASSERT_TRUE(error_of(&m, "push", wall) <= ROUNDINGS * half);
            TEST_ASSERT_TRUE(error_of(&m, "left", -wall - between) <= ROUNDINGS * half);
            motion_close(&m);
            /* starts so that s - r - b is near 0 */
            snprintf(start, sizeof start, "s = %.17g", (double)(float)(1.0 + distances[i]));
            motion_open_text(&m, springs, how);
            const double near = (double)(float)(1.0 + distances[i]) - 1.0; /* exact */
            TEST_ASSERT_TRUE(error_of(&m, "right", 1e6 * near * near) <= ROUNDINGS * half);
            motion_close(&m);
        }
    }
    show_worst("springs");
}

/* Number of roundings for the sixth power of a sine: the argument is rounded twice, the sine once. */
#define WAVE_ROUNDINGS 48.0

/* Two arms on one shaft. If they are in line with the shaft, the inertia has a pole of order four or six. */
static const char poles[] = "mechanism poles\n"
                            "coordinate th [rad]\n"
                            "coordinate ph [rad]\n"
                            "parameter J = 0.3 [kg*m^2]\n"
                            "T = J*(th'^2 + (%s(th)^%d*ph')^2)/2\n"
                            "Q(ph) = 1e-9 [N*m]\n"
                            "output tilt = th''\n"
                            "output spin = ph''\n"
                            "scene at { start th' = 0.01 [rad/s], ph' = 2 [rad/s] }\n";

/* The torque is (d/dt) of J w^(2n) ph', and J th'' = n J w^(2n-1) dw/dth ph'^2. */
static void check_pole(const char *wave, int n, double th, double w, double slope, stepping how) {
    char text[512];
    char start[64];
    snprintf(text, sizeof text, poles, wave, n);
    snprintf(start, sizeof start, "th = %.17g", th);
    how.start = start;
    motion m;
    motion_open_text(&m, text, how);
    const double half = how.kind == &engine_float ? (double)FLT_EPSILON / 2.0 : DBL_EPSILON / 2.0;
    /* error of the double sine near the angles of its table (tests/core/test_sine.c) */
    const double sine = how.kind == &engine_float ? 0.0 : 2.0 * n * 1.4e-16 / w;
    const double tilt = n * pow(w, 2 * n - 1) * slope * 4.0;
    const double spin = 1e-9 / (0.3 * pow(w, 2 * n)) - 2.0 * n * slope / w * 0.01 * 2.0;
    TEST_ASSERT_TRUE(error_of(&m, "tilt", tilt) <= WAVE_ROUNDINGS * half + sine);
    /* the two parts of `spin` cancel only little here */
    TEST_ASSERT_TRUE(error_of(&m, "spin", spin) <= 2.0 * (WAVE_ROUNDINGS * half + sine));
    motion_close(&m);
}

TEST(near_zero, powers_of_sines_near_their_poles) {
    for (int n = 2; n <= 3; n++) {
        for (int bits = 16; bits <= 28; bits += 4) {
            /* a multiple of 2^-32 turns, which is exact in float, too */
            const double off = ldexp(2.0 * acos(-1.0), bits - 32);
            check_pole("sin", n, off, sin(off), cos(off), IN_FLOAT);
            check_pole("sin", n, off, sin(off), cos(off), IN_DOUBLE);
            check_pole("cos", n, acos(0.0) - off, sin(off), -cos(off), IN_FLOAT);
        }
    }
    show_worst("poles");
}

/* === suite tiny_sizes ========================================================================= */
/* Motions of nanometres or less, with a force that is a difference near 1: sqrt(1 + 2*y/L) - 1. Double has no digits
 * of y below 1e-16 L. Then a run and its run with half the step have the same wrong slopes and may agree. The force
 * is nearly linear, so the reference is a closed form. A trusted run must be right, and a run with enough digits
 * must be trusted. */

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
    double swing_radps; /* natural frequency */
    double damping;     /* relative to critical damping */
    double step_s;
    double end_s;
} tiny_case;

static tiny_case draw(dice *d, unsigned i) {
    tiny_case c = {.law = laws[i % LAWS]};
    /* the start, divided by length_m */
    const double part = pow(10.0, dice_between(d, -17.5, -7.0));
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

static double off_by(const tiny_case *c, const char *csv) {
    double most = 0.0;
    double value[2]; /* time and y in a row */
    for (const char *row = csv; (row = said_row(row, 2, value)) != NULL;) {
        most = fmax(most, fabs(value[1] - closed_form(c, value[0])) / fabs(c->start_m));
    }
    return most;
}

static void hold(const char *number) {
    dice d = dice_of("tiny sizes", 4423);
    const unsigned cases = dice_cases(few_or_all(usual_or(120, 24), 600));
    unsigned wrong = 0;
    unsigned untrusted = 0;
    for (unsigned i = 0; i < cases; i++) {
        const tiny_case c = draw(&d, i);
        char text[600];
        char every[40];
        write(&c, text, sizeof text);
        snprintf(every, sizeof every, "%.17gs", 10.0 * c.step_s);
        said what;
        COMMAND_SAY(command_run, &what, model_keep(text), "--number", number, "--csv", "-",
                    "--every", every);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const bool to_the_end = strstr(what.err, "to the end: every") != NULL;
        const double off = off_by(&c, what.out);
        TEST_ASSERT_FALSE_MESSAGE(off > 0.01 && to_the_end, text);
        const bool is_right = off < 1e-6;
        untrusted += is_right && !to_the_end ? 1U : 0U;
        wrong += off > 0.01 ? 1U : 0U;
    }
    model_drop();
    TEST_ASSERT_TRUE(wrong > cases / 8);
    TEST_ASSERT_EQUAL_UINT(0, untrusted);
}

TEST(tiny_sizes, in_float) { hold("float"); }
TEST(tiny_sizes, in_double) { hold("double"); }

/* The form of a start is checked. With parts nested 40 to 90 deep, the check must visit each part once; else the
 * number of visits would be two to the power of the depth. */
TEST(tiny_sizes, starts_of_parts_of_parts) {
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
