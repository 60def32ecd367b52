/* graph.c: the graph of operations, its derivatives, and its nodes for a model's expressions. */
#include "host/prove/graph.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/folding.h"
#include "host/number/functions.h"

graph *graph_new(void) { return alloc(1, sizeof(graph)); }

void graph_free(graph *g) {
    if (g != NULL) {
        free(g->node);
        free(g->slot);
        free(g);
    }
}

static uint64_t mixed(uint64_t hash, uint64_t with) {
    hash = (hash ^ with) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ (hash >> 29);
}

static uint64_t hash_of(const node *n) {
    uint64_t hash = mixed((uint64_t)n->kind, (uint64_t)(n->left + 1));
    hash = mixed(hash, (uint64_t)(n->right + 1));
    return mixed(mixed(hash, number_bits(n->number.low)), number_bits(n->number.high));
}

static bool same(const node *a, const node *b) {
    return a->kind == b->kind && a->left == b->left && a->right == b->right &&
           number_bits(a->number.low) == number_bits(b->number.low) &&
           number_bits(a->number.high) == number_bits(b->number.high);
}

static int *slot_of(const graph *g, const node *n) {
    const uint64_t mask = (uint64_t)g->slots - 1U;
    uint64_t at = hash_of(n) & mask;
    while (g->slot[at] >= 0 && !same(&g->node[g->slot[at]], n)) {
        at = (at + 1) & mask;
    }
    return &g->slot[at];
}

static void make_room(graph *g) {
    if (g->count < g->room) {
        return;
    }
    g->room = g->room == 0 ? 256 : 2 * g->room;
    g->node = alloc_more(g->node, g->room, sizeof *g->node);
    g->slots = 4 * g->room;
    g->slot = alloc_more(g->slot, g->slots, sizeof *g->slot);
    for (int i = 0; i < g->slots; i++) {
        g->slot[i] = -1;
    }
    for (int i = 0; i < g->count; i++) {
        *slot_of(g, &g->node[i]) = i;
    }
}

static int entered(graph *g, node_kind kind, int left, int right, enclosure number) {
    make_room(g);
    const node made = {kind, left, right, number};
    int *slot = slot_of(g, &made);
    if (*slot < 0) {
        g->node[g->count] = made;
        *slot = g->count++;
    }
    return *slot;
}

bool graph_is_number(const graph *g, int a) { return g->node[a].kind == NODE_NUMBER; }

bool graph_is_zero(const graph *g, int a) {
    return graph_is_number(g, a) && enclosure_is_zero(g->node[a].number);
}

int graph_number(graph *g, enclosure value) {
    const enclosure clean = enclosure_is_zero(value) ? enclosure_of(0.0) : value; /* no -0 */
    return entered(g, NODE_NUMBER, -1, -1, clean);
}

int graph_whole(graph *g, int value) { return graph_number(g, enclosure_of((double)value)); }

int graph_variable(graph *g, int which) {
    return entered(g, NODE_VARIABLE, which, -1, enclosure_of(0.0));
}

/* Encloses x op y by one double if the result is exact (Knuth's sum, Dekker's product). */
static enclosure folded(char op, enclosure x, enclosure y) {
    const double a = x.low;
    const double b = op == '-' ? -y.low : y.low;
    const bool points = enclosure_is_point(x) && enclosure_is_point(y);
    const double size = fabs(a) + fabs(b);
    const bool plain = points && size < 0x1p300 && (op == '+' || op == '-' || size > 0x1p-300);
    if (op == '+' || op == '-') {
        const double s = a + b;
        const double rest = s - a;
        return plain && a - (s - rest) == 0.0 && b - rest == 0.0
                   ? enclosure_of(s)
                   : (op == '+' ? enclosure_add(x, y) : enclosure_sub(x, y));
    }
    const double r = op == '*' ? a * b : a / b;
    const double left = op == '*' ? a : r; /* a quotient r is exact if r * b = a */
    const double whole = op == '*' ? r : a;
    const double c = 0x1.0000002p27 * left;
    const double d = 0x1.0000002p27 * b;
    const double left_high = c - (c - left);
    const double b_high = d - (d - b);
    const double off =
        ((left_high * b_high - whole) + left_high * (b - b_high) + (left - left_high) * b_high) +
        (left - left_high) * (b - b_high);
    return plain && left * b == whole && off == 0.0 && fabs(whole) > 0x1p-600
               ? enclosure_of(r)
               : (op == '*' ? enclosure_mul(x, y) : enclosure_div(x, y));
}

