#include "reader.h"

#include <math.h>

#include "host/number/folding.h"

static int refused(reader_symbols *s, const expr *at, const char *what) {
    diag_error(s->errors, at->at, "only smooth functions that are enclosed can be proved about",
               "%s of what moves cannot be enclosed", what);
    return -1;
}

static int read_symbol(reader_symbols *s, const expr *tree) {
    const symbol *named = tree->symbol;
    const int i = named->index;
    switch (named->kind) {
    case SYM_PARAMETER:
        if (s->parameter[i] < 0) {
            s->parameter[i] = read_node(s, s->instance->parameter_given[i]);
        }
        return s->parameter[i];
    case SYM_LET:
        if (s->let[i] < 0) {
            s->let[i] = read_node(s, named->value);
        }
        return s->let[i];
    case SYM_INPUT: return read_node(s, s->instance->input_given[i]);
    case SYM_COORDINATE:
    case SYM_STATE:
        return graph_variable(s->graph, tree->primes < s->order[i] ? s->first[i] + tree->primes
                                                                   : s->highest + i);
    case SYM_OUTPUT:
    case SYM_RECORD: break;
    }
    return refused(s, tree, "an output");
}

/* (e^a + sign e^-a) / 2 */
static int hyperbolic(graph *g, int a, bool sine) {
    const int up = graph_exp(g, a);
    const int down = graph_exp(g, graph_neg(g, a));
    return graph_mul(g, graph_number(g, enclosure_of(0.5)),
                     sine ? graph_sub(g, up, down) : graph_add(g, up, down));
}

static enclosure size_of(enclosure a) {
    return a.low >= 0.0    ? a
           : a.high <= 0.0 ? enclosure_neg(a)
                           : (enclosure){0.0, enclosure_size(a)};
}

static enclosure sign_of(enclosure a) {
    return (enclosure){a.low > 0.0   ? 1.0
                       : a.low < 0.0 ? -1.0
                                     : 0.0,
                       a.high > 0.0   ? 1.0
                       : a.high < 0.0 ? -1.0
                                      : 0.0};
}

/* Functions with corners accept only numbers. */
static int read_corner(reader_symbols *s, const expr *tree, int a, int b) {
    graph *g = s->graph;
    if (!graph_is_number(g, a) || (b >= 0 && !graph_is_number(g, b))) {
        return refused(s, tree, function_name(tree->function));
    }
    const enclosure x = g->node[a].number;
    const enclosure y = b >= 0 ? g->node[b].number : x;
    if (tree->function == FN_ABS || tree->function == FN_SIGN) {
        return graph_number(g, tree->function == FN_ABS ? size_of(x) : sign_of(x));
    }
    const bool least = tree->function == FN_MIN;
    return graph_number(
        g,
        (enclosure){least ? enclosure_lesser(x.low, y.low) : enclosure_larger(x.low, y.low),
                    least ? enclosure_lesser(x.high, y.high) : enclosure_larger(x.high, y.high)});
}

/* A bound of the angle in [-pi/2, pi/2] with the sine (or tangent) x. Neighbouring doubles on both sides are tested;
 * both functions increase monotonically there. */
static double inverse_end(double x, bool tangent, double side) {
    const double angle = folding_call(tangent ? FN_ATAN : FN_ASIN, x, 0.0);
    const double most = 0x1.921fb54442d18p+0; /* pi/2, from below */
    double off = 0x1p-50;
    for (int doubled = 0; doubled < 42; doubled++) {
        const double y = angle + side * off;
        if (side * y > most) {
            break;
        }
        const enclosure sine = enclosure_sine(enclosure_of(y));
        const enclosure at = tangent
                                 ? enclosure_mul(enclosure_of(x), enclosure_cosine(enclosure_of(y)))
                                 : enclosure_of(x);
        if (side > 0.0 ? sine.low > at.high : sine.high < at.low) {
            return y;
        }
        off *= 2.0;
    }
    return side > 0.0 ? enclosure_above(most) : enclosure_below(-most);
}

static enclosure inverse(enclosure x, bool tangent) {
    if (!enclosure_is_finite(x) || (!tangent && (x.low < -1.0 || x.high > 1.0))) {
        return enclosure_of((double)NAN);
    }
    return enclosure_is_zero(x)
               ? x
               : (enclosure){inverse_end(x.low, tangent, -1.0), inverse_end(x.high, tangent, 1.0)};
}

