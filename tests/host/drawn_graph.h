/* drawn_graph.h: drawn expressions of some variables, as steps of which each takes those before it; what nodes of a graph
 * (host/prove/graph.h) they are, and their truncated series in long double, found by another way than recurrences: of a
 * function the sum of its derivatives over factorials, times powers of what is behind the first coefficient. Numbers are
 * complex, so that a tiny imaginary part of a variable tells the slope by it without a difference. */
#ifndef TESTS_HOST_DRAWN_GRAPH_H
#define TESTS_HOST_DRAWN_GRAPH_H

#include <complex.h>

#include "command.h"
#include "host/prove/graph.h"

enum { DRAWN_VARIABLES = 3, DRAWN_STEPS = 20, DRAWN_ORDER = 7 };

/* So large is the imaginary part. */
#define DRAWN_TINY 1e-30L

/* Each is defined wherever it is asked: a logarithm is one of 2 + u^2, and so on. */
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
    DRAWN_WHOLE, /* u^number, a whole number above zero */
    DRAWN_KINDS
} drawn_kind;

typedef struct drawn_step {
    drawn_kind kind;
    int left; /* the first steps are the variables themselves */
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

/* Every kind is among them; near the values x[DRAWN_VARIABLES] none is large. */
void drawn_graph_draw(drawn_graph *d, dice *die, const double *x);
/* made[DRAWN_STEPS]; the variables are nodes 0 to DRAWN_VARIABLES - 1 of a graph that is empty yet. */
void drawn_graph_nodes(const drawn_graph *d, graph *g, int *made);
/* of[DRAWN_STEPS], to this order; x[DRAWN_VARIABLES]. */
void drawn_graph_series(const drawn_graph *d, const series *x, int order, series *of);

/* What a graph's nodes are, value[g->count], numbers being the middles of their enclosures. */
void drawn_graph_values(const graph *g, const long double *x, long double *value);

#endif
