/* cost_fixed_row.h: what is counted in a step in fixed point to price it: the classes of work of its list
 * (host/fixed/fixed_list.h), a row each; and how the figures are kept that are fitted to counted steps (cost_fixed_rows.h,
 * which `make price-fit-fixed` writes).
 *
 * It has none of what steps of reals differ by: one method, no compensated sums, no calls. What it has instead are shifts,
 * constants with an empty half, and products that are long on processors without one of 64 bits; figures are a board's, so
 * features say nothing of that.
 *
 * X(id, quantities that it takes part in, how often), as in cost_features.h; `c` is a cost_fixed_counts. */
#ifndef PRICE_COST_FIXED_ROW_H
#define PRICE_COST_FIXED_ROW_H

#include "cost_features.h"

typedef struct cost_fixed_counts {
    int sums; /* and differences */
    int products;
    int by_constant; /* of these: one factor is known, */
    int by_short;    /* and its lower half is zero: half a product where that is made of parts */
    int rounded;     /* operands that are shifted to the right */
    int scaled;      /* to the left */
    int bits;        /* of all shifts, but for whole bytes */
    int quotients;
    int searched; /* of these: the zeros in front of the denominator are counted */
    int waves;
    int terms; /* further angles, or multiples, in these */
    int same;
    int choices; /* sizes, signs, the lesser, the larger */
    int leaves;
    int constants; /* that are operands of sums */
    int results;
    int carried; /* values that wait for longer than some operations */
    int operations;
    int angles;       /* of second order; */
    int places;       /* linear ones, */
    int still_angles; /* of both those whose acceleration is a constant */
    int still_places;
    int firsts; /* components of first order */
    int first_angles;
    int staged_angles; /* that later stages need */
    int staged_places;
    int staged_rates;
    int components;
    int state_bytes;
    int numbers; /* of the state and inputs that have a format */
    bool called; /* the list is a function of its own */
    bool one;    /* wave alone, which no board calls */
} cost_fixed_counts;

/* A stage evaluates it; the code has it once, or at each stage. */
#define COST_FIXED_COPIES(what) ((c->called ? 1 : 4) * (what))
/* clang-format off */
#define COST_FIXED_ROWS(X) \
    X(ONE, COST_TIME | COST_CODE | COST_DATA | COST_DEPTH, 1) \
    X(ANGLES, COST_TIME | COST_CODE, c->angles) \
    X(PLACES, COST_TIME | COST_CODE, c->places) \
    X(STILL_ANGLES, COST_TIME | COST_CODE, c->still_angles) \
    X(STILL_PLACES, COST_TIME | COST_CODE, c->still_places) \
    X(STAGED_ANGLES, COST_TIME | COST_CODE, c->staged_angles) \
    X(STAGED_PLACES, COST_TIME | COST_CODE, c->staged_places) \
    X(STAGED_RATES, COST_TIME | COST_CODE, c->staged_rates) \
    X(FIRSTS, COST_TIME | COST_CODE, c->firsts) \
    X(FIRST_ANGLES, COST_TIME | COST_CODE, c->first_angles) \
    X(LIES_COMPONENTS, COST_DEPTH, c->components) \
    X(LIES_RATES, COST_DEPTH, c->angles + c->places + c->still_angles + c->still_places) \
    X(CALLED, COST_TIME | COST_CODE | COST_DEPTH, c->called) \
    X(CALLED_DATA, COST_TIME, c->called ? c->leaves + c->results : 0) \
    X(SUMS, COST_TIME, c->sums) \
    X(PRODUCTS, COST_TIME, c->products - c->by_constant) \
    X(BY_CONSTANT, COST_TIME, c->by_constant - c->by_short) \
    X(BY_SHORT, COST_TIME, c->by_short) \
    X(ROUNDED, COST_TIME, c->rounded) \
    X(SCALED, COST_TIME, c->scaled) \
    X(BITS, COST_TIME, c->bits) \
    X(QUOTIENTS, COST_TIME, c->quotients) \
    X(SEARCHED, COST_TIME, c->searched) \
    X(WAVE_ALONE, COST_TIME, c->one) \
    X(WAVES, COST_TIME, c->one ? 0 : c->waves) \
    X(TERMS, COST_TIME, c->terms) \
    X(SAME, COST_TIME, c->same) \
    X(CHOICES, COST_TIME, c->choices) \
    X(LEAVES, COST_TIME, c->leaves) \
    X(CONSTANTS, COST_TIME, c->constants) \
    X(CARRIED, COST_TIME | COST_DEPTH, c->carried) \
    X(CODE_SUMS, COST_CODE, COST_FIXED_COPIES(c->sums)) \
    X(CODE_PRODUCTS, COST_CODE, COST_FIXED_COPIES(c->products - c->by_constant)) \
    X(CODE_BY_CONSTANT, COST_CODE, COST_FIXED_COPIES(c->by_constant - c->by_short)) \
    X(CODE_BY_SHORT, COST_CODE, COST_FIXED_COPIES(c->by_short)) \
    X(CODE_SHIFTS, COST_CODE, COST_FIXED_COPIES(c->rounded + c->scaled)) \
    X(CODE_QUOTIENTS, COST_CODE, COST_FIXED_COPIES(c->quotients)) \
    X(CODE_WAVE_ALONE, COST_CODE, c->one ? COST_FIXED_COPIES(1) : 0) \
    X(CODE_WAVES, COST_CODE, c->one ? 0 : COST_FIXED_COPIES(c->waves)) \
    X(CODE_OTHERS, COST_CODE, COST_FIXED_COPIES(c->same + c->choices + c->terms)) \
    X(CODE_LEAVES, COST_CODE, COST_FIXED_COPIES(c->leaves)) \
    X(CODE_CARRIED, COST_CODE, COST_FIXED_COPIES(c->carried)) \
    X(ANY_WAVE, COST_CODE | COST_DATA | COST_DEPTH, c->waves > 0) \
    X(ANY_SHARED_WAVE, COST_CODE | COST_DEPTH, c->waves > 1) \
    X(ANY_QUOTIENT, COST_CODE | COST_DATA | COST_DEPTH, c->quotients > 0) \
    X(NUMBERS, COST_CODE | COST_DATA, c->numbers) \
    X(STATE_BYTES, COST_CODE | COST_DATA, c->state_bytes) \
    X(LIES_WAVES, COST_DEPTH, c->waves) \
    X(LIES_OPERATIONS, COST_DEPTH, c->operations)
/* clang-format on */
#define COST_FIXED_ID(id, taken, count) COST_X_##id,
typedef enum cost_fixed_feature {
    COST_FIXED_ROWS(COST_FIXED_ID) COST_FIXED_FEATURES
} cost_fixed_feature;
#undef COST_FIXED_ID

/* One quantity on one board, as cost_fit in cost_row.h: the sum of figure[f] times feature f, told within bound. */
typedef struct cost_fixed_fit {
    int cases; /* 0: there is no such fit */
    double bound;
    double largest;
    double figure[COST_FIXED_FEATURES];
} cost_fixed_fit;

typedef struct cost_fixed_row {
    const char *board;
    const char *compiler; /* and flags */
    double spread;        /* the longest step over the mean */
    double spread_cycles;
    cost_fixed_fit fit[COST_QUANTITIES];
} cost_fixed_row;

#endif
