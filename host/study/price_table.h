/* price_table.h: error against price of all settings: the table that `whirl price` and `whirl choose` print. */
#ifndef PRICE_TABLE_H
#define PRICE_TABLE_H

#include "trial.h"

/* The cost of a simulated second: rows are sorted by it. */
typedef enum table_unit {
    PRICE_CYCLES,
    PRICE_INSTRUCTIONS, /* on boards without counted cycles */
    PRICE_EVALUATIONS   /* of the accelerations, with contacts: counted in the run */
} table_unit;
extern const char *const table_unit_words[]; /* "cycles", ... */

typedef struct table_price {
    table_unit unit;
    cost_basis basis;
    double value;
    double least, most;
} table_price;

/* With contacts, all steps of a run are counted, at each place of a range. */
typedef struct counted_run {
    double steps; /* counted, of all places; 0: these were no whole runs */
    double
        instructions_bound; /* the most that a step is declared to take (docs/dev/events.md); 0: not known */
    double cycles_bound;
} counted_run;

typedef struct table_row {
    setting setting;
    deviation_pace pace;
    trial_result result;
    cost cost;
    counted_run run;
    table_price price;
    bool counted;  /* its cost was counted, or could not be */
    bool on_front; /* no row is as cheap and errs less */
} table_row;

typedef struct table {
    table_row *row; /* [count] by price, then by error */
    int count;
    int settings;    /* that the scene takes */
    int unpriced;    /* of these, without a price; left out: */
    const char *why; /* of one of them, or "" */
    int broken_off;  /* finer steps would have taken more operations */
} table;

/* The requested error, divided by the largest permitted error of a chosen row. */
#define TABLE_MARGIN 2.0

typedef struct table_wish {
    double operations;  /* most that all trials may evaluate */
    const bool *method; /* [WH_METHODS]; NULL: the default ones */
    double error; /* steps need not be finer than keep half of this; 0: until rounding stops them */
    double rate_Hz;   /* of calls, each of which takes whole steps; 0: any step */
    uint64_t periods; /* of 1/rate in a record's spacing; 1 without a rate */
    int workers;
    void (*progress)(void *context, int done, int of); /* may be NULL */
    void *context;
} table_wish;

/* The paces that are tried, rung by rung: finer by 2 to 2.5 each; or 1, 2, 3, ... steps of a period. False: there are no
 * more. */
bool table_pace(const table_wish *w, int rung, deviation_pace *pace);
/* Steps of a period; 0 without a rate. */
uint64_t table_substeps(const table_wish *w, const table_row *row);

/* Tries settings on several processors, each with its own share of the operations: the rows do not depend on
 * either. Check t->stopped. */
table *table_new(trials *t, const table_wish *w);
void table_free(table *made);
/* By price, and the front marked. */
void table_sort(table *made);

/* *known: false without a price. */
table_price table_price_of(const cost *c, double step_s, bool *known);

#endif
