/* test_matrix_printed.c: a step's matrix as tables and as LaTeX (host/emit/matrix.c), drawn: read back from the text, each
 * entry is what it was to the digits that are shown, beside the names of its row and its column. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "drawn_image.h"
#include "host/base/alloc.h"
#include "host/emit/matrix.h"
#include "unity.h"

void suite_matrix_printed(void);

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

/* Ten digits of it are there. */
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

/* Of `first` to before `end`, five columns beside each other at most; all lines of a block end at one column. */
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
        at += strspn(at, " "); /* what is added has no name */
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

static void test_tables(void) {
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

static void test_latex(void) {
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

void suite_matrix_printed(void) {
    die = dice_of("matrix_printed", 44);
    RUN_TEST(test_tables);
    RUN_TEST(test_latex);
}
