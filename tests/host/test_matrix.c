/* test_matrix.c: a linear step as one matrix, for generated and built-in linear mechanisms. References: the
 * exponential in 113 bits of the test's own matrices (linear.h), and the stages of RK4. */
#include "test.h"

#include "host/base/alloc.h"
#include "host/derive/matrix_make.h"
#include "host/emit/matrix.h"
#include "host/number/double_double.h"

#include "command.h"
#include "derived.h"
#include "drawn_image.h"
#include "linear.h"
#include "motion.h"

void suite_matrix_printed(void);

/* === matrix =================================================================================== */

enum { TEXT_SIZE = 4096 };

static const double input_at_start[LINEAR_INPUTS] = {0.5, 0.5};

static quad whole_of(twofold a) { return (quad)a.high + (quad)a.low; }

static twofold drawn_twofold(uint64_t *seed) {
    const double high =
        number_scaled(random_between(seed, 0.5, 1.0) * (random_bits(seed) % 2 != 0 ? 1.0 : -1.0),
                      (int)(random_bits(seed) % 60) - 30);
    return double_double_add(
        double_double_of(high),
        double_double_of(number_scaled(high * random_between(seed, -0.5, 0.5), -53)));
}

static void expect_near(quad want, twofold got, quad size) {
    TEST_ASSERT_TRUE(quad_size(whole_of(got) - want) <= size * (quad)0x1p-100);
    TEST_ASSERT_TRUE((double)want == got.high);
}

TEST(matrix, twice_the_digits) {
    uint64_t seed = 7001;
    for (unsigned n = 0; n < dice_cases(20000); n++) {
        const twofold a = drawn_twofold(&seed);
        const twofold b = drawn_twofold(&seed);
        const quad x = whole_of(a);
        const quad y = whole_of(b);
        expect_near(x * y, double_double_mul(a, b), quad_size(x * y));
        expect_near(x / y, double_double_div(a, b), quad_size(x / y));
        TEST_ASSERT_TRUE(quad_size(whole_of(double_double_add(a, b)) - (x + y)) <=
                         quad_size(x + y) * (quad)0x1p-100 + quad_size(x) * (quad)0x1p-106);
    }
}

/* Each constant is the float nearest to its 113 bits, including ties and values next to ties. */
TEST(matrix, constants_are_rounded_once) {
    uint64_t seed = 7002;
    for (unsigned n = 0; n < dice_cases(20000); n++) {
        twofold a = drawn_twofold(&seed);
        if (n % 2 == 0) { /* a tie between two floats, or next to one */
            const float below = (float)a.high;
            const double middle = ((double)below + (double)nextafterf(below, INFINITY)) / 2.0;
            a = (twofold){middle, n % 3 == 0 ? 0.0 : number_scaled(middle, n % 5 == 0 ? -55 : -90)};
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

/* Half a unit in the last place of a double. At 0: half the smallest subnormal, which is no double. */
static quad half_unit(double x) { return (quad)(nextafter(fabs(x), HUGE_VAL) - fabs(x)) / 2; }

/* Largest error of an entry beyond `share` of its bound, in half units of the last digit. */
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

/* A, B and c of the operation list. They match the test's up to the rounding of the list's few constants. */
static void take_rates(const image *im, const char *text, linear *of) {
    static twofold rates[LINEAR_STATES * LINEAR_COLUMNS];
    TEST_ASSERT_EQUAL_INT(of->columns, affine_columns(im));
    TEST_ASSERT_EQUAL_INT(-1, affine_rates(im, rates));
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

/* Every entry is the double nearest to the list's exponential, from soft to stiff: oscillations shorter than a step,
 * dampers that stop a motion within one. */
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

/* In coupled masses the list's constants are rounded, each by half a unit. The exponential amplifies that like |A|. */
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
             i++) { /* no entry is better known than its row */
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

/* Inputs change every seventh step. Returns the final error relative to the largest position or rate. */
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

/* 1000 steps in both numbers, compensated or not, exact or RK4. Each error is round-off, at most `most` units. */
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
            const bool exact = n % 5 < 3 || n % 3 == 0 || coupled; /* RK4 is not always stable */
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

TEST(matrix, the_matrix_of_rk4_moves_like_its_stages) {
    uint64_t seed = 7006;
    double worst = 0.0;
    for (unsigned n = 0; n < dice_cases(few_or_all(8, 200)); n++) {
        char text[TEXT_SIZE];
        double angle[1];
        double real[2][LINEAR_STATES];
        double size = 0.0;
        linear of;
        linear_draw(&seed, 1 + (int)(n % 4), (linear_kind){0, n % 2 != 0}, text, sizeof text, &of);
        for (int k = 0; k < 2; k++) {
            motion m;
            set_matrix(&m, text, &engine_double, k == 0 ? MATRIX_NONE : MATRIX_RK4, false);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 200));
            m.kind->state(m.run, angle, real[k]);
            motion_close(&m);
        }
        for (int i = 0; i < of.states; i++) {
            size = fmax(size, fabs(real[0][i]));
        }
        for (int i = 0; i < of.states; i++) {
            worst = fmax(worst, fabs(real[0][i] - real[1][i]) / size);
        }
        TEST_ASSERT_TRUE_MESSAGE(worst < 200.0 * DBL_EPSILON, text);
    }
    printf("  RK4's matrix and its stages are %.2g apart after 200 steps\n", worst);
}

/* === matrix printed =========================================================================== */
/* A step's matrix as tables and LaTeX (host/emit/matrix.c), parsed again. Each entry matches to the printed digits
 * and has the names of its row and column. */

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

/* Ten digits are printed. */
static const char *read_entry(const char *at, int i, int k) {
    const double wanted = drawn.entry[i * drawn.im.matrix.columns + k];
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(fabs(number - wanted) <= 5.1e-10 * fabs(wanted));
    return at;
}

/* "(theta [rad], X [m])": columns from `first` to before `end`. */
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
        at = said_exactly(at, k + 1 < end ? ", " : ")");
    }
    return at;
}

static const char *said_motion(const char *at) {
    return said_exactly(at, drawn.im.settings.matrix == MATRIX_EXACT
                                ? "the motion itself, inputs held over the step"
                                : "what Runge-Kutta 4 makes of it");
}

/* Columns `first` to before `end`, at most five side by side. All lines of a block have equal length. */
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

/* "\Phi = \begin{bmatrix} ... & ... \\ ... \end{bmatrix}" */
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

void suite_matrix_printed(void) { die = dice_of("matrix_printed", 44); }
