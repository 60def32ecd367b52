/* test_matrix.c: a linear step as one matrix, for generated and built-in linear mechanisms. References are the
 * exponential of the test's own matrices in 113 bits (linear.h), and the stages of RK4. */
#include "test.h"

#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/emit/emit.h"
#include "host/image/matrix_make.h"
#include "host/number/double_double.h"

#include "command.h"
#include "derived.h"
#include "drawn_image.h"
#include "linear.h"
#include "motion.h"

/* === suite matrix ============================================================================= */

enum { TEXT_SIZE = 4096 };

static const double input_at_start[LINEAR_INPUTS] = {0.5, 0.5};

static quad whole_of(double_double a) { return (quad)a.high + (quad)a.low; }

static double_double drawn_twofold(uint64_t *seed) {
    const double high =
        number_scaled(random_between(seed, 0.5, 1.0) * (random_bits(seed) % 2 != 0 ? 1.0 : -1.0),
                      (int)(random_bits(seed) % 60) - 30);
    return double_double_add(
        double_double_of(high),
        double_double_of(number_scaled(high * random_between(seed, -0.5, 0.5), -53)));
}

static void expect_near(quad want, double_double got, quad size) {
    TEST_ASSERT_TRUE(quad_size(whole_of(got) - want) <= size * (quad)0x1p-100);
    TEST_ASSERT_TRUE((double)want == got.high);
}

TEST(matrix, twice_the_digits) {
    uint64_t seed = 7001;
    for (unsigned n = 0; n < dice_cases(20000); n++) {
        const double_double a = drawn_twofold(&seed);
        const double_double b = drawn_twofold(&seed);
        const quad x = whole_of(a);
        const quad y = whole_of(b);
        expect_near(x * y, double_double_mul(a, b), quad_size(x * y));
        expect_near(x / y, double_double_div(a, b), quad_size(x / y));
        TEST_ASSERT_TRUE(quad_size(whole_of(double_double_add(a, b)) - (x + y)) <=
                         quad_size(x + y) * (quad)0x1p-100 + quad_size(x) * (quad)0x1p-106);
    }
}

/* A constant must be the float nearest to its two parts, also at ties and next to ties. */
TEST(matrix, constants_are_rounded_once) {
    uint64_t seed = 7002;
    for (unsigned n = 0; n < dice_cases(20000); n++) {
        double_double a = drawn_twofold(&seed);
        if (n % 2 == 0) { /* a tie between two floats, or a number near a tie */
            const float below = (float)a.high;
            const double middle = ((double)below + (double)nextafterf(below, INFINITY)) / 2.0;
            a = (double_double){middle,
                                n % 3 == 0 ? 0.0 : number_scaled(middle, n % 5 == 0 ? -55 : -90)};
            a.low = n % 7 == 0 ? -a.low : a.low;
        }
        const double constant = double_double_constant(a);
        const quad left = whole_of(a) - (quad)(float)constant;
        const float nearest = (float)constant;
        TEST_ASSERT_TRUE(quad_size(left) <=
                         quad_size(whole_of(a) - (quad)nextafterf(nearest, INFINITY)));
        TEST_ASSERT_TRUE(quad_size(left) <=
                         quad_size(whole_of(a) - (quad)nextafterf(nearest, -INFINITY)));
        TEST_ASSERT_TRUE((double)left == double_double_beyond_float(a));
        TEST_ASSERT_TRUE(fabs(constant - a.high) <= fabs(a.high) * 0x1p-52);
    }
}

/* Half a unit in the last place of a double. The result is half the smallest subnormal number for x = 0. */
static quad half_unit(double x) { return (quad)(nextafter(fabs(x), HUGE_VAL) - fabs(x)) / 2; }

