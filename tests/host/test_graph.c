/* test_graph.c: expressions as a graph (host/prove/graph.h, graph_slope.c): drawn ones, whose nodes must be worth what they
 * are made of; slopes, against those of a tiny imaginary part; what becomes of them without some variables; that what is
 * equal is one node, and what is simplified. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drawn_graph.h"
#include "host/lang/model.h"
#include "host/prove/reader.h"
#include "unity.h"

void suite_graph(void);

enum { NODES_MOST = 4000 };

static dice die;
static graph *g;
static int made[DRAWN_STEPS];
static drawn_graph drawn;
static double x[DRAWN_VARIABLES];

static void draw(void) {
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        x[i] = dice_between(&die, -2.0, 2.0);
    }
    drawn_graph_draw(&drawn, &die, x);
    g = graph_new();
    drawn_graph_nodes(&drawn, g, made);
}

/* A node's value at x, of which those from `first` on are zero. */
static long double worth(int which, int first) {
    static long double value[NODES_MOST];
    long double at[DRAWN_VARIABLES];
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        at[i] = i < first ? (long double)x[i] : 0.0L;
    }
    TEST_ASSERT_TRUE(which >= 0 && which < g->count && g->count <= NODES_MOST);
    drawn_graph_values(g, at, value);
    return value[which];
}

/* What the steps are there; with a tiny imaginary part of the variable `moved`, if there is one. */
static void series_at(int first, int moved, series *of) {
    series at[DRAWN_VARIABLES] = {{{0.0L}}};
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        at[i].at[0] =
            drawn_complex(i < first ? (long double)x[i] : 0.0L, i == moved ? DRAWN_TINY : 0.0L);
    }
    drawn_graph_series(&drawn, at, 0, of);
}

static void expect_near(const char *what, long double wanted, long double got, long double size) {
    TEST_ASSERT_TRUE_MESSAGE(fabsl(wanted - got) <= 1e-12L * (1.0L + fabsl(wanted) + size), what);
}

static void test_worth(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        series of[DRAWN_STEPS];
        draw();
        series_at(DRAWN_VARIABLES, -1, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            expect_near("worth", creall(of[i].at[0]), worth(made[i], DRAWN_VARIABLES), 0.0L);
        }
        graph_free(g);
    }
}

static void test_slopes(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 15)); c++) {
        series of[DRAWN_STEPS];
        draw();
        const int variable = (int)dice_one_of(&die, DRAWN_VARIABLES);
        series_at(DRAWN_VARIABLES, variable, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            const long double wanted = cimagl(of[i].at[0]) / DRAWN_TINY;
            const int slope = graph_slope(g, made[i], variable);
            TEST_ASSERT_EQUAL_INT(slope, graph_slope(g, made[i], variable));
            expect_near("a slope", wanted, worth(slope, DRAWN_VARIABLES), 0.0L);
        }
        graph_free(g);
    }
}

/* Is a variable from `first` on reached from the node? */
static bool reaches(int from, int first) {
    static bool wanted[NODES_MOST];
    bool found = false;
    for (int i = 0; i < g->count; i++) {
        wanted[i] = i == from;
    }
    for (int i = from; i >= 0; i--) {
        const node *n = &g->node[i];
        if (!wanted[i] || n->kind == NODE_NUMBER) {
            continue;
        }
        if (n->kind == NODE_VARIABLE) {
            found = found || n->left >= first;
            continue;
        }
        wanted[n->left] = true;
        if (n->right >= 0 && n->kind != NODE_SINE && n->kind != NODE_COSINE) {
            wanted[n->right] = true;
        }
    }
    return found;
}

static void test_without(void) {
    unsigned reached = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(40, 15)); c++) {
        series of[DRAWN_STEPS];
        draw();
        const int first = (int)dice_one_of(&die, DRAWN_VARIABLES);
        series_at(first, -1, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            const int without = graph_without(g, made[i], first);
            expect_near("without", creall(of[i].at[0]), worth(without, first), 0.0L);
            TEST_ASSERT_FALSE(reaches(without, first));
            if (reaches(made[i], first)) {
                reached++;
            } else {
                TEST_ASSERT_EQUAL_INT(made[i], without);
            }
        }
        graph_free(g);
    }
    TEST_ASSERT_TRUE(reached > 100);
}

