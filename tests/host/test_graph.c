/* test_graph.c: random expressions as a graph (host/prove/graph.h): values of the nodes, slopes compared with
 * complex-step derivatives, graphs without some variables, one node for equal expressions, and simplification. Also
 * the reader of a model's expressions, and Taylor coefficients. */
#include "host/base/alloc.h"
#include "host/lang/model.h"
#include "host/prove/graph.h"
#include "host/prove/taylor.h"

#include "command.h"
#include "derived.h"
#include <complex.h>

/* Random expressions as sequences of steps, as nodes of a graph (host/prove/graph.h), and as truncated series in
 * long double. The series of a function is the sum of its derivatives over factorials, times powers of the
 * argument's series without its first coefficient; the program uses recurrences instead. Numbers are complex: a tiny
 * imaginary part of a variable gives the slope without a difference (complex-step derivative). */

enum { DRAWN_VARIABLES = 3, DRAWN_STEPS = 20, DRAWN_ORDER = 7 };

/* Imaginary part that a variable gets for its slope. */
#define DRAWN_TINY 1e-30L

/* Kinds of steps, with the operands u and v. Each step has a value everywhere: the logarithm, for example, is log(2
 * + u^2). */
typedef enum drawn_kind {
    DRAWN_NUMBER,
    DRAWN_SUM,
    DRAWN_DIFFERENCE,
    DRAWN_PRODUCT,
    DRAWN_NEGATED,
    DRAWN_RATIO, /* u / (2.5 + cos v) */
    DRAWN_SINE,
    DRAWN_COSINE,
    DRAWN_EXP,   /* e^(u/4) */
    DRAWN_LOG,   /* log(2 + u^2) */
    DRAWN_POWER, /* (2 + u^2)^number */
    DRAWN_WHOLE, /* u^number, with a positive integer */
    DRAWN_KINDS
} drawn_kind;

typedef struct drawn_step {
    drawn_kind kind;
    int left; /* first operand; the first steps are the variables and have none */
    int right;
    double number;
} drawn_step;

typedef struct drawn_graph {
    drawn_step step[DRAWN_STEPS];
} drawn_graph;

typedef struct series {
    long double complex at[DRAWN_ORDER + 1];
} series;

static inline long double complex drawn_complex(long double real, long double imaginary) {
    return real + imaginary * (long double complex)I;
}

typedef long double complex complex_number;

static complex_number turned(long double size, long double angle) {
    return drawn_complex(size * cosl(angle), size * sinl(angle));
}

static complex_number exponential(complex_number a) { return turned(expl(creall(a)), cimagl(a)); }

static complex_number logarithm(complex_number a) {
    return drawn_complex(logl(hypotl(creall(a), cimagl(a))), atan2l(cimagl(a), creall(a)));
}

static complex_number sine(complex_number a) {
    return drawn_complex(sinl(creall(a)) * coshl(cimagl(a)), cosl(creall(a)) * sinhl(cimagl(a)));
}

static complex_number cosine(complex_number a) {
    return drawn_complex(cosl(creall(a)) * coshl(cimagl(a)), -sinl(creall(a)) * sinhl(cimagl(a)));
}

/* outer[n] is the n-th derivative at a, divided by n!. */
static void derivatives(drawn_kind kind, complex_number a, long double exponent, int order,
                        complex_number *outer) {
    long double factorial = 1.0L;
    complex_number power = kind == DRAWN_POWER ? exponential(exponent * logarithm(a)) : 1.0L;
    for (int n = 0; n <= order; n++) {
        factorial *= n > 0 ? (long double)n : 1.0L;
        const long double sign = n % 4 < 2 ? 1.0L : -1.0L;
        switch (kind) {
        case DRAWN_SINE: outer[n] = sign * (n % 2 == 0 ? sine(a) : cosine(a)) / factorial; break;
        case DRAWN_COSINE:
            outer[n] = (n % 4 == 1 || n % 4 == 2 ? -1.0L : 1.0L) *
                       (n % 2 == 0 ? cosine(a) : sine(a)) / factorial;
            break;
        case DRAWN_EXP: outer[n] = exponential(a) / factorial; break;
        case DRAWN_LOG:
            power = n > 0 ? power / a : power;
            outer[n] = n == 0 ? logarithm(a) : (n % 2 == 0 ? -1.0L : 1.0L) * power / (long double)n;
            break;
        case DRAWN_RATIO: /* the function 1/a */
            power = power / a;
            outer[n] = (n % 2 == 0 ? 1.0L : -1.0L) * power;
            break;
        case DRAWN_POWER:
            outer[n] = power;
            power *= (exponent - (long double)n) / ((long double)(n + 1) * a);
            break;
        case DRAWN_NUMBER:
        case DRAWN_SUM:
        case DRAWN_DIFFERENCE:
        case DRAWN_PRODUCT:
        case DRAWN_NEGATED:
        case DRAWN_WHOLE:
        case DRAWN_KINDS: TEST_FAIL_MESSAGE("no function of one number");
        }
    }
}

static series constant(long double value) { return (series){.at = {value}}; }