/* Largest error of an entry beyond `allowed`, in half units of the entry's last place. */
static double entries_off(const linear *of, const image *im, quad want[][LINEAR_COLUMNS],
                          const quad allowed[][LINEAR_COLUMNS]) {
    double most = 0.0;
    TEST_ASSERT_EQUAL_INT(of->states, im->matrix.states);
    TEST_ASSERT_EQUAL_INT(of->columns, im->matrix.columns);
    for (int i = 0; i < of->states; i++) {
        quad row = 0;
        for (int k = 0; k < of->columns; k++) {
            row = quad_size(want[i][k]) > row ? quad_size(want[i][k]) : row;
        }
        for (int k = 0; k < of->columns; k++) {
            const double got = im->matrix.entry[i * of->columns + k];
            const quad off = quad_size((quad)got - want[i][k]) - row * (quad)0x1p-80 -
                             (allowed != NULL ? allowed[i][k] : 0);
            const double units = (double)(off / half_unit((double)want[i][k]));
            most = units > most ? units : most;
        }
    }
    return most;
}

static void set_matrix(motion *m, const char *text, const engine_kind *kind, image_matrix_of matrix,
                       bool compensated) {
    motion_open_text(
        m, text,
        (stepping){.kind = kind, .method = WH_RK4, .compensated = compensated, .matrix = matrix});
}

/* A, B and c of the operation list must equal the test's own, apart from the round-off of the list's few constants.
 * Then of->rate gets the list's values. */
static void take_rates(const image *im, const char *text, linear *of) {
    static double_double rates[LINEAR_STATES * LINEAR_COLUMNS];
    TEST_ASSERT_EQUAL_INT(of->columns, affine_columns(im));
    TEST_ASSERT_TRUE(affine_rates(im, rates));
    for (int i = 0; i < of->states; i++) {
        for (int k = 0; k < of->columns; k++) {
            const quad rate = whole_of(rates[i * of->columns + k]);
            const quad own = of->rate[i][k];
            TEST_ASSERT_TRUE_MESSAGE(quad_size(rate - own) <= 6 * (quad)0x1p-53 * quad_size(own),
                                     text);
            of->rate[i][k] = rate;
        }
    }
}

/* Every entry must be the double nearest to the exponential of the list's matrix, for soft and stiff mechanisms:
 * oscillations shorter than a step, and dampers that stop a motion within one step. */
TEST(matrix, entries_are_the_nearest_doubles) {
    static const int stiff[] = {0, 6, 14, 20};
    uint64_t seed = 7003;
    double worst = 0.0;
    for (unsigned n = 0; n < dice_cases(few_or_all(20, 400)); n++) {
        static quad step[LINEAR_STATES][LINEAR_COLUMNS];
        char text[TEXT_SIZE];
        linear of;
        motion m;
        linear_draw(&seed, 1 + (int)(n % 4), (linear_kind){stiff[n / 4 % 4], false}, text,
                    sizeof text, &of);
        for (int k = 0; k < 2; k++) {
            set_matrix(&m, text, &engine_double, k == 0 ? MATRIX_EXACT : MATRIX_RK4, false);
            linear listed = of;
            take_rates(m.image, text, &listed);
            linear_step(&listed, k == 0 ? 0 : 4, step);
            const double off = entries_off(&of, m.image, step, NULL);
            TEST_ASSERT_TRUE_MESSAGE(off <= 1.0, text);
            worst = fmax(worst, off);
            motion_close(&m);
        }
    }
    printf("  entries of generated matrices are off by %.4f of half a unit\n", worst);
}

/* With coupled masses, each constant of the list is rounded by up to half a unit. The exponential multiplies this by
 * about |A|. */