static int made_of_two(graph *g, node_kind kind, int a, int b) {
    return entered(g, kind, a, b, enclosure_of(0.0));
}

static int multiple(graph *g, enclosure by, int a) {
    if (enclosure_is_zero(by)) {
        return graph_whole(g, 0);
    }
    if (by.low == 1.0 && by.high == 1.0) {
        return a;
    }
    const node n = g->node[a];
    if (n.kind == NODE_NUMBER) {
        return graph_number(g, folded('*', by, n.number));
    }
    if (n.kind == NODE_MULTIPLE) {
        return multiple(g, folded('*', by, n.number), n.left);
    }
    return entered(g, NODE_MULTIPLE, a, -1, by);
}

int graph_neg(graph *g, int a) { return multiple(g, enclosure_of(-1.0), a); }

int graph_add(graph *g, int a, int b) {
    if (graph_is_zero(g, a) || graph_is_zero(g, b)) {
        return graph_is_zero(g, a) ? b : a;
    }
    if (graph_is_number(g, a) && graph_is_number(g, b)) {
        return graph_number(g, folded('+', g->node[a].number, g->node[b].number));
    }
    if (a == b) {
        return multiple(g, enclosure_of(2.0), a);
    }
    return made_of_two(g, NODE_SUM, a < b ? a : b, a < b ? b : a);
}

int graph_sub(graph *g, int a, int b) {
    if (a == b) {
        return graph_whole(g, 0);
    }
    if (graph_is_zero(g, a) || graph_is_zero(g, b)) {
        return graph_is_zero(g, b) ? a : graph_neg(g, b);
    }
    if (graph_is_number(g, a) && graph_is_number(g, b)) {
        return graph_number(g, folded('-', g->node[a].number, g->node[b].number));
    }
    return made_of_two(g, NODE_DIFFERENCE, a, b);
}

/* Numbers move to the front, so that the constants of a product form one factor. */
int graph_mul(graph *g, int a, int b) {
    const node x = g->node[a];
    const node y = g->node[b];
    if (x.kind == NODE_NUMBER || y.kind == NODE_NUMBER) {
        return x.kind == NODE_NUMBER ? multiple(g, x.number, b) : multiple(g, y.number, a);
    }
    if (x.kind == NODE_MULTIPLE) {
        return multiple(g, x.number, graph_mul(g, x.left, b));
    }
    if (y.kind == NODE_MULTIPLE) {
        return multiple(g, y.number, graph_mul(g, a, y.left));
    }
    if (a == b) {
        return entered(g, NODE_SQUARE, a, -1, enclosure_of(0.0));
    }
    return made_of_two(g, NODE_PRODUCT, a < b ? a : b, a < b ? b : a);
}

int graph_div(graph *g, int a, int b) {
    const node y = g->node[b];
    if (y.kind == NODE_NUMBER && graph_is_number(g, a)) {
        return graph_number(g, folded('/', g->node[a].number, y.number));
    }
    if (y.kind == NODE_NUMBER) {
        return multiple(g, folded('/', enclosure_of(1.0), y.number), a);
    }
    if (graph_is_zero(g, a)) {
        return a;
    }
    if (y.kind == NODE_MULTIPLE) {
        return multiple(g, enclosure_div(enclosure_of(1.0), y.number), graph_div(g, a, y.left));
    }
    return made_of_two(g, NODE_RATIO, a, b);
}

/* A sine and its cosine are adjacent nodes, because their Taylor coefficients depend on each other. */
static int wave(graph *g, int a, bool cosine) {
    const enclosure of = g->node[a].number;
    if (graph_is_number(g, a)) {
        return graph_number(g, cosine ? enclosure_cosine(of) : enclosure_sine(of));
    }
    const int sine = entered(g, NODE_SINE, a, -1, enclosure_of(0.0));
    return cosine ? entered(g, NODE_COSINE, a, sine, enclosure_of(0.0)) : sine;
}

int graph_sine(graph *g, int a) {
    wave(g, a, true);
    return wave(g, a, false);
}

int graph_cosine(graph *g, int a) { return wave(g, a, true); }

