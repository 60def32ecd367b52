/* test_matrix_runs.c: steps as one matrix in use: built-in linear scenes, a million steps, turn angles, systems of
 * first order, sweeps over the step, divergence, and refusals. */
#include "command.h"
#include "derived.h"
#include "host/cli/commands.h"
#include "linear.h"
#include "motion.h"

static stepping as_matrix(const engine_kind *kind, image_matrix_of matrix, bool compensated) {
    return (stepping){.kind = kind, .method = WH_RK4, .compensated = compensated, .matrix = matrix};
}

enum { MILLION = 1000000 };

/* Error after a million steps of an oscillator, and the largest on the way, relative to its amplitude. */
static double oscillator_off(const float x, const float v, const quad *truth, double omega) {
    return hypot((double)((quad)x - truth[0]), (double)((quad)v - truth[1]) / omega);
}

/* x + (Phi - 1) x compared with Phi x, every entry rounded once to float. */
TEST(matrix_runs, rounding_the_change_is_better) {
    static const double stiffness[] = {1.5, 39.5, 700.0};
    for (int k = 0; k < 3; k++) {
        static quad step[LINEAR_STATES][LINEAR_COLUMNS];
        char text[600];
        float phi[2][2];
        float x = 1.0F;
        float v = 0.0F;
        double angle[1];
        double real[3][2];
        linear of = {.coordinates = 1, .states = 2, .columns = 3, .h = (quad)1 / 1000};
        of.rate[0][1] = 1;
        of.rate[1][0] = (quad)-stiffness[k];
        linear_step(&of, 0, step);
        for (int i = 0; i < 4; i++) {
            phi[i / 2][i % 2] = (float)step[i / 2][i % 2];
        }
        for (int i = 0; i < MILLION; i++) {
            const float x_next = phi[0][0] * x + phi[0][1] * v;
            v = phi[1][0] * x + phi[1][1] * v;
            x = x_next;
        }
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate q [m]\nT = 1 [kg]*q'^2/2\nV = %.17g [N/m]*q^2/2\n"
                 "scene s { start q = 1 [m]; step 1 [ms]; until 1000 [s] }\n",
                 stiffness[k]);
        for (int way = 0; way < 3; way++) {
            motion m;
            motion_open_text(
                &m, text,
                as_matrix(&engine_float, way == 0 ? MATRIX_NONE : MATRIX_EXACT, way == 2));
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, MILLION));
            engine_float.state(m.run, angle, real[way]);
            motion_close(&m);
        }
        quad truth[LINEAR_STATES] = {1, 0};
        const double omega = sqrt(stiffness[k]);
        of.h = 1000;
        linear_step(&of, 0, step);
        linear_move(&of, step, NULL, truth);
        const double plain = oscillator_off(x, v, truth, omega);
        double off[3];
        for (int way = 0; way < 3; way++) {
            off[way] = oscillator_off((float)real[way][0], (float)real[way][1], truth, omega);
        }
        printf("  %g rad/s, 1e6 steps in float: Phi x off by %.2g, x + (Phi - 1) x by %.2g, "
               "compensated %.2g (RK4's stages %.2g)\n",
               omega, plain, off[1], off[2], off[0]);
        TEST_ASSERT_TRUE(off[1] < plain / 10.0);
        TEST_ASSERT_TRUE(off[2] < off[1] / 100.0);
    }
}

/* A rotor with friction and a motor, and a free one. Neither angle appears in a force. The first has the later
 * coordinate. */
static const char rotors[] =
    "mechanism rotors\ncoordinate th [rad]\ncoordinate ps [rad]\ncoordinate x [m]\n"
    "input M = 3 [N*m]\nT = 2 [kg*m^2]*th'^2/2 + 1 [kg*m^2]*ps'^2/2 + 1 [kg]*x'^2/2\n"
    "V = 16 [N/m]*x^2/2\nF = 0.5 [N*m*s]*th'^2/2 + 0.25 [N*s]*(x'/(1 [m])*1 [m] - 0.125 [m]*th')^2/2/(1 [m])\n"
    "Q(th) = M\noutput wave [1] = sin(th)*cos(ps)\n"
    "scene s { start th = 0.25, th' = 4 [rad/s], ps = 1, ps' = 20 [rad/s], x = 0.5 [m]; step 1 [ms]; "
    "until 100 [s] }\n";