TEST(matrix, entries_of_full_mass_matrices) {
    uint64_t seed = 7004;
    double worst = 0.0;
    for (unsigned n = 0; n < dice_cases(few_or_all(8, 200)); n++) {
        static quad step[LINEAR_STATES][LINEAR_COLUMNS];
        static quad larger[LINEAR_STATES][LINEAR_COLUMNS];
        static quad allowed[LINEAR_STATES][LINEAR_COLUMNS];
        char text[TEXT_SIZE];
        linear of;
        motion m;
        linear_draw(&seed, 2 + (int)(n % 3), (linear_kind){3, true}, text, sizeof text, &of);
        set_matrix(&m, text, &engine_double, MATRIX_EXACT, false);
        linear_step(&of, 0, step);
        linear size = of;
        quad most = 0;
        for (int i = 0; i < of.states; i++) {
            for (int k = 0; k < of.columns; k++) {
                size.rate[i][k] = quad_size(of.rate[i][k]);
                most = size.rate[i][k] > most ? size.rate[i][k] : most;
            }
        }
        for (int i = of.coordinates; i < of.states;
             i++) { /* each entry may be as uncertain as the largest one */
            for (int k = 0; k < of.columns; k++) {
                size.rate[i][k] += most;
            }
        }
        linear_step(&size, 0, larger);
        for (int i = 0; i < of.states; i++) {
            for (int k = 0; k < of.columns; k++) {
                allowed[i][k] = 16 * (quad)0x1p-53 * (larger[i][k] - (i == k ? 1 : 0));
            }
        }
        const double off = entries_off(&of, m.image, step, allowed);
        TEST_ASSERT_TRUE_MESSAGE(off <= 1.0, text);
        worst = fmax(worst, off);
        motion_close(&m);
    }
    printf("  with full mass matrices by %.4f beyond their constants' rounding\n", worst);
}

static void widen(const linear *of, const quad *x, double *size) {
    for (int i = 0; i < of->states; i++) {
        const int group = i < of->coordinates ? 0 : 1;
        size[group] = fmax(size[group], (double)quad_size(x[i]));
    }
}

/* Runs with inputs that change every seven steps. Returns the error at the end, relative to the largest position or
 * rate. */
static double run_error(const linear *of, const char *text, motion *m, int order, int steps,
                        uint64_t *seed) {
    static quad step[LINEAR_STATES][LINEAR_COLUMNS];
    double input[LINEAR_INPUTS] = {input_at_start[0], input_at_start[1]};
    double angle[1];
    double real[LINEAR_STATES];
    quad x[LINEAR_STATES];
    double size[2] = {0.0, 0.0};
    double most = 0.0;
    linear_step(of, order, step);
    for (int i = 0; i < of->states; i++) {
        x[i] = (quad)of->start[i];
    }
    widen(of, x, size);
    for (int n = 0; n < steps; n++) {
        for (int k = 0; k < of->inputs && n % 7 == 6; k++) {
            input[k] = floor(random_between(seed, -16.0, 16.0)) / 8.0;
            m->kind->set_input(m->run, k, input[k]);
        }
        linear_move(of, step, input, x);
        widen(of, x, size);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, m->kind->step(m->run), text);
    }
    m->kind->state(m->run, angle, real);
    for (int i = 0; i < of->states; i++) {
        const double off = (double)quad_size((quad)real[i] - x[i]);
        most = fmax(most, off / fmax(size[i < of->coordinates ? 0 : 1], DBL_MIN));
    }
    return most;
}

/* A thousand steps in double or float, with or without compensated sums, by an exact matrix or a matrix of RK4. The
 * error must be round-off: up to `most` units. */
TEST(matrix, motions_are_those_of_the_exponential) {
    static const struct {
        const engine_kind *kind;
        bool compensated;
        double unit;
        double most;
    } ways[] = {{&engine_double, false, DBL_EPSILON, 250.0},
                {&engine_double, true, DBL_EPSILON, 90.0},
                {&engine_float, false, (double)FLT_EPSILON, 250.0},
                {&engine_float, true, (double)FLT_EPSILON, 20.0}};
    for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
        uint64_t seed = 7005;
        double worst = 0.0;
        for (unsigned n = 0; n < dice_cases(few_or_all(8, 200)); n++) {
            char text[TEXT_SIZE];
            linear of;
            motion m;
            linear_draw(&seed, 1 + (int)(n % 4), (linear_kind){n % 3 == 0 ? 6 : 0, n % 2 != 0},
                        text, sizeof text, &of);
            const bool coupled = n % 2 != 0;
            const bool exact = n % 5 < 3 || n % 3 == 0 || coupled; /* stiff: RK4 may be unstable */
            set_matrix(&m, text, ways[w].kind, exact ? MATRIX_EXACT : MATRIX_RK4,
                       ways[w].compensated);
            const double off = run_error(&of, text, &m, exact ? 0 : 4, 1000, &seed) / ways[w].unit;
            TEST_ASSERT_TRUE_MESSAGE(off <= ways[w].most, text);
            worst = fmax(worst, off);
            motion_close(&m);
        }
        printf("  after 1000 steps in %s%s: off by at most %.3g units of rounding\n",
               ways[w].kind->name, ways[w].compensated ? ", compensated" : "", worst);
    }
}

