/* graph.h: expressions as a graph of operations in which equal subexpressions are one node. Numbers are enclosures, and
 * simplifications (0 + x, 1 x, x - x) hold for all real values. A proof cannot use algebra/normal_form.h:
 * there, a sum below 1e-14 of its larger addend counts as 0. Nodes are numbered from 0, operands before their users. */
#ifndef PROVE_GRAPH_H
#define PROVE_GRAPH_H

#include <stdbool.h>

#include "host/lang/model.h"
#include "host/number/enclosure.h"

typedef enum node_kind {
    NODE_NUMBER,   /* number */
    NODE_VARIABLE, /* the variable's number is in `left` */
    NODE_SUM,
    NODE_DIFFERENCE,
    NODE_PRODUCT,
    NODE_MULTIPLE, /* number * left */
    NODE_SQUARE,
    NODE_RATIO,
    NODE_SINE,   /* sine of `left`; the next node is the cosine */
    NODE_COSINE, /* right: the sine of the same angle */
    NODE_EXP,
    NODE_LOG,
    NODE_POWER /* left ^ number, left > 0 */
} node_kind;

typedef struct node {
    node_kind kind;
    int left; /* -1: no operand */
    int right;
    enclosure number;
} node;

typedef struct graph {
    node *node;
    int count;
    int room;
    int *slot; /* [slots] hash table of nodes; -1: empty */
    int slots;
} graph;

enum { GRAPH_NODES_MAX = 20000 }; /* limit on the nodes of the equations of motion */

graph *graph_new(void);
void graph_free(graph *g);

int graph_number(graph *g, enclosure value);
int graph_whole(graph *g, int value);
int graph_variable(graph *g, int which);
int graph_add(graph *g, int a, int b);
int graph_sub(graph *g, int a, int b);
int graph_mul(graph *g, int a, int b);
int graph_div(graph *g, int a, int b);
int graph_neg(graph *g, int a);
int graph_sine(graph *g, int a);
int graph_cosine(graph *g, int a);
int graph_exp(graph *g, int a);
int graph_log(graph *g, int a);
int graph_power(graph *g, int a, enclosure exponent);

bool graph_is_number(const graph *g, int a);
bool graph_is_zero(const graph *g, int a);

int graph_slope(graph *g, int a, int variable);
/* Returns `a` with 0 in place of the variables from `first` on. */
int graph_without(graph *g, int a, int first);

/* === conversion of a model's expressions ====================================================== */
/* Parameters, inputs and starts are exact decimals, not doubles. */

typedef struct reader_symbols {
    graph *graph;
    const instance *instance;
    /* Derivative p of unknown i is variable first[i] + p; the highest one (p = order[i]) is variable highest + i. */
    int *first;     /* [coordinate_count] */
    int *order;     /* [coordinate_count] */
    int highest;    /* number of states */
    int *parameter; /* [parameter_count] node of each parameter; -1: not made yet */
    int *let;       /* [let_count] node of each `let`; -1: not made yet */
    diags *errors;
} reader_symbols;

int read_node(reader_symbols *s, const expr *tree); /* -1: refused (reported) */

#endif
