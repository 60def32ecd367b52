/* horizon.h: until when a run is right to a tolerance, coordinate by coordinate, as far as a run with half its step tells
 * (step_doubling.h): until the first time at which the two differ by more than the tolerance times the range that the coordinate
 * has in the whole of the finer run. What this is worth is measured in docs/dev/stability.md. */
#ifndef CHECK_HORIZON_H
#define CHECK_HORIZON_H

#include <stdio.h>

#include "host/check/step_doubling.h"

#define HORIZON_TOLERANCE 1e-3

typedef enum horizon_verdict {
    HORIZON_TO_THE_END,
    HORIZON_UNTIL,    /* until_s */
    HORIZON_STILL,    /* it does not move: right to the end */
    HORIZON_ROUNDING, /* what moves of it is rounding alone: as good as still */
    HORIZON_NOT_TOLD, /* both runs have too few digits for it: that they agree says nothing */
} horizon_verdict;

typedef struct horizon_column {
    horizon_verdict verdict;
    /* In the column's unit: the most less the least value; of a rate, or what has none, a thousandth of its size at the least. */
    double range;
    double rounding; /* what rounding may move of it in the finer run, at most */
    double
        off; /* the most that the two differ by, in the same; what the finer one is itself off added */
    double
        until_s; /* the last look at which it was right; the run's end where it is right to the end */
} horizon_column;

typedef struct horizon {
    const step_doubling *of;
    double tolerance;
    horizon_column *column; /* [of->columns]; 0, the time, is not used */
    bool to_the_end;        /* all of them */
    int first;              /* the column that ends first; -1: none does */
    double until_s;         /* when; or the end */
} horizon;

horizon horizon_of(const step_doubling *t, double tolerance);
/* Does column k move, or start somewhere, by the scene? What symmetry keeps at zero does not, whatever rounding makes of it. */
bool horizon_moves(const step_doubling *t, int k);
/* Until when the run is right; below 0: not told, for want of digits or because the finer run shares what is wrong. */
double horizon_trusted_s(const horizon *h);
void horizon_free(horizon *h);

/* === in words ================================================================================= */
/* Until when a run can be trusted, in words and as comma-separated values. */

/* All of it: of each coordinate and rate, of the run, and what can be relied on behind that. */
void horizon_print(FILE *out, const horizon *h);
/* One line, for a summary. `doubted`: something is said against the run, which the runs beside it may share. */
void horizon_print_line(FILE *out, const horizon *h, bool doubted);
/* Of each verdict. */
extern const char *const horizon_words[];
/* A header, and a row for each coordinate and rate. */
void horizon_write(FILE *out, const horizon *h);

#endif
