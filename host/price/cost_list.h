/* cost_list.h: what lists of operations hold, counted. For host/price only. */
#ifndef PRICE_COST_LIST_H
#define PRICE_COST_LIST_H

#include "host/image/tape.h"
#include "operands.h"

/* What lists of operations hold. */
typedef struct cost_list {
    int sums;
    int products;
    int quotients;
    int roots;
    int sizes; /* and negations */
    int signs;
    int choices;   /* the lesser, the larger */
    int leaves;    /* that are read */
    int constants; /* that differ */
    int results;
    int pairs;   /* of sine and cosine, of turn angles */
    int terms;   /* further angles, or multiples, in these */
    int radians; /* pairs of what is in radians */
    int powers;
    int cells;    /* of tables, that a phase is looked up in, */
    int lines;    /* and what is interpolated there, by straight pieces */
    int cubics;   /* and by cubic ones, */
    int mirrored; /* of both, what is odd and told by its other half */
    int calls[FUNCTIONS];
    double zero_sums; /* of the sums, those that are given a zero, */
    double
        zero_products;  /* and of the products: on average over a run's first steps (operands.h) */
    double opposed;     /* sums of opposite signs, */
    double bits;        /* and what all sums shift by */
    double still_pairs; /* of those of turn angles, that stay where they are, */
    double zero_pairs;  /* and whose angle is zero */
    int carried;        /* between registers and memory, at best */
    int operations;     /* all that compute */
} cost_list;

/* One more operation; and what it is given. */
void cost_list_add(const tape *t, const op *o, cost_list *l);
void cost_list_add_operands(const op *o, const operand_share *given, cost_list *l);
/* A pair of turn angles: does it stay where it is, and at zero? */
void cost_list_add_pair(const tape *t, const op *o, const operands *given, cost_list *l);
/* All of a list. */
void cost_list_add_all(const tape *t, cost_list *l);
/* Counts of the ledger's list what is not in the step's anyway. `turned`: its sines are not the same, which are turned. */
void cost_list_add_unshared(const tape *t, const tape *step, bool turned, cost_list *l);

#endif