/* === suite matrix_printed ===================================================================== */
/* Reads the matrix of a step from tables, LaTeX and Octave (host/emit/matrix.c). Each entry must be right to its
 * printed digits and have the names of its row and column. */

static dice die;
static drawn_image drawn;

static char *written(void (*write)(FILE *out, const image *im)) {
    char *text = NULL;
    size_t length = 0;
    FILE *out = alloc_text(&text, &length);
    write(out, &drawn.im);
    alloc_text_end(out);
    return text;
}

static bool has_offset(void) {
    const image_matrix *m = &drawn.im.matrix;
    bool has = false;
    for (int i = 0; i < m->states; i++) {
        has = has || m->entry[(i + 1) * m->columns - 1] != 0.0;
    }
    return has;
}

static const char *read_entry(const char *at, int i, int k) {
    const double wanted = drawn.entry[i * drawn.im.matrix.columns + k];
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(fabs(number - wanted) <= 5.1e-10 * fabs(wanted));
    return at;
}

/* Reads "(theta [rad], X [m])": the names of columns `first` to end - 1. */
static const char *read_names(const char *at, int first, int end, bool units) {
    char name[40];
    at = said_exactly(at, "(");
    for (int k = first; k < end; k++) {
        at = said_exactly(at, drawn_image_name(&drawn, k, name));
        if (units) {
            at = said_exactly(at, " [");
            at = said_exactly(at, drawn_image_unit(&drawn, k));
            at = said_exactly(at, "]");
        }
        at = said_exactly(at, k + 1 < end ? ", " : "");
    }
    return said_exactly(at, ")");
}

static const char *said_motion(const char *at) {
    return said_exactly(at, drawn.im.settings.matrix == MATRIX_EXACT
                                ? "the exact motion, with inputs constant over the step"
                                : "the step of Runge-Kutta 4");
}

/* Reads columns `first` to end - 1, up to five side by side. All lines of a block must have the same length. */
static const char *read_table(const char *at, const char *title, int first, int end) {
    char name[40];
    for (int from = first; from < end; from += 5) {
        const int to = from + 5 < end ? from + 5 : end;
        at = said_exactly(at, "\n");
        const size_t wide = strcspn(at, "\n");
        at = said_words(at, from == first ? title : "");
        for (int k = from; k < to; k++) {
            at = said_words(at, drawn_image_name(&drawn, k, name));
        }
        at += strspn(at, " "); /* the constant term has no name */
        for (int i = 0; i < drawn.im.matrix.states; i++) {
            at = said_exactly(at, "\n");
            TEST_ASSERT_EQUAL_size_t(wide, strcspn(at, "\n"));
            at = said_words(at, drawn_image_name(&drawn, i, name));
            at = said_exactly(at, " ");
            for (int k = from; k < to; k++) {
                at = read_entry(at, i, k);
            }
        }
        at = said_exactly(at, "\n");
    }
    return at;
}

static const char *said_step(const char *at) {
    double step_s;
    at = said_number(at, &step_s);
    TEST_ASSERT_TRUE(fabs(step_s - drawn.im.step_s) < 1e-8 * step_s);
    return at;
}

