/* price_table.h: error against price, for all settings. */
#ifndef PRICE_TABLE_H
#define PRICE_TABLE_H

#include "trial.h"

/* A figure of cost_figure a step, as it counts a simulated second: what a row is sorted by. */
typedef enum table_unit {
    PRICE_CYCLES,
    PRICE_INSTRUCTIONS, /* where nobody counts cycles */
    PRICE_EVALUATIONS /* of the accelerations, where nobody knows what they take: counted in the run */
} table_unit;
extern const char *const table_unit_words[]; /* "cycles", ... */

typedef struct table_price {
    table_unit unit;
    cost_basis basis;
    double value;
    double least, most; /* promised */
} table_price;

typedef struct table_row {
    setting setting;
    deviation_pace pace;
    trial_result result;
    cost cost;
    table_price price;
    int order;     /* in which it was tried */
    bool on_front; /* nothing is as cheap and errs less */
} table_row;

typedef struct table {
    table_row *row; /* [count] by price, then by error */
    int count;
    int settings;    /* of its own, without steps */
    bool counted;    /* no setting has a price on the board: all are priced by evaluations */
    int unpriced;    /* else those of them that nobody knows a price of, which are left out: */
    const char *why; /* of one of them, or "" */
    int coarse;      /* trials left out since they erred by more than the values themselves */
    int broken_off;  /* settings whose finer steps would have taken too long */
} table;

typedef struct table_wish {
    double operations;                                 /* most that all trials may evaluate */
    void (*progress)(void *context, int done, int of); /* may be NULL */
    void *context;
} table_wish;

/* The paces that are tried, entry `rung` from 0 on: from many records' spacings in a step to many steps in one, finer by
 * 2 to 2.5 each. */
deviation_pace table_ladder(int rung);
enum { TABLE_COARSEST = 5, TABLE_LADDER = TABLE_COARSEST + 3 * 8 };

table *table_new(trials *t, const table_wish *w); /* look at t->stopped */
void table_free(table *made);
/* By price, and the front marked. */
void table_sort(table *made);

/* How a board's steps are priced; *known: false where nobody knows. */
table_price table_price_of(const cost *c, double step_s, bool *known);

#endif
