/* test_reader.c: a model's expressions as nodes of a graph (host/prove/reader.h): drawn formulas, each worth what long double
 * makes of the same, in numbers enclosures of it; which variable a derivative is; and what is not enclosed, told once, at its
 * place. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "drawn_graph.h"
#include "host/base/alloc.h"
#include "host/prove/reader.h"
#include "unity.h"

void suite_reader(void);

enum { LETS = 24, NUMBERS = 4, TEXT_SIZE = 6000, VARIABLES = 7 };

static dice die;

/* A text, read, and the symbols as whoever reads expressions has them. */
typedef struct reading {
    whirl_model *model;
    const mechanism *of;
    instance *instance;
    diags *errors;
    reader_symbols symbols;
    int first[2];
    int order[2];
    int parameter[NUMBERS];
    int let[LETS + 1];
} reading;

static reading r;

/* Of states a (second order) and b (first order): a, a', b; then the highest, a'' and b'. */
static void open_text(const char *text) {
    r = (reading){.errors = diags_new()};
    r.model = model_parse("x.whirl", text, strlen(text), r.errors);
    if (r.model == NULL) {
        diags_flush(r.errors, stdout);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(r.model, text);
    r.of = r.model->mechanisms[0];
    r.instance = instance_make(r.of, NULL, NULL, r.errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(r.instance, text);
    TEST_ASSERT_TRUE(r.of->coordinate_count == 2 && r.of->parameter_count <= NUMBERS &&
                     r.of->let_count <= LETS + 1);
    r.first[1] = 2;
    r.order[0] = 2;
    r.order[1] = 1;
    r.symbols = (reader_symbols){.graph = graph_new(),
                                 .instance = r.instance,
                                 .first = r.first,
                                 .order = r.order,
                                 .highest = 3,
                                 .parameter = r.parameter,
                                 .let = r.let,
                                 .errors = r.errors};
    for (int i = 0; i < NUMBERS; i++) {
        r.parameter[i] = -1;
    }
    for (int i = 0; i <= LETS; i++) {
        r.let[i] = -1;
    }
}

static void close_text(void) {
    graph_free(r.symbols.graph);
    instance_free(r.instance);
    model_free(r.model);
    diags_free(r.errors);
}

#define HEAD \
    "mechanism m\nstate a\nstate b\n" \
    "equation a'' = 0 [1/s^2]*a\nequation b' = 0 [1/s]*b\n"

/* --- drawn formulas --------------------------------------------------------------------------------------------*/

/* The names of what there is to take: states and their derivatives (times seconds), an input, parameters, lets so far. */
static const char *const leaves[] = {
    "a", "(a'*1 [s])", "b", "(a''*1 [s^2])", "(b'*1 [s])", "u", "p0", "p1", "p2", "p3"};
enum { LEAVES = 10, MOVING = 5 };

typedef struct drawn_text {
    char text[TEXT_SIZE];
    size_t length;
    long double value[LEAVES + LETS];
    bool is_number[LEAVES + LETS];
} drawn_text;

static drawn_text d;

#define SAY(...) \
    (d.length += (size_t)snprintf(d.text + d.length, TEXT_SIZE - d.length, __VA_ARGS__))

static const char *name_of(int i, char name[24]) {
    if (i < LEAVES) {
        snprintf(name, 24, "%s", leaves[i]);
    } else {
        snprintf(name, 24, "e%d", i - LEAVES);
    }
    return name;
}

enum { FORMULAS = 21 };

/* Formula `which` of u and v, and what it is. Numbers alone may stand in what has corners. */
static long double write_formula(int which, const char *u, const char *v, long double x,
                                 long double y, char *text) {
    const char *form = NULL;
    long double value = 0.0L;
    switch (which) {
    case 0: form = "%s + %s", value = x + y; break;
    case 1: form = "%s - %s", value = x - y; break;
    case 2: form = "%s * %s", value = x * y; break;
    case 3: form = "%s / (3 + sin(%s))", value = x / (3.0L + sinl(y)); break;
    case 4: form = "-%s + 0.25", value = -x + 0.25L; break;
    case 5: form = "sin(%s)", value = sinl(x); break;
    case 6: form = "cos(%s)", value = cosl(x); break;
    case 7: form = "tan(sin(%s))", value = tanl(sinl(x)); break;
    case 8: form = "sqrt(1 + %s^2)", value = sqrtl(1.0L + x * x); break;
    case 9: form = "exp(%s/3)", value = expl(x / 3.0L); break;
    case 10: form = "log(1.5 + %s^2)", value = logl(1.5L + x * x); break;
    case 11: form = "sinh(%s/2)", value = sinhl(x / 2.0L); break;
    case 12: form = "cosh(%s/2)", value = coshl(x / 2.0L); break;
    case 13: form = "tanh(%s)", value = tanhl(x); break;
    case 14: form = "(%s)^3", value = x * x * x; break;
    case 15: form = "(2 + cos(%s))^(%s/2)", value = powl(2.0L + cosl(x), y / 2.0L); break;
    case 16: form = "(2 + cos(%s))^1.5", value = powl(2.0L + cosl(x), 1.5L); break;
    case 17: form = "abs(%s)", value = fabsl(x); break;
    case 18: form = "sign(%s)", value = x > 0.0L ? 1.0L : x < 0.0L ? -1.0L : 0.0L; break;
    case 19: form = "min(%s, %s)", value = fminl(x, y); break;
    default: form = "max(%s, %s)", value = fmaxl(x, y);
    }
    snprintf(text, 200, form, u, v);
    return value;
}

static void draw_text(void) {
    d.length = 0;
    SAY("%s", HEAD);
    for (int i = 0; i < LEAVES; i++) {
        d.is_number[i] = i >= MOVING;
        d.value[i] = (long double)dice_between(&die, -2.0, 2.0);
        if (d.is_number[i]) { /* of hundredths: decimals that no double is */
            d.value[i] = roundl(d.value[i] * 100.0L) / 100.0L;
            SAY("%s %s = %.2Lf\n", i == MOVING ? "input" : "parameter", leaves[i], d.value[i]);
        }
    }
    for (int i = LEAVES; i < LEAVES + LETS; i++) {
        char u[24];
        char v[24];
        char formula[200];
        int left = (int)dice_one_of(&die, (unsigned)i);
        int right = (int)dice_one_of(&die, (unsigned)i);
        int which = (i + (int)dice_one_of(&die, 5)) % FORMULAS;
        if (which >= 17) {
            left = MOVING + (int)dice_one_of(&die, LEAVES - MOVING);
            right = MOVING + (int)dice_one_of(&die, LEAVES - MOVING);
        }
        d.value[i] = write_formula(which, name_of(left, u), name_of(right, v), d.value[left],
                                   d.value[right], formula);
        if (fabsl(d.value[i]) > 6.0L) {
            which = 13;
            d.value[i] = write_formula(which, u, v, d.value[left], d.value[right], formula);
        }
        const bool has_two = strstr(formula, v) != NULL && (which < 4 || which == 15 || which > 18);
        d.is_number[i] = d.is_number[left] && (!has_two || d.is_number[right]);
        SAY("let e%d = %s\n", i - LEAVES, formula);
    }
    TEST_ASSERT_TRUE(d.length < TEXT_SIZE);
}

static void test_worth(void) {
    unsigned numbers = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(40, 15)); c++) {
        draw_text();
        open_text(d.text);
        graph *g = r.symbols.graph;
        long double at[VARIABLES] = {0.0L};
        for (int i = 0; i < MOVING; i++) {
            at[i] = d.value[i];
        }
        for (int i = 0; i < LETS; i++) {
            TEST_ASSERT_TRUE(read_node(&r.symbols, r.of->lets[i]->value) >= 0);
        }
        long double *value = alloc(g->count, sizeof *value);
        drawn_graph_values(g, at, value);
        const int count = g->count;
        for (int i = 0; i < LETS; i++) {
            const int made = read_node(&r.symbols, r.of->lets[i]->value);
            const long double wanted = d.value[LEAVES + i];
            TEST_ASSERT_TRUE_MESSAGE(made < count, "the same once more");
            TEST_ASSERT_TRUE_MESSAGE(fabsl(value[made] - wanted) <= 1e-11L * (1.0L + fabsl(wanted)),
                                     d.text);
            if (d.is_number[LEAVES + i]) {
                TEST_ASSERT_TRUE_MESSAGE(graph_is_number(g, made), d.text);
                const enclosure e = g->node[made].number;
                TEST_ASSERT_TRUE_MESSAGE((long double)e.low <= wanted + 1e-17L &&
                                             wanted - 1e-17L <= (long double)e.high,
                                         d.text);
                TEST_ASSERT_TRUE_MESSAGE(e.high - e.low <= 1e-10, d.text);
                numbers++;
            }
        }
        TEST_ASSERT_EQUAL_INT(0, diags_count(r.errors));
        free(value);
        close_text();
    }
    TEST_ASSERT_TRUE(numbers > 50);
}