/* Errors relative to round-off: th and x against the exponential in 113 bits, ps against its rate. */
static void expect_rotors(const engine_kind *kind, bool compensated, image_matrix_of matrix,
                          double most_rad, double most_free_rad) {
    const int steps = 100000;
    static quad step[LINEAR_STATES][LINEAR_COLUMNS];
    motion m;
    double angle[2];
    double real[4];
    /* th, x, th', x' */
    linear of = {.coordinates = 2, .states = 4, .inputs = 1, .columns = 6};
    const quad damper = (quad)0.25;
    of.rate[0][2] = 1;
    of.rate[1][3] = 1;
    of.rate[2][2] = (-(quad)0.5 - damper / 64) / 2;
    of.rate[2][3] = damper / 8 / 2;
    of.rate[2][4] = (quad)1 / 2;
    of.rate[3][1] = -16;
    of.rate[3][2] = damper / 8;
    of.rate[3][3] = -damper;
    of.h = (quad)steps / 1000;
    quad x[LINEAR_STATES] = {(quad)1 / 4, (quad)1 / 2, 4, 0};
    const double input[1] = {3.0};
    linear_step(&of, 0, step);
    linear_move(&of, step, input, x);
    motion_open_text(&m, rotors, as_matrix(kind, matrix, compensated));
    TEST_ASSERT_EQUAL_INT(2, m.image->angles);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, (uint64_t)steps));
    kind->state(m.run, angle, real);
    const double th_off = (double)quad_size((quad)angle[0] - x[0]);
    const double ps_off = (double)quad_size((quad)angle[1] - (1 + (quad)steps / 50));
    printf("  %d steps, matrix %s in %s%s: angles off by %.2g and %.2g rad, of %.0f and %.0f\n",
           steps, image_matrix_words[matrix], kind->name, compensated ? ", compensated" : "",
           th_off, ps_off, angle[0], angle[1]);
    TEST_ASSERT_TRUE(th_off <= most_rad && ps_off <= most_free_rad);
    TEST_ASSERT_TRUE((double)quad_size((quad)real[0] - x[1]) <= most_rad);
    motion_close(&m);
}

TEST(matrix_runs, turn_angles) {
    expect_rotors(&engine_double, false, MATRIX_EXACT, 1e-11, 1e-8);
    expect_rotors(&engine_double, true, MATRIX_EXACT, 1e-12, 1e-12);
    /* A free rotor moves by the same 1.5e-9 rad in each of 1e5 steps, rounded once. A slow rate stops once a step
     * changes it by less than half its last digit, with any stepper. */
    expect_rotors(&engine_float, false, MATRIX_NONE, 4e-3, 1.5e-4);
    expect_rotors(&engine_float, false, MATRIX_EXACT, 4e-3, 1.5e-4);
    expect_rotors(&engine_float, true, MATRIX_NONE, 4e-3, 1.5e-4);
    expect_rotors(&engine_float, true, MATRIX_EXACT, 4e-3, 1.5e-4);
}