static series sum(series a, long double times, series b) {
    for (int k = 0; k <= DRAWN_ORDER; k++) {
        a.at[k] += times * b.at[k];
    }
    return a;
}

static series product(const series *a, const series *b, int order) {
    series of = {.at = {0.0L}};
    for (int k = 0; k <= order; k++) {
        for (int j = 0; j <= k; j++) {
            of.at[k] += a->at[j] * b->at[k - j];
        }
    }
    return of;
}

static series composed(drawn_kind kind, series u, long double exponent, int order) {
    complex_number outer[DRAWN_ORDER + 1];
    derivatives(kind, u.at[0], exponent, order, outer);
    series of = constant(0.0L);
    u.at[0] = 0.0L;
    for (int n = order; n >= 0; n--) { /* by Horner's scheme */
        of = product(&of, &u, order);
        of.at[0] += outer[n];
    }
    return of;
}

static series above_two(const series *u, int order) {
    return sum(product(u, u, order), 2.0L, constant(1.0L));
}

static series step_series(const drawn_step *s, const series *of, int order) {
    const series u = of[s->left];
    const series v = of[s->right];
    switch (s->kind) {
    case DRAWN_NUMBER: return constant((long double)s->number);
    case DRAWN_SUM: return sum(u, 1.0L, v);
    case DRAWN_DIFFERENCE: return sum(u, -1.0L, v);
    case DRAWN_PRODUCT: return product(&u, &v, order);
    case DRAWN_NEGATED: return sum(constant(0.0L), -1.0L, u);
    case DRAWN_RATIO: {
        const series below = sum(composed(DRAWN_COSINE, v, 0.0L, order), 2.5L, constant(1.0L));
        const series reciprocal = composed(DRAWN_RATIO, below, 0.0L, order);
        return product(&u, &reciprocal, order);
    }
    case DRAWN_SINE:
    case DRAWN_COSINE: return composed(s->kind, u, 0.0L, order);
    case DRAWN_EXP: return composed(DRAWN_EXP, sum(constant(0.0L), 0.25L, u), 0.0L, order);
    case DRAWN_LOG: return composed(DRAWN_LOG, above_two(&u, order), 0.0L, order);
    case DRAWN_POWER:
        return composed(DRAWN_POWER, above_two(&u, order), (long double)s->number, order);
    case DRAWN_WHOLE: {
        series power = constant(1.0L);
        for (int n = 0; n < (int)s->number; n++) {
            power = product(&power, &u, order);
        }
        return power;
    }
    case DRAWN_KINDS: break;
    }
    TEST_FAIL_MESSAGE("no step");
    return u;
}

/* Computes the series of each step, of[DRAWN_STEPS], up to this order. x[DRAWN_VARIABLES] has the series of the
 * variables. */
static void drawn_graph_series(const drawn_graph *d, const series *x, int order, series *of) {
    for (int i = 0; i < DRAWN_STEPS; i++) {
        of[i] = i < DRAWN_VARIABLES ? x[i] : step_series(&d->step[i], of, order);
    }
}

/* Draws an expression that has every kind of step. Its values near x[DRAWN_VARIABLES] stay moderate. */
static void drawn_graph_draw(drawn_graph *d, dice *die, const double *x) {
    static const double exponents[] = {0.5, -0.5, 1.25, -2.0, 3.0, -1.0};
    series of[DRAWN_STEPS];
    int next_kind = (int)dice_one_of(die, DRAWN_KINDS);
    for (int i = 0; i < DRAWN_STEPS; i++) {
        drawn_step *s = &d->step[i];
        if (i < DRAWN_VARIABLES) {
            *s = (drawn_step){.kind = DRAWN_NUMBER};
            of[i] = constant((long double)x[i]);
            continue;
        }
        *s = (drawn_step){.kind = (drawn_kind)(next_kind++ % DRAWN_KINDS),
                          .left = (int)dice_one_of(die, (unsigned)i),
                          .right = (int)dice_one_of(die, (unsigned)i)};
        s->number = s->kind == DRAWN_NUMBER  ? dice_between(die, -2.0, 2.0)
                    : s->kind == DRAWN_WHOLE ? (double)(1 + dice_one_of(die, 6))
                                             : exponents[dice_one_of(die, 6)];
        of[i] = step_series(s, of, 0);
        if (fabsl(creall(of[i].at[0])) > 4.0L) {
            s->kind = DRAWN_SINE;
            of[i] = step_series(s, of, 0);
        }
    }
}

static int point(graph *g, double value) { return graph_number(g, enclosure_of(value)); }