/* Nodes of the derivatives are the variables that were said. */
static void test_variables(void) {
    static const char *const words[] = {"a", "a'", "b", "a''", "b'"};
    for (int i = 0; i < MOVING; i++) {
        char text[400];
        snprintf(text, sizeof text, HEAD "let e = %s\n", words[i]);
        open_text(text);
        const int made = read_node(&r.symbols, r.of->lets[0]->value);
        TEST_ASSERT_EQUAL_INT(NODE_VARIABLE, r.symbols.graph->node[made].kind);
        TEST_ASSERT_EQUAL_INT(i, r.symbols.graph->node[made].left);
        close_text();
    }
}

/* --- corners of what is not quite known -------------------------------------------------------------------------*/

static enclosure number_of(const char *formula) {
    char text[500];
    /* z is an enclosure of zero, w one of a tenth */
    snprintf(text, sizeof text, HEAD "parameter z = 0.1*3 - 0.3\nparameter w = 0.1*1\nlet e = %s\n",
             formula);
    open_text(text);
    const int made = read_node(&r.symbols, r.of->lets[0]->value);
    TEST_ASSERT_TRUE_MESSAGE(made >= 0 && graph_is_number(r.symbols.graph, made), formula);
    const enclosure e = r.symbols.graph->node[made].number;
    close_text();
    return e;
}

