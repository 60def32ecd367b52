/* test_octave_drawn.c: function files for Octave and Matlab of drawn scenes, parsed completely. Each line computes
 * its operation of the list, and each y(k) is the right component. */
#include "blocks.h"
#include "core/version.h"
#include "drawn_scene.h"
#include "formula.h"
#include "host/base/alloc.h"
#include "host/emit/emit.h"
#include "host/emit/matrix.h"
#include "test.h"

static dice die;
static drawn_scene drawn;
static double x[SCENE_OPS]; /* results of the list so far */
static component order[SCENE_STATES + SCENE_UNKNOWNS];
static int ordered;

static void make_order(const image *im) {
    ordered = 0;
    for (int level = 0; level < 4; level++) {
        for (int i = 0; i < im->count; i++) {
            if (level < im->unknown[i].order) {
                order[ordered++] = (component){i, level};
            }
        }
    }
}

static double y_value(component c) { return 0.3 + 0.41 * c.unknown - 0.17 * c.primes; }
static double input_value(int i) { return 1.1 - 0.7 * i; }

/* Formulas have only real numbers, so a non-finite value is replaced by 0.5. */
static double tame(double value) { return isfinite(value) ? value : 0.5; }

static double value_of(void *context, const char *name, int length) {
    (void)context;
    const int number = (int)strtol(name + (*name == 'y' ? 2 : 1), NULL, 10);
    if (*name == 'y' && name[1] == '(') {
        return number >= 1 && number <= ordered ? y_value(order[number - 1]) : (double)NAN;
    }
    for (int i = 0; i < drawn.im.inputs && strncmp(name, "u_", 2) == 0; i++) {
        const char *known = drawn.im.input[i].name;
        if ((int)strlen(known) == length - 2 && strncmp(known, name + 2, strlen(known)) == 0) {
            return input_value(i);
        }
    }
    return *name == 'x' && isdigit((unsigned char)name[1]) ? x[number] : (double)NAN;
}

static double called(const char *name, double a, const double *b) {
    char text[120];
    const char *end;
    const int length = snprintf(text, sizeof text, "%s((%.17g)", name, a);
    if (b != NULL) {
        snprintf(text + length, sizeof text - (size_t)length, ", (%.17g))", *b);
    } else {
        snprintf(text + length, sizeof text - (size_t)length, ")");
    }
    return formula_value(text, &end, value_of, NULL);
}

static double row_value(const image *im, const op *o) {
    const double a = o->a >= 0 && op_rows[o->code].kind != OP_IS_LEAF ? x[o->a] : 0.0;
    const double b = o->b >= 0 ? x[o->b] : 0.0;
    const int linears = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
    double sum = o->value;
    switch (o->code) {
    case OP_CONSTANT: return o->value;
    case OP_LINEAR: return y_value(im->real[o->a]);
    case OP_RATE: return y_value(im->real[linears + o->a]);
    case OP_INPUT: return input_value(o->a);
    case OP_PHASE:
        for (int k = 0; k < im->angles && o->turns != NULL; k++) {
            sum += o->turns[k] * y_value(im->angle[k]);
        }
        return sum + b;
    case OP_SIN: return sin(a);
    case OP_COS: return cos(a);
    case OP_ADD: return a + b;
    case OP_SUB: return a - b;
    case OP_MUL: return a * b;
    case OP_DIV: return a / b;
    case OP_NEG: return -a;
    case OP_SQRT: return sqrt(a);
    case OP_ABS: return fabs(a);
    case OP_SIGN: return (double)((a > 0.0) - (a < 0.0));
    case OP_MIN: return a < b ? a : b;
    case OP_MAX: return a > b ? a : b;
    case OP_CALL: return called(function_name(o->function), a, o->b >= 0 ? &b : NULL);
    case OP_POW: return pow(a, b);
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break; /* never in a step for Octave */
    }
    return (double)NAN;
}

static const char *said_formula(const char *at, double wanted, const char *end_of_line) {
    const char *end;
    const double got = tame(formula_value(at, &end, value_of, NULL));
    if (!(fabs(got - wanted) <= 1e-9 * (1.0 + fabs(wanted)))) {
        printf("  %.17g for %.17g: %.80s\n", got, wanted, at);
        TEST_FAIL();
    }
    return said_exactly(end, end_of_line);
}

static const char *said_operations(const char *at, const image *im) {
    const op_list *t = im->list[IMAGE_STEP];
    char words[40];
    for (int i = 0; i < t->count; i++) {
        x[i] = tame(row_value(im, &t->ops[i]));
        if (t->ops[i].code != OP_CONSTANT) {
            snprintf(words, sizeof words, "  x%d = ", i);
            at = said_exactly(at, words);
            at = said_formula(at, x[i], ";\n");
        }
    }
    return at;
}

