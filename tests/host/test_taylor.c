/* test_taylor.c: Taylor coefficients of drawn motions in enclosures (host/prove/taylor.h), and their slopes by the state,
 * against series in long double that are found by another way (drawn_graph.h): held, narrowly, at a point; held, whichever
 * point of a box they begin at. */
#include <math.h>
#include <stdlib.h>

#include "drawn_graph.h"
#include "host/prove/taylor.h"
#include "unity.h"

void suite_taylor(void);

static dice die;
static drawn_graph drawn;
static int made[DRAWN_STEPS];
static double x[DRAWN_VARIABLES];
static int rate_step[DRAWN_VARIABLES]; /* the step that is a variable's rate */

typedef struct drawn_motion {
    graph *graph;
    int rate[DRAWN_VARIABLES];
    exact_motion of;
} drawn_motion;

static void draw(drawn_motion *m) {
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        x[i] = dice_between(&die, -1.5, 1.5);
    }
    drawn_graph_draw(&drawn, &die, x);
    m->graph = graph_new();
    drawn_graph_nodes(&drawn, m->graph, made);
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        rate_step[i] = DRAWN_STEPS - 1 - i;
        m->rate[i] = made[rate_step[i]];
    }
    m->of = (exact_motion){.states = DRAWN_VARIABLES,
                           .rate = m->rate,
                           .node = m->graph->node,
                           .nodes = m->graph->count};
}

/* All steps' series along the motion from there, with a tiny imaginary part of state `moved`, if there is one. */
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

/* So large are a step's coefficient k and those before it. */
static long double size_of(const series *s, int k) {
    long double size = 1.0L;
    for (int i = 0; i <= k; i++) {
        size = fmaxl(size, fabsl(creall(s->at[i])));
    }
    return size;
}

static void test_at_a_point(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(25, 8)); c++) {
        drawn_motion m;
        series of[DRAWN_STEPS];
        enclosure at[DRAWN_VARIABLES];
        draw(&m);
        const int order = 1 + (int)dice_one_of(&die, DRAWN_ORDER);
        const int slopes_to = (int)dice_one_of(&die, (unsigned)order + 2) - 1;
        taylor *t = taylor_new(&m.of, order, slopes_to);
        TEST_ASSERT_EQUAL_INT(slopes_to < 0 ? 1 : 1 + DRAWN_VARIABLES, t->width);
        for (int i = 0; i < DRAWN_VARIABLES; i++) {
            at[i] = enclosure_of(x[i]);
        }
        for (int again = 0; again < 2;
             again++) { /* what is left of the last time counts for nothing */
            TEST_ASSERT_TRUE(taylor_find(t, at));
        }
        along(x, -1, order, of);
        for (int i = 0; i < DRAWN_STEPS; i++) {
            for (int k = 0; k <= order; k++) {
                const enclosure got = taylor_of(t, made[i], k)[0];
                const long double size = size_of(&of[i], k);
                expect_held("a coefficient", got, creall(of[i].at[k]), size);
                TEST_ASSERT_TRUE_MESSAGE(
                    (long double)got.high - (long double)got.low <= 1e-8L * size, "narrow");
            }
        }
        for (int j = 0; j < DRAWN_VARIABLES; j++) {
            along(x, j, order, of);
            for (int i = 0; i < DRAWN_STEPS; i++) {
                for (int k = 0; k <= slopes_to; k++) {
                    const enclosure got = taylor_of(t, made[i], k)[1 + j];
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

static void test_in_a_box(void) {
    unsigned finite = 0;
    const unsigned cases = dice_cases(usual_or(20, 8));
    for (unsigned c = 0; c < cases; c++) {
        drawn_motion m;
        enclosure at[DRAWN_VARIABLES];
        draw(&m);
        const int order = 4;
        taylor *t = taylor_new(&m.of, order, order);
        const double radius = pow(10.0, dice_between(&die, -6.0, -2.0));
        for (int i = 0; i < DRAWN_VARIABLES; i++) {
            at[i] = (enclosure){x[i] - radius, x[i] + radius};
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
                    const enclosure *got = taylor_of(t, made[i], k);
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

/* --- closed forms ------------------------------------------------------------------------------------------*/

/* x' = f(x) of one variable. */
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

/* x' = x^2 from 1/2 on is 1/(2 - t): (1/2)^(k+1), and its slope by the start; all exact in twos. x' = 1/x from 1 on is
 * sqrt(1 + 2 t). */
static void test_closed_forms(void) {
    enum { ORDER = 20 };
    closed c = {.graph = graph_new()};
    const int a = graph_variable(c.graph, 0);
    close_with(&c, graph_mul(c.graph, a, a));
    taylor *t = taylor_new(&c.of, ORDER, ORDER);
    enclosure start = enclosure_of(0.5);
    TEST_ASSERT_TRUE(taylor_find(t, &start));
    for (int k = 0; k <= ORDER; k++) {
        const enclosure *got = taylor_of(t, 0, k);
        expect_held("1/(2 - t)", got[0], ldexpl(1.0L, -(k + 1)), 0.0L);
        expect_held("its slope", got[1], (long double)(k + 1) * ldexpl(1.0L, -k), 0.0L);
        TEST_ASSERT_TRUE(got[0].high - got[0].low <= 0x1p-49 * k * got[0].high);
    }
    start = (enclosure){-1e200, 1e200};
    TEST_ASSERT_FALSE(taylor_find(t, &start));
    taylor_free(t);
    graph_free(c.graph);
    c.graph = graph_new();
    const int root = graph_variable(c.graph, 0);
    close_with(&c, graph_power(c.graph, root, enclosure_of(-1.0)));
    t = taylor_new(&c.of, ORDER, -1);
    start = enclosure_of(1.0);
    TEST_ASSERT_TRUE(taylor_find(t, &start));
    long double wanted = 1.0L; /* binomials of 1/2, times 2^k */
    for (int k = 0; k <= ORDER; k++) {
        const enclosure got = taylor_of(t, 0, k)[0];
        expect_held("sqrt(1 + 2 t)", got, wanted, 1e-3L * fabsl(wanted));
        wanted *= 2.0L * (0.5L - (long double)k) / (long double)(k + 1);
    }
    start = (enclosure){-1.0, 1.0};
    TEST_ASSERT_FALSE(taylor_find(t, &start));
    taylor_free(t);
    graph_free(c.graph);
}

/* What is no number is told, also where nothing is made of it. */
static void test_no_number(void) {
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
}

/* What it costs grows with the square of the order, and with the slopes: products of a node, counted as they are written. */
static void test_products(void) {
    closed c = {.graph = graph_new()};
    const int a = graph_variable(c.graph, 0);
    const int both = graph_add(c.graph, graph_sine(c.graph, a), graph_whole(c.graph, 3));
    close_with(&c, graph_mul(c.graph, both, graph_exp(c.graph, a)));
    /* a sine, its cosine, an exponential, a product */
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

void suite_taylor(void) {
    die = dice_of("taylor", 42);
    RUN_TEST(test_at_a_point);
    RUN_TEST(test_in_a_box);
    RUN_TEST(test_closed_forms);
    RUN_TEST(test_no_number);
    RUN_TEST(test_products);
}
