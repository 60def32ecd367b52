/* graph_slope.c: derivatives of a graph's nodes, and nodes with zeros put in. */
#include <stdlib.h>

#include "graph.h"
#include "host/base/room.h"

/* What became of the nodes met so far. Nodes are made meanwhile, but only those that were there before are asked for. */
typedef struct rewriting {
    graph *graph;
    int *to; /* [nodes at the beginning] -1: not yet */
    int variable;
} rewriting;

static rewriting begin(graph *g, int variable) {
    rewriting r = {g, room(g->count, sizeof(int)), variable};
    for (int i = 0; i < g->count; i++) {
        r.to[i] = -1;
    }
    return r;
}

/* The slope of sine, cosine, exp and so on by their argument. */
static int outer_slope(graph *g, int a) {
    const node n = g->node[a];
    switch (n.kind) {
    case NODE_SQUARE: return graph_mul(g, graph_whole(g, 2), n.left);
    case NODE_SINE: return graph_cosine(g, n.left);
    case NODE_COSINE: return graph_neg(g, graph_sine(g, n.left));
    case NODE_EXP: return a;
    case NODE_LOG: return graph_div(g, graph_whole(g, 1), n.left);
    case NODE_POWER: return graph_mul(g, graph_number(g, n.number), graph_div(g, a, n.left));
    case NODE_NUMBER:
    case NODE_VARIABLE:
    case NODE_SUM:
    case NODE_DIFFERENCE:
    case NODE_PRODUCT:
    case NODE_MULTIPLE:
    case NODE_RATIO: break;
    }
    return a;
}

static int slope(rewriting *r, int a);

/* (u / v)' = (u' - (u / v) v') / v */
static int ratio_slope(rewriting *r, int a) {
    graph *g = r->graph;
    const node n = g->node[a];
    const int above = slope(r, n.left);
    const int below = slope(r, n.right);
    return graph_div(g, graph_sub(g, above, graph_mul(g, a, below)), n.right);
}

static int slope_found(rewriting *r, int a) {
    graph *g = r->graph;
    const node n = g->node[a];
    switch (n.kind) {
    case NODE_NUMBER: return graph_whole(g, 0);
    case NODE_VARIABLE: return graph_whole(g, n.left == r->variable ? 1 : 0);
    case NODE_SUM: {
        const int left = slope(r, n.left);
        return graph_add(g, left, slope(r, n.right));
    }
    case NODE_DIFFERENCE: {
        const int left = slope(r, n.left);
        return graph_sub(g, left, slope(r, n.right));
    }
    case NODE_PRODUCT: {
        const int left = graph_mul(g, slope(r, n.left), n.right);
        return graph_add(g, left, graph_mul(g, n.left, slope(r, n.right)));
    }
    case NODE_MULTIPLE: return graph_mul(g, graph_number(g, n.number), slope(r, n.left));
    case NODE_RATIO: return ratio_slope(r, a);
    case NODE_SQUARE:
    case NODE_SINE:
    case NODE_COSINE:
    case NODE_EXP:
    case NODE_LOG:
    case NODE_POWER: break;
    }
    const int inner = slope(r, n.left);
    return graph_is_zero(g, inner) ? inner : graph_mul(g, outer_slope(g, a), inner);
}

static int slope(rewriting *r, int a) {
    if (r->to[a] < 0) {
        r->to[a] = slope_found(r, a);
    }
    return r->to[a];
}

int graph_slope(graph *g, int a, int variable) {
    rewriting r = begin(g, variable);
    const int found = slope(&r, a);
    free(r.to);
    return found;
}

static int without(rewriting *r, int a);

static int without_found(rewriting *r, int a) {
    graph *g = r->graph;
    const node n = g->node[a];
    const bool has_left = n.kind != NODE_NUMBER && n.kind != NODE_VARIABLE;
    const bool has_right = n.kind == NODE_SUM || n.kind == NODE_DIFFERENCE ||
                           n.kind == NODE_PRODUCT || n.kind == NODE_RATIO;
    const int left = has_left ? without(r, n.left) : -1;
    const int right = has_right ? without(r, n.right) : -1;
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

static int without(rewriting *r, int a) {
    if (r->to[a] < 0) {
        r->to[a] = without_found(r, a);
    }
    return r->to[a];
}

int graph_without(graph *g, int a, int first) {
    rewriting r = begin(g, first);
    const int found = without(&r, a);
    free(r.to);
    return found;
}