/* atan2(y, x), by quadrant; NaN at its cut. */
static enclosure inverse_ratio(enclosure y, enclosure x) {
    const enclosure right = enclosure_times(enclosure_pi(), 0.5);
    if (x.low > 0.0) {
        return inverse(enclosure_div(y, x), true);
    }
    if (y.low > 0.0 || y.high < 0.0) {
        const enclosure from = inverse(enclosure_div(x, y), true);
        return enclosure_sub(y.low > 0.0 ? right : enclosure_neg(right), from);
    }
    return enclosure_is_zero(y) && x.high < 0.0 ? enclosure_pi() : enclosure_of((double)NAN);
}

/* Inverse functions accept only numbers. */
static int read_inverse(reader_symbols *s, const expr *tree, int a, int b) {
    graph *g = s->graph;
    if (!graph_is_number(g, a) || (b >= 0 && !graph_is_number(g, b))) {
        return refused(s, tree, function_name(tree->function));
    }
    const enclosure x = g->node[a].number;
    if (tree->function == FN_ATAN2) {
        return graph_number(g, inverse_ratio(x, g->node[b].number));
    }
    const enclosure angle = inverse(x, tree->function == FN_ATAN);
    return graph_number(g, tree->function == FN_ACOS
                               ? enclosure_sub(enclosure_times(enclosure_pi(), 0.5), angle)
                               : angle);
}

static int read_call(reader_symbols *s, const expr *tree) {
    graph *g = s->graph;
    const int a = read_node(s, tree->left);
    const int b = tree->right != NULL ? read_node(s, tree->right) : -1;
    if (a < 0 || (tree->right != NULL && b < 0)) {
        return -1;
    }
    switch (tree->function) {
    case FN_SIN: return graph_sine(g, a);
    case FN_COS: return graph_cosine(g, a);
    case FN_TAN: return graph_div(g, graph_sine(g, a), graph_cosine(g, a));
    case FN_SQRT: return graph_power(g, a, enclosure_of(0.5));
    case FN_EXP: return graph_exp(g, a);
    case FN_LOG: return graph_log(g, a);
    case FN_SINH: return hyperbolic(g, a, true);
    case FN_COSH: return hyperbolic(g, a, false);
    case FN_TANH: return graph_div(g, hyperbolic(g, a, true), hyperbolic(g, a, false));
    case FN_ABS:
    case FN_SIGN:
    case FN_MIN:
    case FN_MAX: return read_corner(s, tree, a, b);
    case FN_ASIN:
    case FN_ACOS:
    case FN_ATAN:
    case FN_ATAN2: return read_inverse(s, tree, a, b);
    }
    return refused(s, tree, function_name(tree->function));
}

static int read_power(reader_symbols *s, int base, int exponent) {
    graph *g = s->graph;
    return graph_is_number(g, exponent) ? graph_power(g, base, g->node[exponent].number)
                                        : graph_exp(g, graph_mul(g, exponent, graph_log(g, base)));
}

int read_node(reader_symbols *s, const expr *tree) {
    graph *g = s->graph;
    if (tree->op == EXPR_NUMBER) {
        return graph_number(g, tree->exact);
    }
    if (tree->op == EXPR_SYMBOL) {
        return read_symbol(s, tree);
    }
    if (tree->op == EXPR_CALL) {
        return read_call(s, tree);
    }
    const int a = read_node(s, tree->left);
    const int b = tree->right != NULL ? read_node(s, tree->right) : a;
    if (a < 0 || b < 0) {
        return -1;
    }
    switch (tree->op) {
    case EXPR_ADD: return graph_add(g, a, b);
    case EXPR_SUB: return graph_sub(g, a, b);
    case EXPR_MUL: return graph_mul(g, a, b);
    case EXPR_DIV: return graph_div(g, a, b);
    case EXPR_POW: return read_power(s, a, b);
    case EXPR_NEG: return graph_neg(g, a);
    case EXPR_NUMBER:
    case EXPR_SYMBOL:
    case EXPR_CALL: break;
    }
    return -1;
}