static int step_node(const drawn_step *s, graph *g, const int *made) {
    const int u = made[s->left];
    const int v = made[s->right];
    switch (s->kind) {
    case DRAWN_NUMBER: return point(g, s->number);
    case DRAWN_SUM: return graph_add(g, u, v);
    case DRAWN_DIFFERENCE: return graph_sub(g, u, v);
    case DRAWN_PRODUCT: return graph_mul(g, u, v);
    case DRAWN_NEGATED: return graph_neg(g, u);
    case DRAWN_RATIO: return graph_div(g, u, graph_add(g, graph_cosine(g, v), point(g, 2.5)));
    case DRAWN_SINE: return graph_sine(g, u);
    case DRAWN_COSINE: return graph_cosine(g, u);
    case DRAWN_EXP: return graph_exp(g, graph_div(g, u, point(g, 4.0)));
    case DRAWN_LOG: return graph_log(g, graph_add(g, graph_mul(g, u, u), point(g, 2.0)));
    case DRAWN_POWER:
        return graph_power(g, graph_add(g, graph_mul(g, u, u), point(g, 2.0)),
                           enclosure_of(s->number));
    case DRAWN_WHOLE: return graph_power(g, u, enclosure_of(s->number));
    case DRAWN_KINDS: break;
    }
    TEST_FAIL_MESSAGE("no step");
    return -1;
}

/* Adds the expression to an empty graph. made[DRAWN_STEPS] are the numbers of its nodes; the variables are nodes 0
 * to DRAWN_VARIABLES - 1. */
static void drawn_graph_nodes(const drawn_graph *d, graph *g, int *made) {
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        made[i] = graph_variable(g, i);
        TEST_ASSERT_EQUAL_INT(i, made[i]);
    }
    for (int i = DRAWN_VARIABLES; i < DRAWN_STEPS; i++) {
        made[i] = step_node(&d->step[i], g, made);
    }
}

static long double middle(enclosure a) { return ((long double)a.low + (long double)a.high) / 2.0L; }

/* Computes the values of a graph's nodes, value[g->count]. A number counts as the middle of its enclosure. */
static void drawn_graph_values(const graph *g, const long double *x, long double *value) {
    for (int i = 0; i < g->count; i++) {
        const node *n = &g->node[i];
        const bool is_leaf = n->kind == NODE_NUMBER || n->kind == NODE_VARIABLE;
        TEST_ASSERT_TRUE_MESSAGE(is_leaf || (n->left >= 0 && n->left < i), "operands before");
        const long double u = is_leaf ? 0.0L : value[n->left];
        const long double v = !is_leaf && n->right >= 0 && n->right < i ? value[n->right] : 0.0L;
        switch (n->kind) {
        case NODE_NUMBER: value[i] = middle(n->number); break;
        case NODE_VARIABLE: value[i] = x[n->left]; break;
        case NODE_SUM: value[i] = u + v; break;
        case NODE_DIFFERENCE: value[i] = u - v; break;
        case NODE_PRODUCT: value[i] = u * v; break;
        case NODE_MULTIPLE: value[i] = middle(n->number) * u; break;
        case NODE_SQUARE: value[i] = u * u; break;
        case NODE_RATIO: value[i] = u / v; break;
        case NODE_SINE: value[i] = sinl(u); break;
        case NODE_COSINE: value[i] = cosl(u); break;
        case NODE_EXP: value[i] = expl(u); break;
        case NODE_LOG: value[i] = logl(u); break;
        case NODE_POWER: value[i] = powl(u, middle(n->number)); break;
        }
    }
}

/* === suite graph ============================================================================== */

enum { NODES_MOST = 4000 };

static dice die;
static graph *g_graph;
static int made_graph[DRAWN_STEPS];
static drawn_graph drawn;
static double x_graph[DRAWN_VARIABLES];

static void draw(void) {
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        x_graph[i] = dice_between(&die, -2.0, 2.0);
    }
    drawn_graph_draw(&drawn, &die, x_graph);
    g_graph = graph_new();
    drawn_graph_nodes(&drawn, g_graph, made_graph);
}

/* The value of a node at x_graph, if the variables from number `first` on are zero. */
static long double worth(int which, int first) {
    static long double value[NODES_MOST];
    long double at[DRAWN_VARIABLES];
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        at[i] = i < first ? (long double)x_graph[i] : 0.0L;
    }
    TEST_ASSERT_TRUE(which >= 0 && which < g_graph->count && g_graph->count <= NODES_MOST);
    drawn_graph_values(g_graph, at, value);
    return value[which];
}

/* The series of the steps at x_graph, if the variables from `first` on are zero. Variable `moved` has a tiny
 * imaginary part; -1: none. */
static void series_at(int first, int moved, series *of) {
    series at[DRAWN_VARIABLES] = {{{0.0L}}};
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        at[i].at[0] = drawn_complex(i < first ? (long double)x_graph[i] : 0.0L,
                                    i == moved ? DRAWN_TINY : 0.0L);
    }
    drawn_graph_series(&drawn, at, 0, of);
}

static void expect_near(const char *what, long double wanted, long double got, long double size) {
    TEST_ASSERT_TRUE_MESSAGE(fabsl(wanted - got) <= 1e-12L * (1.0L + fabsl(wanted) + size), what);
}

TEST(graph, worth) {
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        series of[DRAWN_STEPS];
        draw();
        series_at(DRAWN_VARIABLES, -1, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            expect_near("worth", creall(of[i].at[0]), worth(made_graph[i], DRAWN_VARIABLES), 0.0L);
        }
        graph_free(g_graph);
    }
}

