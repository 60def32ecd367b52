/* test_method_order.c: the order of each row of core/method.h, by the order conditions: one condition for each
 * rooted tree, for first order, second order, and second order without rates. */
#define WH_DOUBLE 1

#include "core/step/ledger_step.h"
#include "test.h"

#define ROUNDING 4e-15L /* round-off of sums of a few shares, in double */
enum { ORDER_MAX = 6, TREES = 320, STAGES = WH_STAGES_MAX };

/* A row in long double. Stage i has the weights a[i] for its rates, and node[i] and reach[i] for its position. */
typedef struct weights {
    int stages;
    long double a[STAGES][STAGES];
    long double reach[STAGES][STAGES];
    long double node[STAGES];
    long double rates[STAGES];
    long double positions[STAGES];
} weights;

/* A tree of the derivatives of f(q, q') along the motion. `order`: the lowest power of h to which the tree
 * contributes. */
typedef struct tree {
    int order;
    bool by_rates;     /* has the tree a branch by rates? */
    bool by_positions; /* has the tree a branch by positions? */
    long double density;
    long double at[STAGES]; /* the tree's value at each stage */
} tree;

typedef struct forest {
    weights of;
    int count;
    tree tree[TREES];
} forest;

static void multiply(int stages, long double (*x)[STAGES], long double (*y)[STAGES],
                     long double (*product)[STAGES]) {
    for (int i = 0; i < stages; i++) {
        for (int j = 0; j < stages; j++) {
            product[i][j] = 0.0L;
            for (int k = 0; k < stages; k++) {
                product[i][j] += x[i][k] * y[k][j];
            }
        }
    }
}

static weights weights_of(int method) {
    const wh_tableau *t = wh_tableau_of((wh_method)method);
    weights w = {.stages = (int)t->stages};
    for (int i = 0; i < w.stages; i++) {
        w.rates[i] = (long double)t->rates[i] / (long double)t->parts;
        w.positions[i] = (long double)t->positions[i] / (long double)t->parts;
        for (int j = 0; j < w.stages; j++) {
            w.a[i][j] = (long double)t->stage[i].share[j] / (long double)t->stage[i].parts;
            w.node[i] += w.a[i][j];
        }
    }
    if (t->places == NULL) {
        multiply(w.stages, w.a, w.a, w.reach);
        return w;
    }
    for (int i = 0; i < w.stages; i++) {
        w.node[i] = (long double)t->places->node[i];
        for (int j = 0; j < w.stages; j++) {
            w.reach[i][j] =
                (long double)t->places->reach[i].share[j] / (long double)t->places->reach[i].parts;
        }
    }
    return w;
}

/* Returns `now` with one more branch: its value at stage i is multiplied by the sum of by[i][j] branch->at[j]. */
static tree branched(const forest *f, tree now, long double (*by)[STAGES], const tree *branch,
                     bool to_position) {
    const int stages = f->of.stages;
    for (int i = 0; i < stages; i++) {
        long double sum = 0.0L;
        for (int j = 0; j < stages; j++) {
            sum += by[i][j] * branch->at[j];
        }
        now.at[i] *= sum;
    }
    now.density *= branch->density * (to_position ? (long double)(branch->order + 1) : 1.0L);
    now.by_rates = now.by_rates || branch->by_rates || !to_position;
    now.by_positions = now.by_positions || branch->by_positions || to_position;
    return now;
}

/* Adds to the forest all trees of `order` nodes that extend the tree `now` by `left` nodes. The new branches have numbers of
 * at least `from`. Branch 0 is the initial rate. Each smaller tree is two branches: one for the position, one for the rate. */
static void grow(forest *f, int order, int left, int from, tree now) {
    if (left == 0) {
        TEST_ASSERT_TRUE(f->count < TREES);
        now.order = order;
        now.density *= (long double)order;
        f->tree[f->count++] = now;
        return;
    }
    if (from == 0) {
        tree with = now;
        with.by_positions = true;
        for (int i = 0; i < f->of.stages; i++) {
            with.at[i] *= f->of.node[i];
        }
        grow(f, order, left - 1, 0, with);
    }
    for (int k = from > 1 ? from : 1; k <= 2 * f->count; k++) {
        const tree *branch = &f->tree[(k - 1) / 2];
        const bool to_position = k % 2 != 0;
        const int weight = branch->order + (to_position ? 1 : 0);
        if (weight <= left && branch->order < order) {
            grow(f, order, left - weight, k,
                 branched(f, now, to_position ? f->of.reach : f->of.a, branch, to_position));
        }
    }
}

typedef enum kind { FIRST_ORDER, SECOND_ORDER, NO_RATES } kind;

static long double off(const forest *f, const long double *by, const tree *t, long double density) {
    long double sum = 0.0L;
    for (int i = 0; i < f->of.stages; i++) {
        sum += by[i] * t->at[i];
    }
    return fabsl(sum - 1.0L / density);
}