static int result_of(const image *im, int unknown) {
    if (im->form == WH_SECOND_ORDER) {
        return im->place[unknown];
    }
    for (int c = 0; c < im->angles + im->reals; c++) {
        const component is = c < im->angles ? im->angle[c] : im->real[c - im->angles];
        if (is.unknown == unknown && is.primes + 1 == im->unknown[unknown].order) {
            return c;
        }
    }
    return -1;
}

static int number_of(component c) {
    for (int i = 0; i < ordered; i++) {
        if (order[i].unknown == c.unknown && order[i].primes == c.primes) {
            return i + 1;
        }
    }
    return -1;
}

static const char *said_slopes(const char *at, const image *im) {
    char words[60];
    snprintf(words, sizeof words, "  dy = zeros(%d, 1);\n", ordered);
    at = said_exactly(at, words);
    for (int i = 0; i < im->count; i++) {
        for (int primes = 0; primes < im->unknown[i].order; primes++) {
            snprintf(words, sizeof words, "  dy(%d) = ", number_of((component){i, primes}));
            at = said_exactly(at, words);
            const bool highest = primes + 1 == im->unknown[i].order;
            const int *result = im->list[IMAGE_STEP]->result;
            at = said_formula(
                at, highest ? x[result[result_of(im, i)]] : y_value((component){i, primes + 1}),
                ";\n");
        }
    }
    return at;
}

/* May an operation give a complex number in Octave? In C it is NaN. */
static bool has_complex(const op_list *t) {
    static const char *const partial[] = {"asin", "acos", "log", "sqrt"};
    bool found = false;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        found = found || o->code == OP_SQRT || o->code == OP_POW;
        for (int k = 0; k < 4 && o->code == OP_CALL; k++) {
            found = found || strcmp(function_name(o->function), partial[k]) == 0;
        }
    }
    return found;
}

static const char *said_y(const char *at) {
    char name[40];
    at = said_exactly(at, "%\n% y = (");
    for (int i = 0; i < ordered; i++) {
        at = said_exactly(at, i > 0 ? ", " : "");
        at = said_exactly(at, drawn_scene_name(&drawn, order[i], name));
    }
    return said_exactly(at, ")\n%\n");
}

static const char *said_same(const char *at, double wanted) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(number == wanted);
    return at;
}

static double start_of(const image *im, component c) {
    for (int i = 0; i < im->angles; i++) {
        if (im->angle[i].unknown == c.unknown && im->angle[i].primes == c.primes) {
            return im->start_rad[i];
        }
    }
    for (int i = 0; i < im->reals; i++) {
        if (im->real[i].unknown == c.unknown && im->real[i].primes == c.primes) {
            return im->start_real[i];
        }
    }
    TEST_FAIL_MESSAGE("no component");
    return 0.0;
}

static const char *said_run(const char *at, const image *im) {
    char words[120];
    at = said_exactly(at, "% options = odeset('RelTol', 1e-7, 'AbsTol', 1e-9);\n");
    snprintf(words, sizeof words, "%% [T, Y] = ode45(@%s, [0 ", im->name);
    at = said_same(said_exactly(at, words), im->until_s);
    at = said_exactly(at, "], [");
    for (int i = 0; i < ordered; i++) {
        at = said_same(said_exactly(at, i > 0 ? "; " : ""), start_of(im, order[i]));
    }
    snprintf(words, sizeof words, "], options);\n%% K = [T Y]; save('%s.txt', 'K', '-ascii')\n",
             im->name);
    return said_exactly(at, words);
}

static const char *said_inputs(const char *at, const image *im) {
    char words[120];
    for (int i = 0; i < im->inputs; i++) {
        snprintf(words, sizeof words, "  u_%s = ", im->input[i].name);
        at = said_same(said_exactly(at, words), im->input[i].value);
        snprintf(words, sizeof words, "; %% %s\n", im->input[i].text);
        at = said_exactly(at, words);
    }
    return at;
}

/* No generated list has an empty phase. */
static bool has_empty_phase(const op_list *t) {
    bool found = false;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        found = found || (o->code == OP_PHASE && o->value == 0.0 && o->turns == NULL && o->b < 0);
    }
    return found;
}

static void draw_for_octave(void) {
    do {
        drawn_scene_draw(&drawn, &die);
    } while (drawn.im.recovered > 0 || drawn.im.settings.tables != TABLES_NONE ||
             has_empty_phase(drawn.im.list[IMAGE_STEP]));
    make_order(&drawn.im);
}