/* The same once more makes no node; all are found, however many there are. */
static void test_one_node(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(20, 8)); c++) {
        int again[DRAWN_STEPS];
        draw();
        const int count = g->count;
        drawn_graph_nodes(&drawn, g, again);
        TEST_ASSERT_EQUAL_INT(count, g->count);
        TEST_ASSERT_EQUAL_INT_ARRAY(made, again, DRAWN_STEPS);
        for (int i = 0; i < count; i++) {
            for (int k = 0; k < i; k++) {
                const node *a = &g->node[i];
                const node *b = &g->node[k];
                TEST_ASSERT_FALSE(a->kind == b->kind && a->left == b->left &&
                                  a->right == b->right && a->number.low == b->number.low &&
                                  a->number.high == b->number.high);
            }
        }
        graph_free(g);
    }
    g = graph_new();
    int whole[2000];
    for (int i = 0; i < 2000; i++) {
        whole[i] = graph_whole(g, i - 1000);
        TEST_ASSERT_EQUAL_INT(i, whole[i]);
        TEST_ASSERT_TRUE(g->node[i].number.low == i - 1000.0 && g->room >= g->count &&
                         g->slots > g->count && (g->slots & (g->slots - 1)) == 0);
    }
    for (int i = 0; i < 2000; i++) {
        TEST_ASSERT_EQUAL_INT(whole[i], graph_whole(g, i - 1000));
    }
    TEST_ASSERT_EQUAL_INT(2000, g->count);
    /* ends that differ in one place only are two nodes */
    const int wide = graph_number(g, (enclosure){1.0, 2.0});
    TEST_ASSERT_TRUE(wide != graph_number(g, (enclosure){1.0, 3.0}) &&
                     wide != graph_number(g, (enclosure){0.5, 2.0}) && wide != graph_whole(g, 1) &&
                     wide != graph_whole(g, 2));
    TEST_ASSERT_FALSE(graph_is_one(g, wide));
    TEST_ASSERT_EQUAL_INT(graph_whole(g, 0), graph_number(g, enclosure_of(-0.0)));
    graph_free(g);
    graph_free(NULL);
}

/* What is true of all values is simplified, and only that. */
static void expect_simple(int a, int b) {
    const int zero = graph_whole(g, 0);
    const int one = graph_whole(g, 1);
    const int two = graph_whole(g, 2);
    TEST_ASSERT_TRUE(graph_is_zero(g, zero) && !graph_is_zero(g, one) && graph_is_one(g, one) &&
                     !graph_is_one(g, zero) && graph_is_number(g, two) && !graph_is_one(g, two));
    TEST_ASSERT_EQUAL_INT(a, graph_add(g, a, zero));
    TEST_ASSERT_EQUAL_INT(a, graph_add(g, zero, a));
    TEST_ASSERT_EQUAL_INT(a, graph_sub(g, a, zero));
    TEST_ASSERT_EQUAL_INT(graph_neg(g, a), graph_sub(g, zero, a));
    TEST_ASSERT_EQUAL_INT(zero, graph_sub(g, a, a));
    TEST_ASSERT_EQUAL_INT(graph_mul(g, two, a), graph_add(g, a, a));
    TEST_ASSERT_EQUAL_INT(graph_add(g, b, a), graph_add(g, a, b));
    TEST_ASSERT_EQUAL_INT(graph_mul(g, b, a), graph_mul(g, a, b));
    TEST_ASSERT_EQUAL_INT(zero, graph_mul(g, zero, a));
    TEST_ASSERT_EQUAL_INT(zero, graph_mul(g, a, zero));
    TEST_ASSERT_EQUAL_INT(a, graph_mul(g, one, a));
    TEST_ASSERT_EQUAL_INT(a, graph_mul(g, a, one));
    TEST_ASSERT_EQUAL_INT(zero, graph_div(g, zero, a));
    TEST_ASSERT_EQUAL_INT(one, graph_power(g, a, enclosure_of(0.0)));
    TEST_ASSERT_EQUAL_INT(a, graph_power(g, a, enclosure_of(1.0)));
    TEST_ASSERT_EQUAL_INT(graph_mul(g, a, a), graph_power(g, a, enclosure_of(2.0)));
    TEST_ASSERT_EQUAL_INT(graph_div(g, one, a), graph_power(g, a, enclosure_of(-1.0)));
}

static bool has_kind(node_kind kind) {
    bool has = false;
    for (int i = 0; i < g->count; i++) {
        has = has || g->node[i].kind == kind;
    }
    return has;
}