/* A system given as equations of orders one and two, with an angle driven by a state. The reference is a closed form. */
TEST(matrix_runs, systems_of_first_order) {
    static const char text[] =
        "mechanism sys\nstate a [rad]\nstate u [V]\ninput d = 2 [V]\n"
        "equation a' = u/(1 [V*s]) + 3 [1/s]\nequation u' = (d - u)/(0.25 [s])\n"
        "output s = sin(a)\nscene s { start a = 1, u = 10 [V]; step 10 [ms]; until 10 [s] }\n";
    for (int k = 0; k < 4; k++) {
        const engine_kind *kind = k % 2 == 0 ? &engine_double : &engine_float;
        motion m;
        double angle[1];
        double real[2];
        motion_open_text(&m, text, as_matrix(kind, MATRIX_EXACT, k > 1));
        TEST_ASSERT_EQUAL_INT(1, m.image->angles + m.image->reals - 1);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 100));
        kind->state(m.run, angle, real);
        const double turned = m.image->angles == 1 ? angle[0] : real[0];
        const double most = kind == &engine_double ? 2e-14 : 2e-6;
        TEST_ASSERT_TRUE(fabs(turned - (1.0 + 3.0 + 2.0 + 8.0 * 0.25 * (1.0 - exp(-4.0)))) <=
                         most * 8.0);
        TEST_ASSERT_TRUE(fabs(real[m.image->reals - 1] - (2.0 + 8.0 * exp(-4.0))) <= most);
        motion_close(&m);
    }
}

/* An unstable balance ends at the same step as with RK4's stages, in the last good state. */
TEST(matrix_runs, runs_that_diverge_end_alike) {
    static const char text[] =
        "mechanism m\ncoordinate b [m]\ncoordinate q [m]\nT = 1 [kg]*(q'^2 + b'^2)/2\n"
        "V = -100 [N/m]*q^2/2\nscene s { start q = 1 [m]; step 1 [ms]; until 100 [s] }\n";
    for (int k = 0; k < 4; k++) {
        const engine_kind *kind = k % 2 == 0 ? &engine_double : &engine_float;
        uint64_t steps[2];
        int fault[2];
        for (int way = 0; way < 2; way++) {
            motion m;
            double angle[1];
            double real[4];
            motion_open_text(&m, text,
                             as_matrix(kind, way == 0 ? MATRIX_NONE : MATRIX_EXACT, k > 1));
            TEST_ASSERT_EQUAL_INT(WH_E_DIVERGED, motion_step(&m, 100000));
            TEST_ASSERT_EQUAL_INT(WH_E_DIVERGED, motion_step(&m, 1));
            steps[way] = kind->steps(m.run);
            fault[way] = kind->fault(m.run);
            kind->state(m.run, angle, real);
            TEST_ASSERT_TRUE(fabs(real[3]) < 1e15 && fabs(real[3]) > 0.9e15);
            motion_close(&m);
        }
        TEST_ASSERT_EQUAL_UINT64(steps[0], steps[1]);
        TEST_ASSERT_EQUAL_INT(fault[0], fault[1]);
        TEST_ASSERT_EQUAL_INT(3, fault[1]);
    }
}

TEST(matrix_runs, another_step_has_another_matrix) {
    motion m;
    motion other;
    diags *errors = diags_new();
    stepping how = as_matrix(&engine_double, MATRIX_EXACT, false);
    motion_open(&m, "two_mass_absolute", how);
    how.step_s = 0.004;
    motion_open(&other, "two_mass_absolute", how);
    image *again = image_again(m.image, other.instance, errors);
    TEST_ASSERT_NOT_NULL(again);
    TEST_ASSERT_EQUAL_MEMORY(other.image->matrix.entry, again->matrix.entry, 20 * sizeof(double));
    TEST_ASSERT_NOT_EQUAL(0,
                          memcmp(m.image->matrix.entry, again->matrix.entry, 20 * sizeof(double)));
    image_free(again);
    again = image_again(m.image, m.instance, errors);
    TEST_ASSERT_TRUE(again->list[IMAGE_MATRIX] == m.image->list[IMAGE_MATRIX]);
    image_free(again);
    diags_free(errors);
    motion_close(&other);
    motion_close(&m);
}

