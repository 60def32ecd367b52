/* cost_row.h: how the fitted figures of cost_rows.h are kept: a row for each board and number. For host/price and
 * mk/price only. */
#ifndef PRICE_COST_ROW_H
#define PRICE_COST_ROW_H

#include "cost_features.h"

/* A feature that no fitted scene has: nothing is known of what it costs. */
#define COST_UNSEEN (-1.0)

/* A promise within more than this factor is none: then it is not known. */
#define COST_BOUND_MOST 4.0

/* Scenes that are not known equally well: X(id, what is said of them). */
#define COST_CLASS_ROWS(X) \
    X(PLAIN, "") \
    X(CALLING, ", with functions") /* whose time depends on what they are given */ \
    X(BOOKING, ", with books")     /* whose expressions a compiler may share with the step's */ \
    X(AS_MATRIX, ", as one matrix") \
    X(TABLED, ", with tables") \
    X(FAR, \
      ", beyond what was fitted") /* of any of these: told from what no fitted row had so much of */
#define COST_CLASS_ID(id, says) COST_##id,
typedef enum cost_class { COST_CLASS_ROWS(COST_CLASS_ID) COST_CLASSES } cost_class;
#undef COST_CLASS_ID
/* One quantity: the sum of figure[f] times feature f. */
typedef struct cost_fit {
    int cases;    /* fitted on; 0: there is no such fit */
    double slack; /* what is off by no more than this is not asked for its factor: of small steps */
    double bound[COST_CLASSES]; /* no scene, fitted on or not, was off by more than this factor */
    double largest;             /* of what was fitted */
    double figure[COST_FEATURES];
    bool is_parted;             /* is the next known? */
    double part[COST_FEATURES]; /* most that this feature was of a fitted row's sum */
} cost_fit;

typedef struct cost_row {
    const char *board;
    cost_number number;
    const char *compiler; /* and flags */
    const char *methods;  /* that were measured, a blank before and behind each word */
    double spread;        /* the longest step over the mean, without contacts */
    double spread_cycles;
    cost_fit fit[COST_QUANTITIES];
} cost_row;

/* Between what a sum is promised to be. */
double cost_least(const cost_fit *fit, double sum, double bound);
double cost_most(const cost_fit *fit, double sum, double bound);
/* What a row of this sum is; with COST_FAR it may be another of the classes besides. */
cost_class cost_class_at(const cost_fit *fit, const double feature[static COST_FEATURES],
                         double sum);
/* The bound that is promised of it. */
double cost_bound_at(const cost_fit *fit, const double feature[static COST_FEATURES], double sum);
/* The sum; negative where a feature is unseen, which is then *unseen. */
double cost_fit_at(const cost_fit *fit, const double feature[static COST_FEATURES], int *unseen);

#endif