TEST(graph, slopes) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 15)); c++) {
        series of[DRAWN_STEPS];
        draw();
        const int variable = (int)dice_one_of(&die, DRAWN_VARIABLES);
        series_at(DRAWN_VARIABLES, variable, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            const long double wanted = cimagl(of[i].at[0]) / DRAWN_TINY;
            const int slope = graph_slope(g_graph, made_graph[i], variable);
            TEST_ASSERT_EQUAL_INT(slope, graph_slope(g_graph, made_graph[i], variable));
            expect_near("a slope", wanted, worth(slope, DRAWN_VARIABLES), 0.0L);
        }
        graph_free(g_graph);
    }
}

/* Does the node depend on a variable with number `first` or higher? */
static bool reaches(int from, int first) {
    static bool wanted[NODES_MOST];
    bool found = false;
    for (int i = 0; i < g_graph->count; i++) {
        wanted[i] = i == from;
    }
    for (int i = from; i >= 0; i--) {
        const node *n = &g_graph->node[i];
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

TEST(graph, without) {
    unsigned reached = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(40, 15)); c++) {
        series of[DRAWN_STEPS];
        draw();
        const int first = (int)dice_one_of(&die, DRAWN_VARIABLES);
        series_at(first, -1, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            const int without = graph_without(g_graph, made_graph[i], first);
            expect_near("without", creall(of[i].at[0]), worth(without, first), 0.0L);
            TEST_ASSERT_FALSE(reaches(without, first));
            if (reaches(made_graph[i], first)) {
                reached++;
            } else {
                TEST_ASSERT_EQUAL_INT(made_graph[i], without);
            }
        }
        graph_free(g_graph);
    }
    TEST_ASSERT_TRUE(reached > 100);
}

/* If an expression is built again, each of its steps must give its earlier node. */
TEST(graph, one_node) {
    for (unsigned c = 0; c < dice_cases(usual_or(20, 8)); c++) {
        int again[DRAWN_STEPS];
        draw();
        const int count = g_graph->count;
        drawn_graph_nodes(&drawn, g_graph, again);
        TEST_ASSERT_EQUAL_INT(count, g_graph->count);
        TEST_ASSERT_EQUAL_INT_ARRAY(made_graph, again, DRAWN_STEPS);
        for (int i = 0; i < count; i++) {
            for (int k = 0; k < i; k++) {
                const node *a = &g_graph->node[i];
                const node *b = &g_graph->node[k];
                TEST_ASSERT_FALSE(a->kind == b->kind && a->left == b->left &&
                                  a->right == b->right && a->number.low == b->number.low &&
                                  a->number.high == b->number.high);
            }
        }
        graph_free(g_graph);
    }
    g_graph = graph_new();
    int whole[2000];
    for (int i = 0; i < 2000; i++) {
        whole[i] = graph_whole(g_graph, i - 1000);
        TEST_ASSERT_EQUAL_INT(i, whole[i]);
        TEST_ASSERT_TRUE(g_graph->node[i].number.low == i - 1000.0 &&
                         g_graph->room >= g_graph->count && g_graph->slots > g_graph->count &&
                         (g_graph->slots & (g_graph->slots - 1)) == 0);
    }
    for (int i = 0; i < 2000; i++) {
        TEST_ASSERT_EQUAL_INT(whole[i], graph_whole(g_graph, i - 1000));
    }
    TEST_ASSERT_EQUAL_INT(2000, g_graph->count);
    /* numbers with enclosures that differ in one end must be two nodes */
    const int wide = graph_number(g_graph, (enclosure){1.0, 2.0});
    TEST_ASSERT_TRUE(wide != graph_number(g_graph, (enclosure){1.0, 3.0}) &&
                     wide != graph_number(g_graph, (enclosure){0.5, 2.0}) &&
                     wide != graph_whole(g_graph, 1) && wide != graph_whole(g_graph, 2));
    TEST_ASSERT_EQUAL_INT(graph_whole(g_graph, 0), graph_number(g_graph, enclosure_of(-0.0)));
    graph_free(g_graph);
    graph_free(NULL);
}

/* Only what holds for all values may be simplified. */
static void expect_simple(int a, int b) {
    const int zero = graph_whole(g_graph, 0);
    const int one = graph_whole(g_graph, 1);
    const int two = graph_whole(g_graph, 2);
    TEST_ASSERT_TRUE(graph_is_zero(g_graph, zero) && !graph_is_zero(g_graph, one) &&
                     graph_is_number(g_graph, two));
    TEST_ASSERT_EQUAL_INT(a, graph_add(g_graph, a, zero));
    TEST_ASSERT_EQUAL_INT(a, graph_add(g_graph, zero, a));
    TEST_ASSERT_EQUAL_INT(a, graph_sub(g_graph, a, zero));
    TEST_ASSERT_EQUAL_INT(graph_neg(g_graph, a), graph_sub(g_graph, zero, a));
    TEST_ASSERT_EQUAL_INT(zero, graph_sub(g_graph, a, a));
    TEST_ASSERT_EQUAL_INT(graph_mul(g_graph, two, a), graph_add(g_graph, a, a));
    TEST_ASSERT_EQUAL_INT(graph_add(g_graph, b, a), graph_add(g_graph, a, b));
    TEST_ASSERT_EQUAL_INT(graph_mul(g_graph, b, a), graph_mul(g_graph, a, b));
    TEST_ASSERT_EQUAL_INT(zero, graph_mul(g_graph, zero, a));
    TEST_ASSERT_EQUAL_INT(zero, graph_mul(g_graph, a, zero));
    TEST_ASSERT_EQUAL_INT(a, graph_mul(g_graph, one, a));
    TEST_ASSERT_EQUAL_INT(a, graph_mul(g_graph, a, one));
    TEST_ASSERT_EQUAL_INT(zero, graph_div(g_graph, zero, a));
    TEST_ASSERT_EQUAL_INT(one, graph_power(g_graph, a, enclosure_of(0.0)));
    TEST_ASSERT_EQUAL_INT(a, graph_power(g_graph, a, enclosure_of(1.0)));
    TEST_ASSERT_EQUAL_INT(graph_mul(g_graph, a, a), graph_power(g_graph, a, enclosure_of(2.0)));
    TEST_ASSERT_EQUAL_INT(graph_div(g_graph, one, a), graph_power(g_graph, a, enclosure_of(-1.0)));
}