TEST(matrix_printed, tables) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 40)); c++) {
        drawn_image_draw(&drawn, &die, c % 2 == 0 ? MATRIX_EXACT : MATRIX_RK4);
        const int states = drawn.im.matrix.states;
        const int inputs = drawn.im.inputs;
        char *text = written(matrix_text);
        const char *at = said_step(said_exactly(text, "\na step of "));
        at = said_exactly(at, " s as one matrix: ");
        at = said_motion(at);
        at = said_exactly(at, "\n\n  x+ = Phi x");
        at = said_exactly(at, inputs > 0 ? " + Gamma u" : "");
        at = said_exactly(at, has_offset() ? " + g\n" : "\n");
        at = said_exactly(at, "  x = ");
        at = read_names(at, 0, states, true);
        if (inputs > 0) {
            at = said_exactly(at, "\n  u = ");
            at = read_names(at, states, states + inputs, true);
        }
        at = said_exactly(at, "\n");
        at = read_table(at, "Phi", 0, states);
        at = read_table(at, "Gamma", states, states + inputs);
        if (has_offset()) {
            at = read_table(at, "g", states + inputs, states + inputs + 1);
        }
        TEST_ASSERT_EQUAL_STRING("", at);
        free(text);
    }
}

/* Reads "\Phi = \begin{bmatrix} ... & ... \\ ... \end{bmatrix}". */
static const char *read_latex(const char *at, const char *title, int first, int end) {
    at = said_exactly(at, title);
    at = said_exactly(at, " = \\begin{bmatrix}\n");
    for (int i = 0; i < drawn.im.matrix.states; i++) {
        for (int k = first; k < end; k++) {
            at = read_entry(at, i, k);
            at = said_exactly(at, k + 1 < end ? " & " : "");
        }
        at = said_exactly(at, i + 1 < drawn.im.matrix.states ? " \\\\\n" : "\n");
    }
    return said_exactly(at, "\\end{bmatrix}");
}

TEST(matrix_printed, latex) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 40)); c++) {
        drawn_image_draw(&drawn, &die, c % 2 == 0 ? MATRIX_EXACT : MATRIX_RK4);
        const int states = drawn.im.matrix.states;
        const int inputs = drawn.im.inputs;
        char *text = written(matrix_latex);
        const char *at = said_step(said_exactly(text, "\n% a step of "));
        at = said_exactly(at, " s: ");
        at = said_motion(at);
        at = said_exactly(at, "; x = ");
        at = read_names(at, 0, states, false);
        at = said_exactly(at, "\n\\[\n  x_{+} = \\Phi x");
        at = said_exactly(at, inputs > 0 ? " + \\Gamma u" : "");
        at = said_exactly(at, has_offset() ? " + g" : "");
        at = said_exactly(at, ", \\quad\n");
        at = read_latex(at, "\\Phi", 0, states);
        if (inputs > 0) {
            at = said_exactly(at, ", \\quad\n");
            at = read_latex(at, "\\Gamma", states, states + inputs);
        }
        if (has_offset()) {
            at = said_exactly(at, ", \\quad\n");
            at = read_latex(at, "g", states + inputs, states + inputs + 1);
        }
        TEST_ASSERT_EQUAL_STRING("\n\\]\n", at);
        free(text);
    }
}

static const char *read_exactly(const char *at, double wanted) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(number == wanted);
    return at;
}

/* Reads "  Phi = [", one row on each line, with all digits; or "zeros(2, 0)" if there are no columns. */
static const char *read_octave(const char *at, const char *name, int first, int end) {
    const image_matrix *m = &drawn.im.matrix;
    char words[60];
    snprintf(words, sizeof words, first == end ? "  %s = zeros(%d, 0);\n" : "  %s = [\n", name,
             m->states);
    at = said_exactly(at, words);
    for (int i = 0; i < m->states && first < end; i++) {
        for (int k = first; k < end; k++) {
            at = read_exactly(at, m->entry[i * m->columns + k]);
            at = said_exactly(at, k + 1 < end ? "," : ";\n");
        }
    }
    return first == end ? at : said_exactly(at, "  ];\n");
}

