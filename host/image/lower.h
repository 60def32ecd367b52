/* lower.h: conversion of polys to operations: evaluation and reuse of sines, factoring, sharing. */
#ifndef IMAGE_LOWER_H
#define IMAGE_LOWER_H

#include "host/algebra/poly.h"
#include "host/image/op_list.h"

/* === powers from multiple angles ============================================================== */

/* coefficient * the mono's factors * sin(angle)^sines * cos(angle)^cosines */
typedef struct piece {
    double coefficient;
    const mono *mono;  /* only its factors count, not its own sine or cosine */
    const poly *angle; /* NULL if sines and cosines are 0 */
    int sines;
    int cosines;
} piece;

/* Replaces sums that cancel at x = 0 or x = pi/2 by products of powers of sin(x) and cos(x), which keep their digits
 * there. Example: 3 - 4 cos 2x + cos 4x = 8 sin(x)^4 (at the poles of spherical coordinates). x may be a sum of terms
 * with whole-number coefficients. Returns the number of pieces written to pieces[p->count]. */
int pieces_of(algebra *a, const poly *p, piece *pieces);

typedef struct wave wave;

typedef struct lowering {
    algebra *algebra;
    op_list *list;
    /* returns the operation for the derivative of order `primes` of `sym` */
    int (*leaf)(void *context, op_list *t, const symbol *sym, int primes);
    /* the index of the symbol's turn angle, or -1 */
    int (*turn)(void *context, const symbol *sym);
    void *context;
    /* rank, by size, of the angle that lower_plan() takes first (0: the smallest) */
    int lead;
    wave *waves;
    int wave_count;
    int *uses; /* [uses_room] working memory, one entry for each operation, zero between uses */
    int uses_room;
} lowering;

/* Announces all polys before the first is lowered, because the choice of evaluated sines depends on all of them. */
void lower_plan(lowering *l, const poly *const *polys, int count);

int lower(lowering *l, const poly *p);

void lower_done(lowering *l);

/* === sums of products of operations =========================================================== */

#define FACTORS_MAX 24

typedef struct node_power {
    int node;
    int exponent; /* positive */
} node_power;

typedef struct node_product {
    double coefficient;
    int count;
    node_power powers[FACTORS_MAX];
} node_product;

/* Multiplies the product by node^exponent. */
void lower_multiply(lowering *l, node_product *p, int node, int exponent);

/* Returns the operation for the sum of the products, which are overwritten. Shared factors are taken out. */
int lower_sum(lowering *l, node_product *products, int count);

/* Can `sym` be a turn angle? It can if p has it only inside sines, cosines and tangents, with whole-number factors. */
bool lower_only_in_waves(const poly *p, const symbol *sym);

#endif