int graph_exp(graph *g, int a) {
    return graph_is_number(g, a) ? graph_number(g, enclosure_exp(g->node[a].number))
                                 : entered(g, NODE_EXP, a, -1, enclosure_of(0.0));
}

int graph_log(graph *g, int a) {
    return graph_is_number(g, a) ? graph_number(g, enclosure_log(g->node[a].number))
                                 : entered(g, NODE_LOG, a, -1, enclosure_of(0.0));
}

enum { PRODUCTS_MOST = 64 }; /* larger whole exponents are not multiplied out */

int graph_power(graph *g, int a, enclosure exponent) {
    const double e = exponent.low;
    if (graph_is_number(g, a) && !enclosure_is_point(g->node[a].number)) {
        return graph_number(g, enclosure_power(g->node[a].number, exponent));
    }
    if (enclosure_is_point(exponent) && number_nearest(e) == e && e <= PRODUCTS_MOST &&
        e >= -PRODUCTS_MOST) {
        const int n = (int)(e < 0.0 ? -e : e);
        if (n == 0) {
            return graph_whole(g, 1);
        }
        const int halved = n / 2;
        const int half = n > 1 ? graph_power(g, a, enclosure_of((double)halved)) : a;
        const int even = n > 1 ? graph_mul(g, half, half) : a;
        const int whole = n > 1 && n % 2 != 0 ? graph_mul(g, even, a) : even;
        return e < 0.0 ? graph_div(g, graph_whole(g, 1), whole) : whole;
    }
    return graph_is_number(g, a) ? graph_number(g, enclosure_power(g->node[a].number, exponent))
                                 : entered(g, NODE_POWER, a, -1, exponent);
}

/* === derivatives ============================================================================== */

/* A walk that makes a new node for each old node. The new nodes are added to the same graph, but never visited. */
typedef struct rewriting rewriting;
struct rewriting {
    graph *graph;
    int *to; /* [number of old nodes] the new node; -1: not made yet */
    int variable;
    int (*make)(rewriting *r, int a); /* makes the new node */
};

static int rewritten(rewriting *r, int a) {
    if (r->to[a] < 0) {
        r->to[a] = r->make(r, a);
    }
    return r->to[a];
}

static int rewrite(graph *g, int a, int variable, int (*make)(rewriting *r, int a)) {
    rewriting r = {g, alloc(g->count, sizeof *r.to), variable, make};
    for (int i = 0; i < g->count; i++) {
        r.to[i] = -1;
    }
    const int made = rewritten(&r, a);
    free(r.to);
    return made;
}

static int slope(rewriting *r, int a) {
    graph *g = r->graph;
    const node n = g->node[a];
    const bool is_leaf = n.kind == NODE_NUMBER || n.kind == NODE_VARIABLE;
    const bool is_function = n.kind == NODE_SQUARE || n.kind >= NODE_SINE;
    const int left = is_leaf ? -1 : rewritten(r, n.left);
    if (is_function && graph_is_zero(g, left)) {
        return left;
    }
    switch (n.kind) {
    case NODE_NUMBER: return graph_whole(g, 0);
    case NODE_VARIABLE: return graph_whole(g, n.left == r->variable ? 1 : 0);
    case NODE_SUM: return graph_add(g, left, rewritten(r, n.right));
    case NODE_DIFFERENCE: return graph_sub(g, left, rewritten(r, n.right));
    case NODE_PRODUCT: {
        const int first = graph_mul(g, left, n.right);
        return graph_add(g, first, graph_mul(g, n.left, rewritten(r, n.right)));
    }
    case NODE_MULTIPLE: return graph_mul(g, graph_number(g, n.number), left);
    case NODE_RATIO: { /* (u / v)' = (u' - (u / v) v') / v */
        const int below = graph_mul(g, a, rewritten(r, n.right));
        return graph_div(g, graph_sub(g, left, below), n.right);
    }
    case NODE_SQUARE: return graph_mul(g, graph_mul(g, graph_whole(g, 2), n.left), left);
    case NODE_SINE: return graph_mul(g, graph_cosine(g, n.left), left);
    case NODE_COSINE: return graph_mul(g, graph_neg(g, graph_sine(g, n.left)), left);
    case NODE_EXP: return graph_mul(g, a, left);
    case NODE_LOG: return graph_mul(g, graph_div(g, graph_whole(g, 1), n.left), left);
    case NODE_POWER: {
        const int outer = graph_mul(g, graph_number(g, n.number), graph_div(g, a, n.left));
        return graph_mul(g, outer, left);
    }
    }
    return a;
}