static bool has_kind(node_kind kind) {
    bool has = false;
    for (int i = 0; i < g_graph->count; i++) {
        has = has || g_graph->node[i].kind == kind;
    }
    return has;
}

TEST(graph, simple) {
    for (unsigned c = 0; c < dice_cases(usual_or(20, 8)); c++) {
        draw();
        const int steps[] = {made_graph[0], made_graph[1], made_graph[DRAWN_STEPS - 1],
                             made_graph[DRAWN_STEPS - 2]};
        for (int i = 0; i < 4; i++) {
            if (!graph_is_number(g_graph, steps[i])) {
                expect_simple(steps[i], steps[(i + 1) % 4]);
            }
        }
        for (int i = 0; i < g_graph->count; i++) { /* a product has one constant, in front */
            const node *n = &g_graph->node[i];
            const node_kind left = n->kind == NODE_NUMBER || n->kind == NODE_VARIABLE
                                       ? NODE_VARIABLE
                                       : g_graph->node[n->left].kind;
            TEST_ASSERT_FALSE(n->kind == NODE_MULTIPLE &&
                              (left == NODE_MULTIPLE || left == NODE_NUMBER));
            TEST_ASSERT_FALSE((n->kind == NODE_PRODUCT || n->kind == NODE_SQUARE) &&
                              (left == NODE_MULTIPLE || left == NODE_NUMBER));
            TEST_ASSERT_FALSE(
                n->kind == NODE_PRODUCT &&
                (g_graph->node[n->right].kind == NODE_MULTIPLE || n->left == n->right));
            TEST_ASSERT_FALSE(n->kind == NODE_RATIO &&
                              (g_graph->node[n->right].kind == NODE_MULTIPLE ||
                               g_graph->node[n->right].kind == NODE_NUMBER));
            const bool has_two = n->kind == NODE_SUM || n->kind == NODE_DIFFERENCE ||
                                 n->kind == NODE_PRODUCT || n->kind == NODE_RATIO ||
                                 n->kind == NODE_COSINE;
            TEST_ASSERT_TRUE(has_two ? n->right >= 0 : n->right == -1);
            if (n->kind == NODE_COSINE) {
                TEST_ASSERT_EQUAL_INT(i - 1, n->right);
                TEST_ASSERT_TRUE(g_graph->node[i - 1].kind == NODE_SINE &&
                                 g_graph->node[i - 1].left == n->left);
            }
            if (n->kind == NODE_SINE) {
                TEST_ASSERT_TRUE(i + 1 < g_graph->count &&
                                 g_graph->node[i + 1].kind == NODE_COSINE);
            }
        }
        graph_free(g_graph);
    }
}

/* Powers with integer exponents up to 64 must become products, by repeated halving. Other exponents must stay
 * powers, and so must an exponent whose enclosure has more than one integer. */
TEST(graph, whole_powers) {
    for (int exponent = -70; exponent <= 70; exponent++) {
        g_graph = graph_new();
        const int a = graph_variable(g_graph, 0);
        const int power = graph_power(g_graph, a, enclosure_of((double)exponent));
        const bool is_out = abs(exponent) <= 64;
        TEST_ASSERT_TRUE(has_kind(NODE_POWER) == !is_out);
        x_graph[0] = 1.0625;
        expect_near("a power", powl(1.0625L, (long double)exponent), worth(power, 1), 0.0L);
        TEST_ASSERT_TRUE(g_graph->count <= 2 + 2 * 7);
        graph_free(g_graph);
    }
    static const enclosure exponents[] = {{0.5, 0.5}, {2.0, 2.5}, {1.5, 2.0}, {-2.5, -2.5}};
    for (int i = 0; i < 4; i++) {
        g_graph = graph_new();
        (void)graph_power(g_graph, graph_variable(g_graph, 0), exponents[i]);
        TEST_ASSERT_TRUE(has_kind(NODE_POWER));
        graph_free(g_graph);
    }
}

