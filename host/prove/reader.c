/* reader.c: see reader.h. */
#include "reader.h"

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

/* What has corners is known of numbers only. */
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
    case FN_ATAN2: break;
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