int graph_slope(graph *g, int a, int variable) { return rewrite(g, a, variable, slope); }

static int without(rewriting *r, int a) {
    graph *g = r->graph;
    const node n = g->node[a];
    const bool has_left = n.kind != NODE_NUMBER && n.kind != NODE_VARIABLE;
    const bool has_right = n.kind == NODE_SUM || n.kind == NODE_DIFFERENCE ||
                           n.kind == NODE_PRODUCT || n.kind == NODE_RATIO;
    const int left = has_left ? rewritten(r, n.left) : -1;
    const int right = has_right ? rewritten(r, n.right) : -1;
    switch (n.kind) {
    case NODE_NUMBER: return a;
    case NODE_VARIABLE: return n.left >= r->variable ? graph_whole(g, 0) : a;
    case NODE_SUM: return graph_add(g, left, right);
    case NODE_DIFFERENCE: return graph_sub(g, left, right);
    case NODE_PRODUCT: return graph_mul(g, left, right);
    case NODE_MULTIPLE: return graph_mul(g, graph_number(g, n.number), left);
    case NODE_SQUARE: return graph_mul(g, left, left);
    case NODE_RATIO: return graph_div(g, left, right);
    case NODE_SINE: return graph_sine(g, left);
    case NODE_COSINE: return graph_cosine(g, left);
    case NODE_EXP: return graph_exp(g, left);
    case NODE_LOG: return graph_log(g, left);
    case NODE_POWER: return graph_power(g, left, n.number);
    }
    return a;
}

int graph_without(graph *g, int a, int first) { return rewrite(g, a, first, without); }

/* === conversion of a model's expressions ====================================================== */

static int refused(reader_symbols *s, const expr *at, const char *what) {
    diag_error(s->errors, at->at, "use whirl trust, which estimates the error",
               "whirl prove has no bounds for %s of a quantity that changes in the run", what);
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

/* sinh(a) if `sine`, else cosh(a) */
static int hyperbolic(graph *g, int a, bool sine) {
    const int up = graph_exp(g, a);
    const int down = graph_exp(g, graph_neg(g, a));
    return graph_mul(g, graph_number(g, enclosure_of(0.5)),
                     sine ? graph_sub(g, up, down) : graph_add(g, up, down));
}

/* Returns an upper (side 1) or lower (side -1) bound on asin(x), or on atan(x) if `tangent`. */
static double inverse_end(double x, bool tangent, double side) {
    const double angle = folding_call(NULL, tangent ? FN_ATAN : FN_ASIN, x, 0.0);
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

/* Encloses atan2(y, x), by quadrant; NaN at its cut. */
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

static enclosure called(function_id function, enclosure x, enclosure y) {
    const enclosure right = enclosure_times(enclosure_pi(), 0.5);
    return function == FN_ATAN2                         ? inverse_ratio(x, y)
           : function == FN_ACOS                        ? enclosure_sub(right, inverse(x, false))
           : function == FN_ASIN || function == FN_ATAN ? inverse(x, function == FN_ATAN)
                                                        : enclosure_call(function, x, y);
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
    case FN_MAX:
    case FN_ASIN:
    case FN_ACOS:
    case FN_ATAN:
    case FN_ATAN2: break;
    }
    /* functions with corners, and inverse functions, require constant arguments */
    if (!graph_is_number(g, a) || (b >= 0 && !graph_is_number(g, b))) {
        return refused(s, tree, function_name(tree->function));
    }
    const enclosure x = g->node[a].number;
    return graph_number(g, called(tree->function, x, b >= 0 ? g->node[b].number : x));
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
    case EXPR_POW:
        return graph_is_number(g, b) ? graph_power(g, a, g->node[b].number)
                                     : graph_exp(g, graph_mul(g, b, graph_log(g, a)));
    case EXPR_NEG: return graph_neg(g, a);
    case EXPR_NUMBER:
    case EXPR_SYMBOL:
    case EXPR_CALL: break;
    }
    return -1;
}
