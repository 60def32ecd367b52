/* horizon.h: the time until which each coordinate of a run is accurate to a tolerance, by step doubling
 * (step_doubling.h). After this time, the two runs differ by more than the tolerance times the coordinate's range.
 * Measurements: docs/dev/stability.md. */
#ifndef CHECK_HORIZON_H
#define CHECK_HORIZON_H

#include <stdio.h>

#include "energy_residual.h"
#include "host/check/step_doubling.h"
#include "host/engine/loop.h"

#define HORIZON_TOLERANCE 1e-3

typedef enum horizon_verdict {
    HORIZON_TO_THE_END,
    HORIZON_UNTIL,    /* the column is accurate only up to until_s */
    HORIZON_STILL,    /* the column is constant, so it is accurate to the end */
    HORIZON_ROUNDING, /* only round-off changes the column, so it counts as constant */
    HORIZON_UNKNOWN,  /* unknown: too few digits in both runs, or an angle too large for a sine */
} horizon_verdict;

typedef struct horizon_column {
    horizon_verdict verdict;
    /* Largest minus least value, in the column's unit. If the state does not contain the derivative of this column,
     * the range is at least 1e-3 (in double, 1e-9) of the column's largest magnitude. */
    double range;
    double rounding; /* bound on the round-off in the finer run */
    double off;      /* largest difference between the two runs, times step_doubling.left_out */
    double until_s;  /* time of the last comparison within the tolerance, or the end of the run */
} horizon_column;

typedef struct horizon {
    const step_doubling *of;
    double tolerance;
    horizon_column *column; /* [of->columns]; entry 0, the time, is unused */
    bool to_the_end;        /* all columns are accurate to the end */
    int first;              /* the column whose accuracy ends first; -1: none before the end */
    double until_s;         /* until_s of the column `first`, or the end of the run */
} horizon;

horizon horizon_of(const step_doubling *t, double tolerance);
/* False if only round-off moves column k. The error of such a column is meaningless. */
bool horizon_moves(const step_doubling *t, int k);
/* The run is accurate until this time, s; below 0: unknown (HORIZON_UNKNOWN, or the steps alias). */
double horizon_trusted_s(const horizon *h);
void horizon_free(horizon *h);

/* === aliasing ==================================================================================== */

/* Sets t->aliased. If the budget is too small, sets t->unaliased. Call this function after both runs have ended. */
void aliasing_find(step_doubling *t, budget *of);

/* === in words ================================================================================= */
/* Prints the time until which each column is accurate, and the balances. `b`: NULL if the system has no energies. */
void horizon_print(FILE *out, const horizon *h, const books *b, const energy_residual *balance);
/* Prints one line for a summary. `doubted`: the run has a warning, and the finer run may have the same error. */
void horizon_print_line(FILE *out, const horizon *h, bool doubted);
extern const char *const horizon_words[];
/* Writes CSV: a header, and a row for each coordinate and rate. */
void horizon_write(FILE *out, const horizon *h);

#endif
