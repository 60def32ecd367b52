#include "drawn_graph.h"
#include "test.h"

typedef long double complex number;

static number turned(long double size, long double angle) {
    return drawn_complex(size * cosl(angle), size * sinl(angle));
}

static number exponential(number a) { return turned(expl(creall(a)), cimagl(a)); }

static number logarithm(number a) {
    return drawn_complex(logl(hypotl(creall(a), cimagl(a))), atan2l(cimagl(a), creall(a)));
}

static number sine(number a) {
    return drawn_complex(sinl(creall(a)) * coshl(cimagl(a)), cosl(creall(a)) * sinhl(cimagl(a)));
}

static number cosine(number a) {
    return drawn_complex(cosl(creall(a)) * coshl(cimagl(a)), -sinl(creall(a)) * sinhl(cimagl(a)));
}

/* outer[n]: the n-th derivative at a, over n!. */
static void derivatives(drawn_kind kind, number a, long double exponent, int order, number *outer) {
    long double factorial = 1.0L;
    number power = kind == DRAWN_POWER ? exponential(exponent * logarithm(a)) : 1.0L;
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
        case DRAWN_RATIO: /* 1/a */
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
    number outer[DRAWN_ORDER + 1];
    derivatives(kind, u.at[0], exponent, order, outer);
    series of = constant(0.0L);
    u.at[0] = 0.0L;
    for (int n = order; n >= 0; n--) { /* Horner */
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

void drawn_graph_series(const drawn_graph *d, const series *x, int order, series *of) {
    for (int i = 0; i < DRAWN_STEPS; i++) {
        of[i] = i < DRAWN_VARIABLES ? x[i] : step_series(&d->step[i], of, order);
    }
}

void drawn_graph_draw(drawn_graph *d, dice *die, const double *x) {
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

void drawn_graph_nodes(const drawn_graph *d, graph *g, int *made) {
    for (int i = 0; i < DRAWN_VARIABLES; i++) {
        made[i] = graph_variable(g, i);
        TEST_ASSERT_EQUAL_INT(i, made[i]);
    }
    for (int i = DRAWN_VARIABLES; i < DRAWN_STEPS; i++) {
        made[i] = step_node(&d->step[i], g, made);
    }
}

static long double middle(enclosure a) { return ((long double)a.low + (long double)a.high) / 2.0L; }

void drawn_graph_values(const graph *g, const long double *x, long double *value) {
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