TEST(matrix_printed, octave) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 40)); c++) {
        drawn_image_draw(&drawn, &die, c % 2 == 0 ? MATRIX_EXACT : MATRIX_RK4);
        const int states = drawn.im.matrix.states;
        const int inputs = drawn.im.inputs;
        char *text = NULL;
        size_t length = 0;
        FILE *out = alloc_text(&text, &length);
        matrix_octave(out, &drawn.im, "x.whirl");
        alloc_text_end(out);
        const char *at = said_exactly(text, "function [Phi, Gamma, g0] = drawn()\n");
        at = read_exactly(strstr(at, "\n% A step of ") + 13, drawn.im.step_s);
        at = said_motion(said_exactly(at, " s: "));
        at = said_exactly(at, ".\n% x+ = Phi*x + Gamma*u + g0\n% x = ");
        at = said_exactly(read_names(at, 0, states, true), "\n% u = ");
        at = read_names(at, states, states + inputs, true);
        at = said_exactly(at, "\n%\n% [Phi, Gamma, g0] = drawn;\n% x = [");
        for (int i = 0; i < states; i++) {
            at = read_exactly(said_exactly(at, i > 0 ? "; " : ""), drawn.entry[i]);
        }
        at = said_exactly(at, "];\n% u = [");
        for (int i = 0; i < inputs; i++) {
            at = read_exactly(said_exactly(at, i > 0 ? "; " : ""), drawn.input[i].value);
        }
        at = said_exactly(at, inputs > 0 ? "];\n" : "zeros(0, 1)];\n");
        at = read_exactly(said_exactly(at, "% for k = 1:"), (double)drawn.im.steps);
        at = said_exactly(at, ", x = Phi*x + Gamma*u + g0; end\n");
        at = read_octave(at, "Phi", 0, states);
        at = read_octave(at, "Gamma", states, states + inputs);
        at = read_octave(at, "g0", states + inputs, states + inputs + 1);
        TEST_ASSERT_EQUAL_STRING("end\n", at);
        free(text);
    }
}

SUITE(matrix_printed) { die = dice_of("matrix_printed", 44); }

/* === suite matrix_runs ======================================================================= */
/* Uses of matrix steps: built-in linear scenes, a million steps, turn angles, systems of first order, sweeps over
 * the step, divergence, and refusals. */

static stepping as_matrix(const engine_kind *kind, image_matrix_of matrix, bool compensated) {
    return (stepping){.kind = kind, .method = WH_RK4, .compensated = compensated, .matrix = matrix};
}

enum { MILLION = 1000000 };

/* Distance of an oscillator's state from the true one, relative to an amplitude of 1. */
static double oscillator_off(const float x, const float v, const quad *truth, double omega) {
    return hypot((double)((quad)x - truth[0]), (double)((quad)v - truth[1]) / omega);
}

/* Compares x + (Phi - 1) x with Phi x, after a million steps. Every entry is rounded once to float. */
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

/* Two rotors, of which one is free and one has friction and a motor. No force depends on their angles. A coordinate
 * x comes last. */
static const char rotors[] =
    "mechanism rotors\ncoordinate th [rad]\ncoordinate ps [rad]\ncoordinate x [m]\n"
    "input M = 3 [N*m]\nT = 2 [kg*m^2]*th'^2/2 + 1 [kg*m^2]*ps'^2/2 + 1 [kg]*x'^2/2\n"
    "V = 16 [N/m]*x^2/2\nF = 0.5 [N*m*s]*th'^2/2 + 0.25 [N*s]*(x'/(1 [m])*1 [m] - 0.125 [m]*th')^2/2/(1 [m])\n"
    "Q(th) = M\noutput wave [1] = sin(th)*cos(ps)\n"
    "scene s { start th = 0.25, th' = 4 [rad/s], ps = 1, ps' = 20 [rad/s], x = 0.5 [m]; step 1 [ms]; "
    "until 100 [s] }\n";

/* Runs the rotors. The angle th is compared with the exponential in 113 bits, the free rotor's ps with its constant
 * rate. */