TEST(octave_drawn, function_files_compute_the_list) {
    for (unsigned c = 0; c < dice_cases(usual_or(200, 50)); c++) {
        draw_for_octave();
        const image *im = &drawn.im;
        static const char contacts[] = "% a stop\n";
        const bool has_contacts = dice_one_of(&die, 2) == 0;
        char words[120];
        char *text = NULL;
        size_t length = 0;
        const long blocks = blocks_in_use();
        FILE *out = alloc_text(&text, &length);
        emit_octave(out, im, "x.whirl", has_contacts ? contacts : "");
        alloc_text_end(out);
        snprintf(words, sizeof words,
                 "function dy = %s(t, y)\n%% Generated by whirl " WH_VERSION
                 " from x.whirl: do not edit. SI "
                 "units.\n",
                 im->name);
        const char *at = said_exactly(text, words);
        at = said_y(at);
        at = said_run(at, im);
        at = said_exactly(at, has_contacts ? contacts : "");
        at = said_inputs(at, im);
        at = said_operations(at, im);
        at = said_slopes(at, im);
        if (has_complex(im->list[IMAGE_STEP])) {
            at = said_exactly(
                at, "  if ~isreal(dy), dy(:) = NaN; end % outside a function's real values\n");
        }
        TEST_ASSERT_EQUAL_STRING("end\n", at);
        free(text);
        TEST_ASSERT_TRUE(blocks_in_use() == blocks);
    }
}

static const char *said_rows(const char *at, const image *im, const char *name, int first,
                             int end) {
    char words[60];
    if (first == end) {
        snprintf(words, sizeof words, "  %s = zeros(%d, 0);\n", name, im->matrix.states);
        return said_exactly(at, words);
    }
    snprintf(words, sizeof words, "  %s = [\n", name);
    at = said_exactly(at, words);
    for (int i = 0; i < im->matrix.states; i++) {
        at = said_exactly(at, "   ");
        for (int k = first; k < end; k++) {
            at = said_same(said_exactly(at, " "), im->matrix.entry[i * im->matrix.columns + k]);
            at = said_exactly(at, k + 1 < end ? "," : ";\n");
        }
    }
    return said_exactly(at, "  ];\n");
}

static const char *said_names(const char *at, const image *im) {
    char name[60];
    at = said_exactly(at, "% x = (");
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = i < im->angles ? im->angle[i] : im->real[i - im->angles];
        char bare[40];
        snprintf(name, sizeof name, "%s%s [%s]", i > 0 ? ", " : "",
                 drawn_scene_name(&drawn, c, bare), im->unknown[c.unknown].unit[c.primes].si);
        at = said_exactly(at, name);
    }
    at = said_exactly(at, ")\n% u = (");
    for (int i = 0; i < im->inputs; i++) {
        snprintf(name, sizeof name, "%s%s [%s]", i > 0 ? ", " : "", im->input[i].name,
                 im->input[i].unit.si);
        at = said_exactly(at, name);
    }
    return said_exactly(at, ")\n%\n");
}

TEST(octave_drawn, matrix_files_have_each_entry) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 30)); c++) {
        do {
            drawn_scene_draw(&drawn, &die);
        } while (drawn.im.settings.matrix == MATRIX_NONE);
        const image *im = &drawn.im;
        const int states = im->angles + im->reals;
        char words[200];
        char *text = NULL;
        size_t length = 0;
        FILE *out = alloc_text(&text, &length);
        matrix_octave(out, im, "x.whirl");
        alloc_text_end(out);
        snprintf(words, sizeof words,
                 "function [Phi, Gamma, g0] = %s()\n%% Generated by whirl " WH_VERSION
                 " from x.whirl: do not "
                 "edit. SI units.\n%%\n%% A step of ",
                 im->name);
        const char *at = said_same(said_exactly(text, words), im->step_s);
        at = said_exactly(at, im->settings.matrix == MATRIX_EXACT
                                  ? " s: the motion itself, inputs held over the step.\n"
                                  : " s: what Runge-Kutta 4 makes of it.\n");
        at = said_exactly(at, "% x+ = Phi*x + Gamma*u + g0\n");
        at = said_names(at, im);
        snprintf(words, sizeof words, "%% [Phi, Gamma, g0] = %s;\n%% x = [", im->name);
        at = said_exactly(at, words);
        for (int i = 0; i < states; i++) {
            at = said_same(said_exactly(at, i > 0 ? "; " : ""),
                           i < im->angles ? im->start_rad[i] : im->start_real[i - im->angles]);
        }
        at = said_exactly(at, "];\n% u = [");
        for (int i = 0; i < im->inputs; i++) {
            at = said_same(said_exactly(at, i > 0 ? "; " : ""), im->input[i].value);
        }
        at = said_exactly(at, im->inputs > 0 ? "];\n" : "zeros(0, 1)];\n");
        snprintf(words, sizeof words, "%% for k = 1:%llu, x = Phi*x + Gamma*u + g0; end\n",
                 (unsigned long long)im->steps);
        at = said_exactly(at, words);
        at = said_rows(at, im, "Phi", 0, states);
        at = said_rows(at, im, "Gamma", states, states + im->inputs);
        at = said_rows(at, im, "g0", states + im->inputs, states + im->inputs + 1);
        TEST_ASSERT_EQUAL_STRING("end\n", at);
        free(text);
    }
}

SUITE(octave_drawn) { die = dice_of("octave_drawn", 4160); }
