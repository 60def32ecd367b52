/* reader.h: conversion of a model's expressions to nodes of a graph. Parameters, inputs and starts are exact decimals,
 * not doubles. */
#ifndef PROVE_READER_H
#define PROVE_READER_H

#include "host/lang/model.h"
#include "host/prove/graph.h"

typedef struct reader_symbols {
    graph *graph;
    const instance *instance;
    int *
        first; /* [coordinate_count] the variable of an unknown's value; its rate is the next one */
    int *
        order; /* [coordinate_count] of its highest derivative, which is variable highest + unknown */
    int highest;    /* number of variables of the state */
    int *parameter; /* [parameter_count] nodes; -1: not yet */
    int *let;       /* [let_count] the same */
    diags *errors;
} reader_symbols;

/* The node, or -1: reported. */
int read_node(reader_symbols *s, const expr *tree);

#endif