static void expect_number(const char *what, int at, long double wanted) {
    TEST_ASSERT_TRUE_MESSAGE(graph_is_number(g_graph, at), what);
    const enclosure a = g_graph->node[at].number;
    const long double slack = 4e-19L * fabsl(wanted);
    TEST_ASSERT_TRUE_MESSAGE(
        (long double)a.low <= wanted + slack && wanted - slack <= (long double)a.high, what);
    TEST_ASSERT_TRUE_MESSAGE(
        (long double)a.high - (long double)a.low <= 1e-11L * fabsl(wanted) + 1e-300L, what);
}

/* An operation on numbers must give a number that encloses the result in long double. */
TEST(graph, numbers) {
    for (unsigned c = 0; c < dice_cases(usual_or(300, 100)); c++) {
        const double a = dice_between(&die, -5.0, 5.0);
        const double b = dice_between(&die, 0.5, 5.0);
        const long double p = (long double)a;
        const long double q = (long double)b;
        g_graph = graph_new();
        const int i = graph_number(g_graph, enclosure_of(a));
        const int k = graph_number(g_graph, enclosure_of(b));
        expect_number("a sum", graph_add(g_graph, i, k), p + q);
        expect_number("a difference", graph_sub(g_graph, i, k), p - q);
        expect_number("a product", graph_mul(g_graph, i, k), p * q);
        expect_number("a ratio", graph_div(g_graph, i, k), p / q);
        expect_number("a sign", graph_neg(g_graph, i), -p);
        expect_number("a sine", graph_sine(g_graph, i), sinl(p));
        expect_number("a cosine", graph_cosine(g_graph, i), cosl(p));
        const double wide = 60.0 * a;
        const double far = ldexp(b, (int)(20.0 * a));
        expect_number("an exponential",
                      graph_exp(g_graph, graph_number(g_graph, enclosure_of(wide))),
                      expl((long double)wide));
        expect_number("a logarithm", graph_log(g_graph, graph_number(g_graph, enclosure_of(far))),
                      logl((long double)far));
        expect_number("a power", graph_power(g_graph, k, enclosure_of(a)), powl(q, p));
        const int variable = graph_variable(g_graph, 0);
        const int shared = graph_mul(g_graph, k, graph_mul(g_graph, variable, i));
        TEST_ASSERT_EQUAL_INT(NODE_MULTIPLE, g_graph->node[shared].kind);
        TEST_ASSERT_EQUAL_INT(variable, g_graph->node[shared].left);
        graph_free(g_graph);
    }
}

/* Parses a number as the exponent of a power in a file, and returns its enclosure. */
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
    reader_symbols s = {
        .graph = g_graph, .instance = inst, .parameter = parameters, .errors = errors};
    const int number = read_node(&s, model->mechanisms[0]->parameters[2]->value);
    TEST_ASSERT_TRUE_MESSAGE(number >= 0 && graph_is_number(g_graph, number), written);
    instance_free(inst);
    model_free(model);
    diags_free(errors);
    return g_graph->node[number].number;
}

TEST(graph, whole_numbers_stay_whole) {
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
            g_graph = graph_new();
            const enclosure is = read_number(written);
            TEST_ASSERT_TRUE_MESSAGE(enclosure_is_point(is) && is.low == cases[i].value, written);
            graph_free(g_graph);
        }
        /* a decimal fraction must be an enclosure, not one double */
        g_graph = graph_new();
        const int part = graph_div(g_graph, graph_whole(g_graph, a), graph_whole(g_graph, 7));
        TEST_ASSERT_EQUAL_INT(a % 7 == 0, enclosure_is_point(g_graph->node[part].number));
        graph_free(g_graph);
    }
}

SUITE(graph) { die = dice_of("graph", 41); }

/* === suite reader ============================================================================= */
/* A model's expressions as nodes of a graph (host/prove/graph.h). Random formulas must have their long double
 * values, numbers must be enclosures, and derivatives must be the right variables. A function that is not supported
 * must be reported once, at its place. */

enum { LETS = 24, NUMBERS = 4, TEXT_SIZE = 6000, VARIABLES = 7 };

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

/* Opens a text with the states a (second order) and b (first order). The variables are a, a', b, then the highest
 * derivatives a'' and b'. */
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

/* Leaves of the formulas: states and their derivatives (times seconds), an input, parameters, and earlier lets. */
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

/* Writes formula number `which` of u and v. Returns its value for u = x, v = y. A function with corners is used with
 * numbers only. */
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
        if (d.is_number[i]) { /* hundredths: no double equals such a decimal */
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

TEST(reader, worth_reader) {
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

static enclosure number_of(const char *formula) {
    char text[500];
    /* z is an enclosure of zero, w an enclosure of a tenth */
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
    const double slack = strstr(formula, "-w") != NULL ? 4e-17 : 0.0; /* w times -1 is rounded */
    TEST_ASSERT_TRUE_MESSAGE(e.low <= low && low - e.low <= slack, formula);
    TEST_ASSERT_TRUE_MESSAGE(e.high >= high && e.high - high <= slack, formula);
}

TEST(reader, corners) {
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

/* Fails the test if the function is not reported exactly once, with its name, in line 6 at the column of its call. */
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
    snprintf(
        wanted, sizeof wanted,
        "x.whirl:6:%d: error: whirl prove has no bounds for %s of a quantity that changes in the run\n",
        (int)(strstr(formula, name) - formula) + 9, name);
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told, strlen(wanted));
    TEST_ASSERT_NOT_NULL(strstr(told, "hint: use whirl trust, which estimates the error"));
    free(told);
    close_text();
}

TEST(reader, refused) {
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
            if (!is_other) {
                /* no other call of the function comes before this one */
                expect_refused(formula, refused[i][1]);
            }
        }
    }
}