static void expect_ends(const char *formula, double low, double high) {
    const enclosure e = number_of(formula);
    const double slack = strstr(formula, "-w") != NULL ? 4e-17 : 0.0; /* a sign is a product */
    TEST_ASSERT_TRUE_MESSAGE(e.low <= low && low - e.low <= slack, formula);
    TEST_ASSERT_TRUE_MESSAGE(e.high >= high && e.high - high <= slack, formula);
}

static void test_corners(void) {
    const enclosure z = number_of("z");
    const enclosure w = number_of("w");
    TEST_ASSERT_TRUE(z.low < 0.0 && z.high > 0.0 && w.low > 0.09 && w.low < w.high);
    expect_ends("abs(z)", 0.0, fmax(-z.low, z.high));
    expect_ends("abs(w)", w.low, w.high);
    expect_ends("abs(-w)", w.low, w.high);
    expect_ends("sign(z)", -1.0, 1.0);
    expect_ends("sign(w)", 1.0, 1.0);
    expect_ends("sign(-w)", -1.0, -1.0);
    expect_ends("sign(0)", 0.0, 0.0);
    expect_ends("sign(abs(z))", 0.0, 1.0);
    expect_ends("sign(min(z, 0))", -1.0, 0.0);
    expect_ends("abs(0)", 0.0, 0.0);
    expect_ends("min(z, w)", z.low, z.high);
    expect_ends("max(z, w)", w.low, w.high);
    expect_ends("min(w, z)", z.low, z.high);
    expect_ends("max(w, z)", w.low, w.high);
    expect_ends("min(z, 0)", z.low, 0.0);
    expect_ends("max(z, 0)", 0.0, z.high);
    expect_ends("max(0, z)", 0.0, z.high);
}

/* --- what is refused -------------------------------------------------------------------------------------------*/

/* Told once: the function's name, in line 6 at this column. */
static void expect_refused(const char *formula, const char *name) {
    char text[500];
    char wanted[200];
    char *told = NULL;
    size_t length = 0;
    snprintf(text, sizeof text, HEAD "let e = %s\n", formula);
    open_text(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(-1, read_node(&r.symbols, r.of->lets[0]->value), formula);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(1, diags_calls(r.errors), formula);
    FILE *out = alloc_text(&told, &length);
    diags_flush(r.errors, out);
    alloc_text_end(out);
    snprintf(wanted, sizeof wanted, "x.whirl:6:%d: error: %s of what moves cannot be enclosed\n",
             (int)(strstr(formula, name) - formula) + 9, name);
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told, strlen(wanted));
    TEST_ASSERT_NOT_NULL(
        strstr(told, "hint: only smooth functions that are enclosed can be proved about"));
    free(told);
    close_text();
}

static void test_refused(void) {
    static const char *const inside[] = {
        "%s",     "1 + %s",     "%s*2",       "a/(3 + %s)", "sin(%s)",    "tanh(%s)",     "(%s)^2",
        "2^(%s)", "min(1, %s)", "min(%s, 1)", "-(%s)",      "a*(b - %s)", "sqrt(exp(%s))"};
    static const char *const refused[][2] = {
        {"abs(a)", "abs"},        {"sign(b)", "sign"},      {"min(a, 1)", "min"},
        {"min(1, a)", "min"},     {"max(1, b)", "max"},     {"max(a, b)", "max"},
        {"asin(a)", "asin"},      {"acos(a)", "acos"},      {"atan(a)", "atan"},
        {"atan2(a, 1)", "atan2"}, {"atan2(1, b)", "atan2"}, {"asin(b/2)", "asin"}};
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        for (size_t k = 0; k < sizeof inside / sizeof inside[0]; k++) {
            char formula[200];
            snprintf(formula, sizeof formula, inside[k], refused[i][0]);
            const bool is_other = strstr(formula, refused[i][1]) != strstr(formula, refused[i][0]);
            if (!is_other) { /* else the place is another one's of the same name */
                expect_refused(formula, refused[i][1]);
            }
        }
    }
}

/* An output has no value of its own while the motion is proved. */
static void test_outputs(void) {
    char *told = NULL;
    size_t length = 0;
    open_text(HEAD "output o = a\noutput p = 2*o\n");
    TEST_ASSERT_EQUAL_INT(-1, read_node(&r.symbols, r.of->outputs[1]->value));
    FILE *out = alloc_text(&told, &length);
    diags_flush(r.errors, out);
    alloc_text_end(out);
    const char wanted[] = "x.whirl:7:14: error: an output of what moves cannot be enclosed\n";
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told, strlen(wanted));
    free(told);
    close_text();
}

void suite_reader(void) {
    die = dice_of("reader", 53);
    RUN_TEST(test_worth);
    RUN_TEST(test_variables);
    RUN_TEST(test_corners);
    RUN_TEST(test_refused);
    RUN_TEST(test_outputs);
}