static void test_simple(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(20, 8)); c++) {
        draw();
        const int steps[] = {made[0], made[1], made[DRAWN_STEPS - 1], made[DRAWN_STEPS - 2]};
        for (int i = 0; i < 4; i++) {
            if (!graph_is_number(g, steps[i])) {
                expect_simple(steps[i], steps[(i + 1) % 4]);
            }
        }
        for (int i = 0; i < g->count; i++) { /* constants are in front of products, and but once */
            const node *n = &g->node[i];
            const node_kind left = n->kind == NODE_NUMBER || n->kind == NODE_VARIABLE
                                       ? NODE_VARIABLE
                                       : g->node[n->left].kind;
            TEST_ASSERT_FALSE(n->kind == NODE_MULTIPLE &&
                              (left == NODE_MULTIPLE || left == NODE_NUMBER));
            TEST_ASSERT_FALSE((n->kind == NODE_PRODUCT || n->kind == NODE_SQUARE) &&
                              (left == NODE_MULTIPLE || left == NODE_NUMBER));
            TEST_ASSERT_FALSE(n->kind == NODE_PRODUCT &&
                              (g->node[n->right].kind == NODE_MULTIPLE || n->left == n->right));
            TEST_ASSERT_FALSE(n->kind == NODE_RATIO && (g->node[n->right].kind == NODE_MULTIPLE ||
                                                        g->node[n->right].kind == NODE_NUMBER));
            const bool has_two = n->kind == NODE_SUM || n->kind == NODE_DIFFERENCE ||
                                 n->kind == NODE_PRODUCT || n->kind == NODE_RATIO ||
                                 n->kind == NODE_COSINE;
            TEST_ASSERT_TRUE(has_two ? n->right >= 0 : n->right == -1);
            if (n->kind == NODE_COSINE) {
                TEST_ASSERT_EQUAL_INT(i - 1, n->right);
                TEST_ASSERT_TRUE(g->node[i - 1].kind == NODE_SINE &&
                                 g->node[i - 1].left == n->left);
            }
            if (n->kind == NODE_SINE) {
                TEST_ASSERT_TRUE(i + 1 < g->count && g->node[i + 1].kind == NODE_COSINE);
            }
        }
        graph_free(g);
    }
}

/* Whole exponents up to 64 are multiplied out, in as few products as halving takes; none beyond, nor of what is no whole
 * number for certain. */
static void test_whole_powers(void) {
    for (int exponent = -70; exponent <= 70; exponent++) {
        g = graph_new();
        const int a = graph_variable(g, 0);
        const int power = graph_power(g, a, enclosure_of((double)exponent));
        const bool is_out = abs(exponent) <= 64;
        TEST_ASSERT_TRUE(has_kind(NODE_POWER) == !is_out);
        x[0] = 1.0625;
        expect_near("a power", powl(1.0625L, (long double)exponent), worth(power, 1), 0.0L);
        TEST_ASSERT_TRUE(g->count <= 2 + 2 * 7);
        graph_free(g);
    }
    static const enclosure exponents[] = {{0.5, 0.5}, {2.0, 2.5}, {1.5, 2.0}, {-2.5, -2.5}};
    for (int i = 0; i < 4; i++) {
        g = graph_new();
        (void)graph_power(g, graph_variable(g, 0), exponents[i]);
        TEST_ASSERT_TRUE(has_kind(NODE_POWER));
        graph_free(g);
    }
}

/* --- numbers -----------------------------------------------------------------------------------------------*/

static void expect_number(const char *what, int at, long double wanted) {
    TEST_ASSERT_TRUE_MESSAGE(graph_is_number(g, at), what);
    const enclosure a = g->node[at].number;
    const long double slack = 4e-19L * fabsl(wanted);
    TEST_ASSERT_TRUE_MESSAGE(
        (long double)a.low <= wanted + slack && wanted - slack <= (long double)a.high, what);
    TEST_ASSERT_TRUE_MESSAGE(
        (long double)a.high - (long double)a.low <= 1e-11L * fabsl(wanted) + 1e-300L, what);
}

/* What is made of numbers is one, and holds what long double makes of them. */
static void test_numbers(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(300, 100)); c++) {
        const double a = dice_between(&die, -5.0, 5.0);
        const double b = dice_between(&die, 0.5, 5.0);
        const long double p = (long double)a;
        const long double q = (long double)b;
        g = graph_new();
        const int i = graph_number(g, enclosure_of(a));
        const int k = graph_number(g, enclosure_of(b));
        expect_number("a sum", graph_add(g, i, k), p + q);
        expect_number("a difference", graph_sub(g, i, k), p - q);
        expect_number("a product", graph_mul(g, i, k), p * q);
        expect_number("a ratio", graph_div(g, i, k), p / q);
        expect_number("a sign", graph_neg(g, i), -p);
        expect_number("a sine", graph_sine(g, i), sinl(p));
        expect_number("a cosine", graph_cosine(g, i), cosl(p));
        expect_number("an exponential", graph_exp(g, i), expl(p));
        expect_number("a logarithm", graph_log(g, k), logl(q));
        expect_number("a power", graph_power(g, k, enclosure_of(a)), powl(q, p));
        const int variable = graph_variable(g, 0);
        const int shared = graph_mul(g, k, graph_mul(g, variable, i));
        TEST_ASSERT_EQUAL_INT(NODE_MULTIPLE, g->node[shared].kind);
        TEST_ASSERT_EQUAL_INT(variable, g->node[shared].left);
        graph_free(g);
    }
}