static void expect_refused(const char *text, const char *const *more, const char *said_of_it) {
    static said what;
    const char *words[8] = {model_keep(text), "--matrix", "exact"};
    for (int i = 0; more[i] != NULL; i++) {
        words[3 + i] = more[i];
    }
    command_say(command_run, words, &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(2, what.status, text);
    if (strstr(what.err, said_of_it) == NULL || strstr(what.err, "hint: ") == NULL) {
        printf("%s", what.err);
        TEST_FAIL_MESSAGE(said_of_it);
    }
    model_drop();
}

/* `line`, the sixth, is refused at the position of `part`. */
static void expect_not_linear(const char *line, const char *part, const char *why) {
    char text[800];
    char wanted[200];
    const char *const none[] = {NULL};
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate th [rad]\ninput u = 1 [N/m]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*th'^2/2\n%s\nscene s { step 1 [ms]; until 1 [s] }\n",
             line);
    snprintf(wanted, sizeof wanted, ":6:%d: error: %s in line 6 makes 's' not linear",
             (int)(strstr(line, part) - line) + 1, why);
    expect_refused(text, none, wanted);
}

TEST(matrix_runs, what_is_not_linear_is_refused_where_it_stands) {
    expect_not_linear("V = 2 [N/m]*x^2 + 3 [J]*sin(th)", "sin", "sin() of th");
    expect_not_linear("V = 1 [N/m^2]*x^3", "^3", "a power of x");
    expect_not_linear("V = 1 [N/m^2]*x^2*x/3", "*x/3", "a power of x");
    expect_not_linear("V = u*x^2", "*x", "a product of x and u");
    expect_not_linear("V = 2 [J/m]*(x - 3*x*th*th)", "*th)", "a product of x and th");
    expect_not_linear("Q(x) = -1 [kg/m]*x'*(x')", "*(x", "a power of x");
    expect_not_linear("Q(x) = -1 [N]*sign(x')", "sign", "sign() of x");
    expect_not_linear("Q(x) = 1 [N*m]/(2 [m] + x)", "/(2", "a division by an expression of x");
    expect_not_linear("let a = 2*x; V = 1 [N]*sqrt(a^2 + 1 [m^2])", "sqrt", "sqrt() of x");
    expect_not_linear("let a = x^3; V = 1 [N/m^2]*a", "^3", "a power of x");
    expect_not_linear("F = 1 [kg/m]*abs(x')^3/3", "abs", "abs() of x");
    static const char *const powers[] = {"^3",   "^4",  "^7",    "^8",     "^9",  "^12",
                                         "^0.5", "^-1", "^-2.5", "^(4/3)", "^2.5"};
    for (size_t i = 0; i < sizeof powers / sizeof powers[0]; i++) {
        static const char *const lines[] = {"V = 1 [J]*(2 + x/(1 [m]))%s",
                                            "V = 1 [N/m]*x^2 - 3 [J]*(5 - (1 + x/(1 [m]))%s/2)/4"};
        for (int k = 0; k < 2; k++) {
            char line[200];
            snprintf(line, sizeof line, lines[k], powers[i]);
            expect_not_linear(line, powers[i], "a power of x");
        }
    }
}

TEST(matrix_runs, what_has_no_matrix_is_refused) {
    static const char ball[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 10 [N]*x\n"
                               "stop x >= 0 restitution 0.5\n"
                               "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n";
    static const char grows[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                                "V = -1e8 [N/m]*x^2/2\nscene s { step 1 [s]; until 9 [s] }\n";
    static const char mass[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                               "scene s { step 1 [s]; until 9 [s] }\n";
    const char *const none[] = {NULL};
    expect_refused(ball, none, ":5:1: error: a step with events is no matrix: 's' has this stop");
    expect_refused(grows, none, ":5:7: error: the matrix of 's' has numbers that are too large");
    expect_refused(mass, (const char *const[]){"--method", "heun", NULL},
                   "--matrix exact and --method heun");
    expect_refused(mass, (const char *const[]){"--with", "ledger", NULL},
                   "error: the ledger of 's' wants the stages of a step");
}
