/* drawn_graph.h: random expressions as sequences of steps, as nodes of a graph (host/prove/graph.h) and as truncated
 * series in long double. The series of a function is the sum of its derivatives over factorials, times powers of the
 * series without its first coefficient; the program uses recurrences. Numbers are complex: a tiny imaginary part of a
 * variable yields the slope without a difference (complex-step derivative). */
#ifndef TESTS_HOST_DRAWN_GRAPH_H
#define TESTS_HOST_DRAWN_GRAPH_H

#include <complex.h>

#include "command.h"
#include "host/prove/graph.h"

enum { DRAWN_VARIABLES = 3, DRAWN_STEPS = 20, DRAWN_ORDER = 7 };

/* Size of the imaginary part. */
#define DRAWN_TINY 1e-30L

/* Kinds of steps. Each is defined everywhere; the logarithm, for example, is log(2 + u^2). */
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
    int left; /* the first steps are the variables; otherwise the first operand */
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

/* Draws an expression with every kind of step. Its values stay moderate near x[DRAWN_VARIABLES]. */
void drawn_graph_draw(drawn_graph *d, dice *die, const double *x);
/* Adds the expression's nodes to an empty graph: made[DRAWN_STEPS]. The variables are nodes 0 to DRAWN_VARIABLES - 1. */
void drawn_graph_nodes(const drawn_graph *d, graph *g, int *made);
/* Series to this order, of[DRAWN_STEPS], at x[DRAWN_VARIABLES]. */
void drawn_graph_series(const drawn_graph *d, const series *x, int order, series *of);

/* Values of a graph's nodes, value[g->count]. Its numbers are the midpoints of their enclosures. */
void drawn_graph_values(const graph *g, const long double *x, long double *value);

#endif