/* An output that uses another output is refused, because outputs have no value during a proof. */
TEST(reader, outputs) {
    char *told = NULL;
    size_t length = 0;
    open_text(HEAD "output o = a\noutput p = 2*o\n");
    TEST_ASSERT_EQUAL_INT(-1, read_node(&r.symbols, r.of->outputs[1]->value));
    FILE *out = alloc_text(&told, &length);
    diags_flush(r.errors, out);
    alloc_text_end(out);
    const char wanted[] =
        "x.whirl:7:14: error: whirl prove has no bounds for an output of a quantity that changes in the run\n";
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told, strlen(wanted));
    free(told);
    close_text();
}

SUITE(reader) { die = dice_of("reader", 53); }

/* === suite taylor ============================================================================= */
/* Taylor coefficients of random motions in enclosures (host/prove/taylor.h), and their slopes by the state, compared
 * with long double series by another method (drawn_graph_series). At a point the enclosures must be narrow; in a box
 * they must hold for every start. */

static int rate_step[DRAWN_VARIABLES]; /* the step that is the variable's rate */

typedef struct drawn_motion {
    graph *graph;
    int rate[DRAWN_VARIABLES];
    exact_motion of;
} drawn_motion;

static void draw_taylor(drawn_motion *m) {
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        x_graph[i] = dice_between(&die, -1.5, 1.5);
    }
    drawn_graph_draw(&drawn, &die, x_graph);
    m->graph = graph_new();
    drawn_graph_nodes(&drawn, m->graph, made_graph);
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        rate_step[i] = DRAWN_STEPS - 1 - i;
        m->rate[i] = made_graph[rate_step[i]];
    }
    m->of = (exact_motion){.states = DRAWN_VARIABLES,
                           .rate = m->rate,
                           .node = m->graph->node,
                           .nodes = m->graph->count};
}

/* The series of all steps along the motion from this state. State `moved` has a tiny imaginary part; -1: none. */
static void along(const double *from, int moved, int order, series *of) {
    series at[DRAWN_VARIABLES] = {{{0.0L}}};
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        at[i].at[0] = drawn_complex((long double)from[i], i == moved ? DRAWN_TINY : 0.0L);
    }
    for (int k = 0; k <= order; k++) {
        drawn_graph_series(&drawn, at, k, of);
        for (int i = 0; i < DRAWN_VARIABLES && k < order; i++) {
            at[i].at[k + 1] = of[rate_step[i]].at[k] / (long double)(k + 1);
        }
    }
}

static void expect_held(const char *what, enclosure a, long double wanted, long double size) {
    const long double slack = 1e-15L * size;
    TEST_ASSERT_TRUE_MESSAGE(
        (long double)a.low <= wanted + slack && wanted - slack <= (long double)a.high, what);
}

/* The largest absolute coefficient up to order k, at least 1. */
static long double size_of(const series *s, int k) {
    long double size = 1.0L;
    for (int i = 0; i <= k; i++) {
        size = fmaxl(size, fabsl(creall(s->at[i])));
    }
    return size;
}

TEST(taylor, at_a_point) {
    for (unsigned c = 0; c < dice_cases(usual_or(25, 8)); c++) {
        drawn_motion m;
        series of[DRAWN_STEPS];
        enclosure at[DRAWN_VARIABLES];
        draw_taylor(&m);
        const int order = 1 + (int)dice_one_of(&die, DRAWN_ORDER);
        const int slopes_to = (int)dice_one_of(&die, (unsigned)order + 2) - 1;
        taylor *t = taylor_new(&m.of, order, slopes_to);
        TEST_ASSERT_EQUAL_INT(slopes_to < 0 ? 1 : 1 + DRAWN_VARIABLES, t->width);
        for (int i = 0; i < DRAWN_VARIABLES; i++) {
            at[i] = enclosure_of(x_graph[i]);
        }
        for (int again = 0; again < 2; again++) { /* an earlier call must not change the result */
            TEST_ASSERT_TRUE(taylor_find(t, at));
        }
        along(x_graph, -1, order, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            for (int k = 0; k <= order; k++) {
                const enclosure got = taylor_of(t, made_graph[i], k)[0];
                const long double size = size_of(&of[i], k);
                expect_held("a coefficient", got, creall(of[i].at[k]), size);
                TEST_ASSERT_TRUE_MESSAGE(
                    (long double)got.high - (long double)got.low <= 1e-8L * size, "narrow");
            }
        }
        for (int j = 0; j < DRAWN_VARIABLES; j++) {
            along(x_graph, j, order, of);
            for (int i = 0; i < DRAWN_STEPS; i++) {
                for (int k = 0; k <= slopes_to; k++) {
                    const enclosure got = taylor_of(t, made_graph[i], k)[1 + j];
                    const long double wanted = cimagl(of[i].at[k]) / DRAWN_TINY;
                    const long double size = size_of(&of[i], k) + fabsl(wanted);
                    expect_held("a slope", got, wanted, 10.0L * size);
                    TEST_ASSERT_TRUE_MESSAGE(
                        (long double)got.high - (long double)got.low <= 1e-6L * size, "narrow");
                }
            }
        }
        taylor_free(t);
        graph_free(m.graph);
    }
}