static int order_of(const forest *f, kind of) {
    int order = ORDER_MAX;
    for (int k = 0; k < f->count; k++) {
        const tree *t = &f->tree[k];
        if (of == FIRST_ORDER ? t->by_positions : of == NO_RATES && t->by_rates) {
            continue;
        }
        if (t->order <= order && off(f, f->of.rates, t, t->density) > ROUNDING) {
            order = t->order - 1;
        }
        const long double density = (long double)(t->order + 1) * t->density;
        if (of != FIRST_ORDER && t->order + 1 <= order &&
            off(f, f->of.positions, t, density) > ROUNDING) {
            order = t->order;
        }
    }
    return order;
}

static void plant(forest *f, int method) {
    tree bare = {.density = 1.0L};
    *f = (forest){.of = weights_of(method)};
    for (int i = 0; i < f->of.stages; i++) {
        bare.at[i] = 1.0L;
    }
    for (int order = 1; order <= ORDER_MAX; order++) {
        grow(f, order, order - 1, 0, bare);
    }
}

/* The number of trees must be the published one (Hairer, Norsett & Wanner, I, sections II.2 and II.14). Then no
 * condition is missing. */
TEST(method_order, no_tree_is_missing) {
    static const int all[ORDER_MAX] = {1, 2, 6, 18, 60, 204};
    static const int first_order[ORDER_MAX] = {1, 1, 2, 4, 9, 20};
    static const int no_rates[ORDER_MAX] = {1, 1, 2, 3, 6, 10};
    static forest f;
    int found[3][ORDER_MAX] = {{0}};
    plant(&f, WH_RK4);
    for (int k = 0; k < f.count; k++) {
        const int order = f.tree[k].order - 1;
        found[0][order]++;
        found[1][order] += !f.tree[k].by_positions;
        found[2][order] += !f.tree[k].by_rates;
    }
    for (int i = 0; i < ORDER_MAX; i++) {
        TEST_ASSERT_EQUAL_INT(all[i], found[0][i]);
        TEST_ASSERT_EQUAL_INT(first_order[i], found[1][i]);
        TEST_ASSERT_EQUAL_INT(no_rates[i], found[2][i]);
    }
}

TEST(method_order, rows_have_exactly_their_order) {
    static forest f;
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_method_row *row = &wh_methods[m];
        plant(&f, m);
        const int of[3] = {order_of(&f, FIRST_ORDER), order_of(&f, SECOND_ORDER),
                           order_of(&f, NO_RATES)};
        printf("  %s: order %d, %d of second order, %d without rates\n", row->word, of[0], of[1],
               of[2]);
        if (row->takes == WH_NO_RATES) {
            TEST_ASSERT_TRUE_MESSAGE(of[NO_RATES] == row->order, row->word);
            continue;
        }
        TEST_ASSERT_TRUE_MESSAGE(of[SECOND_ORDER] == row->order, row->word);
        TEST_ASSERT_TRUE_MESSAGE(of[NO_RATES] >= row->order, row->word);
        TEST_ASSERT_TRUE_MESSAGE(row->takes != WH_ANY_SYSTEM || of[FIRST_ORDER] == row->order,
                                 row->word);
    }
}

/* A stage's node must be the sum of its shares. A stage that reuses the position of another one must have the same
 * shares. */
TEST(method_order, nodes_follow_from_the_shares) {
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_tableau *t = wh_tableau_of((wh_method)m);
        for (unsigned i = 0; i < t->stages && wh_methods[m].takes != WH_NO_RATES; i++) {
            double sum = 0.0;
            for (unsigned j = 0; j < t->stages; j++) {
                sum += t->stage[i].share[j];
            }
            if (t->places != NULL) {
                TEST_ASSERT_TRUE_MESSAGE(fabs(sum / t->stage[i].parts - t->places->node[i]) <
                                             (double)ROUNDING,
                                         wh_methods[m].word);
            }
        }
    }
}

/* Without rates in the forces, each step is a sequence of kicks and drifts. So it preserves area, and it must be its
 * own reverse. */
TEST(method_order, compositions_are_symplectic_and_symmetric) {
    int rows = 0;
    for (int m = 0; m < WH_METHODS; m++) {
        const weights w = weights_of(m);
        if (wh_methods[m].takes != WH_NO_RATES) {
            continue;
        }
        for (int i = 0; i < w.stages; i++) {
            const int mirror = w.stages - 1 - i;
            TEST_ASSERT_TRUE(fabsl(w.positions[i] - w.rates[i] * (1.0L - w.node[i])) < ROUNDING);
            TEST_ASSERT_TRUE(fabsl(w.node[i] + w.node[mirror] - 1.0L) < ROUNDING);
            TEST_ASSERT_TRUE(fabsl(w.rates[i] - w.rates[mirror]) < ROUNDING);
            for (int j = 0; j < i; j++) {
                TEST_ASSERT_TRUE(fabsl(w.reach[i][j] - w.rates[j] * (w.node[i] - w.node[j])) <
                                 ROUNDING);
            }
        }
        rows++;
    }
    TEST_ASSERT_TRUE(rows > 0);
}