/* The number of a power's exponent as a file writes it, and the node that it is. */
static enclosure read_number(const char *written) {
    char text[400];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate X [rad]\nparameter n = 2\nparameter h = 1.5\n"
             "parameter p = %s\nT = 1 [kg*m^2]*X'^2\n",
             written);
    diags *errors = diags_new();
    whirl_model *model = model_parse("x.whirl", text, strlen(text), errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(model, written);
    instance *inst = instance_make(model->mechanisms[0], NULL, NULL, errors);
    int parameters[] = {-1, -1, -1};
    reader_symbols s = {.graph = g, .instance = inst, .parameter = parameters, .errors = errors};
    const int number = read_node(&s, model->mechanisms[0]->parameters[2]->value);
    TEST_ASSERT_TRUE_MESSAGE(number >= 0 && graph_is_number(g, number), written);
    instance_free(inst);
    model_free(model);
    diags_free(errors);
    return g->node[number].number;
}

/* Whole numbers stay whole through sums, products, quotients and powers that are whole. */
static void test_whole_numbers_stay_whole(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(300, 60)); c++) {
        const int a = 1 + (int)dice_one_of(&die, 12);
        const int b = 1 + (int)dice_one_of(&die, 9);
        const struct {
            const char *form;
            double value;
        } cases[] = {{"%d*%d", a * b},
                     {"%d + %d", a + b},
                     {"%d - %d", a - b},
                     {"n*%d + %d", 2 * a + b},
                     {"(%d*%d)/n", a * b / 2.0},
                     {"%d*h*%d*n", 3 * a * b},
                     {"sqrt(%d^2) + (%d^4)^0.5", a + b * b},
                     {"%d^2 - n^%d", a * a - pow(2.0, b)}};
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            char written[60];
            snprintf(written, sizeof written, cases[i].form, a, b); // NOLINT
            g = graph_new();
            const enclosure is = read_number(written);
            TEST_ASSERT_TRUE_MESSAGE(enclosure_is_point(is) && is.low == cases[i].value, written);
            graph_free(g);
        }
        /* what is no double must not become one */
        g = graph_new();
        const int part = graph_div(g, graph_whole(g, a), graph_whole(g, 7));
        TEST_ASSERT_EQUAL_INT(a % 7 == 0, enclosure_is_point(g->node[part].number));
        graph_free(g);
    }
}

/* Inverse functions of numbers hold what long double makes of them, within a few units of the last place. */
static void test_inverse_functions_of_numbers(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(200, 60)); c++) {
        const double u = dice_between(&die, -1.0, 1.0);
        const double v = dice_between(&die, -30.0, 30.0);
        const double w = dice_between(&die, -2.0, 2.0);
        const struct {
            const char *form;
            long double value;
        } cases[] = {{"asin(%.17g)", asinl((long double)u)},
                     {"acos(%.17g)", acosl((long double)u)},
                     {"atan(%.17g)", atanl((long double)v)},
                     {"atan2(%.17g, %.17g)", atan2l((long double)v, (long double)w)}};
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            char written[80];
            snprintf(written, sizeof written, cases[i].form, i < 2 ? u : v, w); // NOLINT
            g = graph_new();
            const enclosure is = read_number(written);
            const long double slack = 0x1p-60L;
            TEST_ASSERT_TRUE_MESSAGE((long double)is.low <= cases[i].value + slack &&
                                         cases[i].value - slack <= (long double)is.high,
                                     written);
            TEST_ASSERT_TRUE_MESSAGE(is.high - is.low <= 1e-6, written);
            graph_free(g);
        }
    }
}

void suite_graph(void) {
    die = dice_of("graph", 41);
    RUN_TEST(test_worth);
    RUN_TEST(test_slopes);
    RUN_TEST(test_without);
    RUN_TEST(test_one_node);
    RUN_TEST(test_simple);
    RUN_TEST(test_whole_powers);
    RUN_TEST(test_numbers);
    RUN_TEST(test_whole_numbers_stay_whole);
    RUN_TEST(test_inverse_functions_of_numbers);
}