TEST(taylor, in_a_box) {
    unsigned finite = 0;
    const unsigned cases = dice_cases(usual_or(20, 8));
    for (unsigned c = 0; c < cases; c++) {
        drawn_motion m;
        enclosure at[DRAWN_VARIABLES];
        draw_taylor(&m);
        const int order = 4;
        taylor *t = taylor_new(&m.of, order, order);
        const double radius = pow(10.0, dice_between(&die, -6.0, -2.0));
        for (int i = 0; i < DRAWN_VARIABLES; i++) {
            at[i] = (enclosure){x_graph[i] - radius, x_graph[i] + radius};
        }
        const bool good = taylor_find(t, at);
        finite += good ? 1 : 0;
        for (int p = 0; p < 6 && good; p++) {
            double from[DRAWN_VARIABLES];
            series of[DRAWN_STEPS];
            for (int i = 0; i < DRAWN_VARIABLES; i++) {
                const unsigned end = dice_one_of(&die, 3);
                from[i] = end == 0   ? at[i].low
                          : end == 1 ? at[i].high
                                     : dice_between(&die, at[i].low, at[i].high);
            }
            const int j = (int)dice_one_of(&die, DRAWN_VARIABLES);
            along(from, j, order, of);
            for (int i = 0; i < DRAWN_STEPS; i++) {
                for (int k = 0; k <= order; k++) {
                    const enclosure *got = taylor_of(t, made_graph[i], k);
                    const long double slope = cimagl(of[i].at[k]) / DRAWN_TINY;
                    expect_held("a coefficient of a box", got[0], creall(of[i].at[k]),
                                size_of(&of[i], k));
                    expect_held("a slope of a box", got[1 + j], slope,
                                10.0L * (fabsl(slope) + size_of(&of[i], k)));
                }
            }
        }
        taylor_free(t);
        graph_free(m.graph);
    }
    TEST_ASSERT_TRUE(10 * finite >= 8 * cases);
}

typedef struct closed {
    graph *graph;
    int rate;
    exact_motion of;
} closed;

static void close_with(closed *c, int rate) {
    c->rate = rate;
    c->of = (exact_motion){
        .states = 1, .rate = &c->rate, .node = c->graph->node, .nodes = c->graph->count};
}

/* A value that is not a number must be reported, even if nothing uses it. */
TEST(taylor, no_number) {
    closed c = {.graph = graph_new()};
    (void)graph_variable(c.graph, 0);
    close_with(&c, graph_whole(c.graph, 1));
    taylor *t = taylor_new(&c.of, 2, -1);
    const enclosure good = enclosure_of(3.0);
    const enclosure bad = enclosure_of((double)NAN);
    TEST_ASSERT_TRUE(taylor_find(t, &good));
    TEST_ASSERT_FALSE(taylor_find(t, &bad));
    taylor_free(t);
    taylor_free(NULL);
    graph_free(c.graph);
    c.graph = graph_new(); /* the box contains a pole */
    close_with(&c, graph_power(c.graph, graph_variable(c.graph, 0), enclosure_of(-1.0)));
    t = taylor_new(&c.of, 2, -1);
    const enclosure across = {-1.0, 1.0};
    TEST_ASSERT_TRUE(taylor_find(t, &good));
    TEST_ASSERT_FALSE(taylor_find(t, &across));
    taylor_free(t);
    graph_free(c.graph);
}

/* The cost of a node grows with the square of the order and with the number of slopes. The test counts the products. */
TEST(taylor, products) {
    closed c = {.graph = graph_new()};
    const int a = graph_variable(c.graph, 0);
    const int both = graph_add(c.graph, graph_sine(c.graph, a), graph_whole(c.graph, 3));
    close_with(&c, graph_mul(c.graph, both, graph_exp(c.graph, a)));
    /* the expression has a sine with its cosine, an exponential and a product */
    for (int order = 1; order < 10; order++) {
        for (int slopes_to = -1; slopes_to <= order; slopes_to++) {
            double wanted = 0.0;
            for (int k = 0; k <= order; k++) {
                wanted += 4.0 * (k + 1.0 + (k <= slopes_to ? 2.0 * (k + 1.0) : 0.0));
            }
            taylor *t = taylor_new(&c.of, order, slopes_to);
            TEST_ASSERT_TRUE(taylor_products(t) == wanted);
            taylor_free(t);
        }
    }
    graph_free(c.graph);
}

SUITE(taylor) { die = dice_of("taylor", 42); }