static void expect_rotors(const engine_kind *kind, bool compensated, image_matrix_of matrix,
                          double most_rad, double most_free_rad) {
    const int steps = 100000;
    static quad step[LINEAR_STATES][LINEAR_COLUMNS];
    motion m;
    double angle[2];
    double real[4];
    /* the states are th, x, th', x' */
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
    /* In each of 1e5 steps the free rotor moves by the same angle, rounded to 1.5e-9 rad. With any method, a slow
     * rate stays constant if a step changes it by less than half a unit in the last place. */
    expect_rotors(&engine_float, false, MATRIX_NONE, 4e-3, 1.5e-4);
    expect_rotors(&engine_float, false, MATRIX_EXACT, 4e-3, 1.5e-4);
    expect_rotors(&engine_float, true, MATRIX_NONE, 4e-3, 1.5e-4);
    expect_rotors(&engine_float, true, MATRIX_EXACT, 4e-3, 1.5e-4);
}

/* A system of two equations: a state drives an angle. The reference is a closed form. */
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

/* An unstable balance must end at the same step as with RK4's stages, in the last good state. */
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

/* Fails the test if `line`, the sixth line, is not refused at the statement that begins with `part`. */
static void expect_not_linear(const char *line, const char *part) {
    char text[800];
    char wanted[200];
    const char *const none[] = {NULL};
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate th [rad]\ninput u = 1 [N/m]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*th'^2/2\n%s\nscene s { step 1 [ms]; until 1 [s] }\n",
             line);
    const char *at = strstr(line, part);
    snprintf(
        wanted, sizeof wanted,
        ":6:%d: error: line 6 makes 's' nonlinear, so --matrix cannot compute its step: %.*s\n",
        (int)(at - line) + 1, (int)strcspn(at, ";"), at);
    expect_refused(text, none, wanted);
}

TEST(matrix_runs, nonlinear_terms_are_refused_with_place) {
    expect_not_linear("V = 2 [N/m]*x^2 + 3 [J]*sin(th)", "V");
    expect_not_linear("V = 1 [N/m^2]*x^3", "V");
    expect_not_linear("V = u*x^2", "V");
    expect_not_linear("V = 2 [J/m]*(x - 3*x*th*th)", "V");
    expect_not_linear("Q(x) = -1 [kg/m]*x'*(x')", "Q");
    expect_not_linear("Q(x) = -1 [N]*sign(x')", "Q");
    expect_not_linear("Q(x) = 1 [N*m]/(2 [m] + x)", "Q");
    expect_not_linear("let a = 2*x; V = 1 [N]*sqrt(a^2 + 1 [m^2])", "V");
    expect_not_linear("F = 1 [N*s/m]*x'^2/2; V = 1 [N/m^2]*x^3", "V");
    expect_not_linear("F = 1 [kg/m]*abs(x')^3/3", "F");
    static const char *const powers[] = {"^3",   "^4",  "^7",    "^8",     "^9",  "^12",
                                         "^0.5", "^-1", "^-2.5", "^(4/3)", "^2.5"};
    for (size_t i = 0; i < sizeof powers / sizeof powers[0]; i++) {
        static const char *const lines[] = {"V = 1 [J]*(2 + x/(1 [m]))%s",
                                            "V = 1 [N/m]*x^2 - 3 [J]*(5 - (1 + x/(1 [m]))%s/2)/4"};
        for (int k = 0; k < 2; k++) {
            char line[200];
            snprintf(line, sizeof line, lines[k], powers[i]);
            expect_not_linear(line, "V");
        }
    }
}

TEST(matrix_runs, mechanisms_without_a_matrix_are_refused) {
    static const char ball[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 10 [N]*x\n"
                               "stop x >= 0 restitution 0.5\n"
                               "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n";
    static const char grows[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                                "V = -1e8 [N/m]*x^2/2\nscene s { step 1 [s]; until 9 [s] }\n";
    static const char mass[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                               "scene s { step 1 [s]; until 9 [s] }\n";
    const char *const none[] = {NULL};
    expect_refused(ball, none,
                   ":5:1: error: --matrix is not for scenes with events: 's' has this stop");
    expect_refused(grows, none, ":5:7: error: the matrix of 's' has numbers that are too large");
    expect_refused(mass, (const char *const[]){"--method", "heun", NULL},
                   "--matrix exact and --method heun");
    expect_refused(mass, (const char *const[]){"--with", "ledger", NULL},
                   "error: the ledger of 's' needs the stages of a step");
}
