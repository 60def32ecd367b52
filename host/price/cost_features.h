/* cost_features.h: what is counted in an image to price its steps: the classes of work, a row each.
 *
 * X(id, quantities that it takes part in, how often). Of a step's time an expression says how often a step does
 * the work; of flash, how often the code for it is there; of the stack, what lies on it. They are written in terms of
 * `c`, a cost_counts: sums over the stages of a method are made from its tableau (core/method.h), not from its name, so
 * that a method that is added is counted, too. (That it has also been measured is another question: cost_rows.h lists
 * the settings that were.)
 *
 * A new row comes wherever it belongs; `make price-fit` then makes cost_rows.h anew. For host/price only. */
#ifndef PRICE_COST_FEATURES_H
#define PRICE_COST_FEATURES_H

#include "cost_board.h"
#include "cost_list.h"
#include "host/image/image.h"
#include "step_work.h"

/* Quantities that are fitted: X(id, word, whether it is a step's time). */
#define COST_QUANTITY_ROWS(X) \
    X(INSTRUCTIONS, "instructions") \
    X(CYCLES, "cycles") \
    X(FLASH, "flash") \
    X(RAM, "RAM") \
    X(STACK, "stack") \
    X(CONTACT_MEAN, "instructions with contacts") \
    X(CONTACT_WORST, "worst step with contacts")
#define COST_QUANTITY_ID(id, word) COST_OF_##id,
typedef enum cost_quantity { COST_QUANTITY_ROWS(COST_QUANTITY_ID) COST_QUANTITIES } cost_quantity;
#undef COST_QUANTITY_ID

/* Who takes a row: sums of these. */
enum {
    COST_TIME = 1 << COST_OF_INSTRUCTIONS | 1 << COST_OF_CYCLES,
    COST_CODE = 1 << COST_OF_FLASH,
    COST_DATA = 1 << COST_OF_RAM,
    COST_DEPTH = 1 << COST_OF_STACK,
    COST_EVENTS = 1 << COST_OF_CONTACT_MEAN | 1 << COST_OF_CONTACT_WORST
};

typedef struct cost_counts {
    const image *im;
    cost_number number;
    cost_list step; /* what a stage evaluates */
    cost_list
        fixed; /* of that, what does not change from stage to stage, where a compiler sees it: then not in step */
    cost_list placed;  /* likewise what changes from place to place alone */
    cost_list matrix;  /* a whole step, which then has no stages */
    cost_list books;   /* of the ledger, likewise */
    cost_list observe; /* the outputs */
    cost_list events;  /* signals, forces and sets of contacts */
    int stages;
    int places; /* where they stand: fewer than stages where some stand at the same place (core/method.h) */
    int reaches;      /* of these, said by the row itself, other than where the step begins */
    int reach_shares; /* of stages in these */
    int scaled;       /* shares that take a product */
    int components;   /* n: coordinates, or components of first order */
    int angles;
    int linears;      /* moved by what is a rate, or by slopes */
    int moving;       /* components whose derivative is no constant */
    int staged_rates; /* that later stages need */
    int staged_linears;
    int staged_angles;
    int reals; /* in the state */
    bool second;
    bool is_matrix;
    bool turned;
    bool compensated;
    bool
        looped; /* the step is one that the old compiler of AVR does not unroll (WH_SMALL_STEP, core/unroll.h), */
    bool tabled;          /* and looks its method up in a table */
    bool called;          /* the list is a function of its own, */
    bool books_called;    /* and the ledger's */
    bool folded;          /* half of each table says it all, and is all that is there */
    double table_numbers; /* in flash */
    int copies;           /* of the list in the code */
    int lookups;          /* pairs looked up in a step */
    int turns;            /* of each pair in a step */
    int leans;            /* stages that lean */
    int shares;           /* of stages in stages */
    int ends;             /* products of stages at the step's end */
    bool
        ends_twice; /* what moves positions is all that moves rates: where sines are turned compilers do not see that */
    int state_words;
    bool soft; /* numbers are computed by software, whose time depends on operands: */
    step_work
        moves; /* then what the step itself does beside its lists, or a step as one matrix in all */
    double
        pressed; /* of the values that a stage leaves to later ones, those beyond half of an FPU's registers, */
    double spilled;  /* and beyond all of them */
    int evaluations; /* most in a step */
    double smooth;   /* a step without its contacts, predicted: filled in by cost.c */
} cost_counts;

cost_counts cost_counts_of(const image *im, const cost_board *board, cost_number number);

/* What is computed of zeros where a pair is looked up at an angle of zero (wh_sincos_parts()). */
enum { COST_ZERO_PRODUCTS = 8, COST_ZERO_SUMS = 5 };

/* How often a step does what a list holds so many of, and how often its code has it. */
#define COST_EACH(what) (c->stages * c->step.what + c->places * c->placed.what + c->fixed.what)
#define COST_COPIES(what) \
    (c->copies * c->step.what + (c->called ? 1 : c->places) * c->placed.what + c->fixed.what)
/* What is so in any of the list. */
#define COST_ALL(what) (c->step.what + c->placed.what + c->fixed.what)
/* clang-format off */
#define COST_CALL_ROW(X, FN) \
    X(CALL_##FN, COST_TIME, COST_EACH(calls[FN_##FN]) + c->stages * c->books.calls[FN_##FN]) \
    X(CODE_##FN, COST_CODE | COST_DATA | COST_DEPTH, c->step.calls[FN_##FN] + c->observe.calls[FN_##FN] > 0)
#define COST_FEATURE_ROWS(X) \
    X(ONE, COST_CODE | COST_DATA | COST_DEPTH | COST_EVENTS, 1) \
    X(STAGED, COST_TIME, !c->is_matrix) \
    X(MATRIX, COST_TIME | COST_CODE | COST_DEPTH, c->is_matrix) \
    X(MATRIX_SUMS, COST_TIME, c->soft ? 0 : c->matrix.sums) \
    X(MATRIX_PRODUCTS, COST_TIME, c->soft ? 0 : c->matrix.products) \
    X(MATRIX_CODE_SUMS, COST_CODE, c->matrix.sums) \
    X(MATRIX_CODE_PRODUCTS, COST_CODE, c->matrix.products) \
    X(MATRIX_LEAVES, COST_TIME | COST_CODE, c->matrix.leaves) \
    X(MATRIX_CONSTANTS, COST_TIME | COST_CODE, c->matrix.constants) \
    X(MATRIX_CARRIED, COST_TIME | COST_CODE | COST_DEPTH, c->matrix.carried) \
    X(MATRIX_REALS, COST_TIME | COST_CODE | COST_DEPTH, c->is_matrix ? c->reals : 0) \
    X(MATRIX_ANGLES, COST_TIME | COST_CODE | COST_DEPTH, c->is_matrix ? c->im->angles : 0) \
    X(MATRIX_SUMS_KEPT, COST_TIME | COST_CODE | COST_DEPTH, \
      c->is_matrix && c->im->settings.compensated) \
    X(MATRIX_CARRY, COST_TIME | COST_CODE | COST_DEPTH, \
      c->is_matrix && c->im->settings.compensated ? c->reals : 0) \
    X(LATER_STAGES, COST_TIME | COST_CODE, c->moving > 0 ? c->stages - 1 : 0) \
    X(MANY_STAGES, COST_TIME | COST_CODE, c->moving > 0 && c->stages > 1) \
    X(LOOPED, COST_TIME | COST_CODE | COST_DEPTH, c->looped) \
    X(TABLEAU, COST_CODE | COST_DATA, c->tabled) \
    X(LOOPED_STAGES, COST_TIME, c->looped ? c->stages * c->components : 0) \
    X(TABLED_STAGES, COST_TIME, c->tabled ? c->stages * c->components : 0) \
    X(TABLED_SHARES, COST_TIME, \
      c->tabled ? (c->stages - 1) * c->stages * c->components * (c->second ? 2 : 1) : 0) \
    X(LOOPED_PAIRS, COST_TIME | COST_DEPTH, c->looped ? c->stages * c->step.pairs : 0) \
    X(MANY_STAGES_MOVING, COST_TIME | COST_CODE, c->stages > 1 ? c->moving : 0) \
    X(ANGLES, COST_TIME | COST_CODE, c->angles) \
    X(LINEARS, COST_TIME | COST_CODE, c->linears) \
    X(RATES, COST_TIME | COST_CODE | COST_DEPTH, c->second ? c->components : 0) \
    X(PRESSED, COST_TIME, c->stages * c->pressed) \
    X(SPILLED, COST_TIME, c->stages * c->spilled) \
    X(STILL, COST_TIME, c->components - c->moving) \
    X(MOVING, COST_TIME | COST_CODE, c->moving) \
    X(STAGE_RATES, COST_TIME | COST_CODE, (c->stages - 1) * c->staged_rates) \
    X(STAGE_LINEARS, COST_TIME | COST_CODE, c->reaches > 0 ? 0 : (c->stages - 1) * c->staged_linears) \
    X(STAGE_ANGLES, COST_TIME | COST_CODE, \
      c->turned && !c->im->ledger.kept ? 0 \
      : c->reaches > 0                 ? c->reaches * c->staged_angles \
                                       : (c->stages - 1) * c->staged_angles) \
    X(REACHES, COST_TIME | COST_CODE, \
      c->reaches * (c->staged_linears + (c->turned ? 0 : c->staged_angles))) \
    X(REACH_SHARES, COST_TIME | COST_CODE, \
      c->reach_shares * (c->staged_linears + (c->turned ? 0 : c->staged_angles))) \
    X(REACH_STAGES, COST_TIME | COST_CODE, c->reaches > 0 ? (c->stages - 1) * c->staged_rates : 0) \
    X(REACH_LEANS, COST_TIME | COST_CODE, c->turned ? c->reach_shares * c->step.pairs : 0) \
    X(SHARES, COST_TIME | COST_CODE, c->shares * c->staged_rates) \
    X(SHARES_LINEAR, COST_TIME | COST_CODE, c->reaches > 0 ? 0 : c->shares * c->staged_linears) \
    X(SCALED, COST_TIME | COST_CODE, c->scaled * (c->staged_rates + (c->reaches > 0 ? 0 : c->staged_linears))) \
    X(ENDS, COST_TIME | COST_CODE, c->ends * c->moving) \
    X(ENDS_TWICE, COST_TIME, c->ends_twice ? c->moving : 0) \
    X(LOOKED_UP_ONCE, COST_TIME, c->turned ? c->lookups - c->step.zero_pairs : 0) \
    X(LOOKED_UP_ZERO, COST_TIME, c->turned ? c->step.zero_pairs : 0) \
    X(LOOKED_UP_ONCE_CODE, COST_CODE, c->turned ? c->lookups : 0) \
    X(LOOKED_UP, COST_TIME, \
      (c->turned ? 0 : c->lookups - c->stages * c->step.zero_pairs) + c->stages * c->books.pairs) \
    X(LOOKED_UP_CODE, COST_CODE, c->turned ? 0 : c->step.pairs * (c->called ? 1 : c->places)) \
    X(LOOKED_UP_TERMS, COST_TIME | COST_CODE, c->step.terms * (c->turned ? 1 : c->places)) \
    X(TURN_BEGIN, COST_TIME | COST_CODE, c->turned && c->turns > 0 ? c->step.pairs : 0) \
    X(TURNS, COST_TIME, c->turned ? c->turns * (c->step.pairs - c->step.still_pairs) : 0) \
    X(LEANS, COST_TIME, c->turned ? c->leans * (c->step.pairs - c->step.still_pairs) : 0) \
    X(LEANS_FAR, COST_TIME, \
      c->turned && !c->second ? c->leans * (c->step.pairs - c->step.still_pairs) : 0) \
    X(TURNS_STILL, COST_TIME, c->turned ? (c->turns + c->leans) * c->step.still_pairs : 0) \
    X(TURNS_CODE, COST_CODE, c->turned ? c->turns * c->step.pairs : 0) \
    X(LEANS_CODE, COST_CODE, c->turned ? c->leans * c->step.pairs : 0) \
    X(LEANS_FAR_CODE, COST_CODE, c->turned && !c->second ? c->leans * c->step.pairs : 0) \
    X(LEAN_TERMS, COST_TIME | COST_CODE, c->turned ? c->leans * c->step.terms : 0) \
    X(TURNED_SUMS, COST_TIME | COST_CODE, \
      c->turned && c->compensated ? (c->turns + c->leans) * c->step.pairs : 0) \
    X(CARRY_ANGLES, COST_TIME | COST_CODE, c->compensated ? c->angles : 0) \
    X(CARRY_LINEARS, COST_TIME | COST_CODE, c->compensated ? c->linears : 0) \
    X(CARRY_REALS, COST_TIME | COST_CODE | COST_DEPTH, c->compensated ? c->reals : 0) \
    X(CELLS, COST_TIME | COST_DEPTH, COST_EACH(cells)) \
    X(LINES, COST_TIME, COST_EACH(lines)) \
    X(CUBICS, COST_TIME, COST_EACH(cubics)) \
    X(FOLDS, COST_TIME, c->folded ? COST_EACH(cells) : 0) \
    X(MIRRORED, COST_TIME, c->folded ? COST_EACH(mirrored) : 0) \
    X(CODE_CELLS, COST_CODE, COST_COPIES(cells)) \
    X(CODE_LINES, COST_CODE, COST_COPIES(lines)) \
    X(CODE_CUBICS, COST_CODE, COST_COPIES(cubics)) \
    X(CODE_MIRRORED, COST_CODE, c->folded ? COST_COPIES(mirrored) : 0) \
    X(TABLE_BYTES, COST_CODE, c->table_numbers * (c->number == COST_DOUBLE ? 8 : 4)) \
    X(SUMS, COST_TIME, COST_EACH(sums) - COST_EACH(zero_sums) + c->moves.sums) \
    X(ZERO_SUMS, COST_TIME, COST_EACH(zero_sums) + c->moves.zero_sums) \
    X(OPPOSED, COST_TIME, COST_EACH(opposed) + c->matrix.opposed) \
    X(SHIFTED, COST_TIME, COST_EACH(bits) + c->matrix.bits) \
    X(ZERO_PRODUCTS, COST_TIME, COST_EACH(zero_products) + c->moves.zero_products) \
    X(PRODUCTS, COST_TIME, COST_EACH(products) - COST_EACH(zero_products) + c->moves.products) \
    X(CONVERTED, COST_TIME, c->moves.conversions) \
    X(CONVERTED_ZERO, COST_TIME, c->moves.zero_conversions) \
    X(QUOTIENTS, COST_TIME, COST_EACH(quotients)) \
    X(ROOTS, COST_TIME, COST_EACH(roots)) \
    X(SIZES, COST_TIME, COST_EACH(sizes)) \
    X(SIGNS, COST_TIME, COST_EACH(signs)) \
    X(CHOICES, COST_TIME, COST_EACH(choices)) \
    X(LEAVES, COST_TIME, c->stages * c->step.leaves + c->places * c->placed.leaves + c->fixed.leaves) \
    X(CONSTANTS, COST_TIME, c->stages * c->step.constants + c->fixed.constants) \
    X(CONSTANTS_ONCE, COST_TIME | COST_DEPTH, c->step.constants) \
    X(CARRIED, COST_TIME, c->stages * c->step.carried) \
    X(CALLED, COST_TIME, c->called ? c->stages : 0) \
    X(CALLED_DATA, COST_TIME, \
      c->called ? c->stages * (c->step.leaves + c->step.results + 2 * c->step.pairs) : 0) \
    X(RADIANS, COST_TIME, COST_EACH(radians)) \
    X(POWERS, COST_TIME, COST_EACH(powers) + c->stages * c->books.powers) \
    X(BOOK_SUMS, COST_TIME, c->stages * (c->books.sums + c->books.sizes + c->books.choices)) \
    X(BOOK_PRODUCTS, COST_TIME, c->stages * c->books.products) \
    X(BOOK_QUOTIENTS, COST_TIME, c->stages * (c->books.quotients + c->books.roots)) \
    X(BOOK_RADIANS, COST_TIME, c->stages * c->books.radians) \
    X(BOOK_CARRIED, COST_TIME, c->stages * c->books.carried) \
    X(BOOK_ANGLES, COST_TIME, c->im->ledger.kept ? c->stages * c->staged_angles : 0) \
    X(BOOKS, COST_TIME | COST_CODE | COST_DEPTH, c->im->ledger.kept) \
    X(BOOK_ENTRIES, COST_TIME | COST_CODE | COST_DEPTH, \
      c->im->ledger.kept ? c->im->ledger.entries : 0) \
    X(BOOK_STAGES, COST_TIME, c->im->ledger.kept ? c->stages * c->im->ledger.smooth : 0) \
    X(BOOK_CALLED, COST_TIME, c->books_called ? c->stages : 0) \
    X(BOOK_CALLED_WITH, COST_TIME, \
      c->books_called ? c->stages * (c->books.leaves + c->books.results) : 0) \
    X(BOOK_DATA, COST_TIME, c->stages * (c->books.leaves + c->books.constants)) \
    X(BOOK_CALLED_DATA, COST_TIME, \
      c->im->ledger.asked ? c->stages * (c->step.leaves + c->step.results + 2 * c->step.pairs) : 0) \
    COST_CALL_ROW(X, TAN) \
    COST_CALL_ROW(X, ASIN) \
    COST_CALL_ROW(X, ACOS) \
    COST_CALL_ROW(X, ATAN) \
    COST_CALL_ROW(X, ATAN2) \
    COST_CALL_ROW(X, EXP) \
    COST_CALL_ROW(X, LOG) \
    COST_CALL_ROW(X, SINH) \
    COST_CALL_ROW(X, COSH) \
    COST_CALL_ROW(X, TANH) \
    X(CODE_SUMS, COST_CODE, COST_COPIES(sums)) \
    X(CODE_PRODUCTS, COST_CODE, COST_COPIES(products)) \
    X(CODE_QUOTIENTS, COST_CODE, COST_COPIES(quotients)) \
    X(CODE_ROOTS, COST_CODE, COST_COPIES(roots)) \
    X(CODE_SIZES, COST_CODE, COST_COPIES(sizes)) \
    X(CODE_SIGNS, COST_CODE, COST_COPIES(signs)) \
    X(CODE_CHOICES, COST_CODE, COST_COPIES(choices)) \
    X(CODE_LEAVES, COST_CODE, COST_COPIES(leaves)) \
    X(CODE_CONSTANTS, COST_CODE, c->step.constants + c->fixed.constants) \
    X(CODE_CARRIED, COST_CODE, c->copies * c->step.carried) \
    X(CODE_CALLED, COST_CODE | COST_DEPTH, c->called) \
    X(CODE_RADIANS, COST_CODE, COST_COPIES(radians) + c->observe.radians) \
    X(CODE_CALLS, COST_CODE | COST_DEPTH, cost_calls(&c->step) * c->copies) \
    X(CODE_BOOKS, COST_CODE, c->books.operations) \
    X(OBSERVED, COST_CODE, c->observe.sums + c->observe.products + c->observe.sizes + c->observe.signs + c->observe.choices) \
    X(OBSERVED_CONSTANTS, COST_CODE, c->observe.constants) \
    X(OBSERVED_PAIRS, COST_CODE, c->observe.pairs) \
    X(OBSERVED_CALLS, COST_CODE, c->observe.quotients + cost_calls(&c->observe)) \
    X(OUTPUTS, COST_CODE | COST_DATA, c->im->outputs > 0 ? c->im->outputs : 1) \
    X(ANY_PAIR, COST_CODE | COST_DATA | COST_DEPTH, c->step.pairs + COST_ALL(radians) + c->observe.pairs + c->observe.radians > 0) \
    X(ANY_TURNED, COST_CODE | COST_DATA | COST_DEPTH, c->turned) \
    X(ANY_TURNED_SUMS, COST_CODE | COST_DEPTH, c->turned && c->compensated) \
    X(ANY_RADIANS, COST_CODE | COST_DATA | COST_DEPTH, COST_ALL(radians) + c->observe.radians > 0) \
    X(ANY_QUOTIENT, COST_CODE | COST_DATA | COST_DEPTH, COST_ALL(quotients) + c->observe.quotients > 0) \
    X(ANY_ROOT, COST_CODE | COST_DATA | COST_DEPTH, COST_ALL(roots) + c->observe.roots > 0) \
    X(ANY_POWER, COST_CODE | COST_DATA | COST_DEPTH, c->step.powers + c->observe.powers > 0) \
    X(STATE_WORDS, COST_DATA, c->state_words) \
    X(STARTS, COST_DATA | COST_CODE, 2 * c->im->angles + c->reals + c->im->inputs) \
    X(LIES_STAGES, COST_DEPTH, c->stages * c->components) \
    X(LIES_PAIRS, COST_DEPTH, c->step.pairs) \
    X(LIES_TURNED, COST_DEPTH, c->turned ? c->stages * c->step.pairs : 0) \
    X(LIES_CARRIED, COST_DEPTH, c->step.carried) \
    X(LIES_LEAVES, COST_DEPTH, c->step.leaves + c->placed.leaves) \
    X(LIES_OPERATIONS, COST_DEPTH, c->step.operations) \
    X(SMOOTH, COST_EVENTS, c->smooth) \
    X(EVENT_CONTACTS, COST_EVENTS, c->im->contacts) \
    X(EVENT_COMPONENTS, COST_EVENTS, c->components * c->im->contacts) \
    X(EVENT_PAIRS, COST_EVENTS, c->im->forced * c->im->forced) \
    X(EVENT_OPERATIONS, COST_EVENTS, c->events.operations) \
    X(EVENT_EVALUATIONS, COST_EVENTS, c->evaluations * c->smooth / c->stages) \
    X(EVENT_STOPS, COST_EVENTS, core_stops(c->im) * core_stops(c->im)) \
    X(EVENT_SMOOTH, COST_EVENTS, c->im->contacts * c->smooth)
/* clang-format on */

#define COST_FEATURE_ID(id, taken, count) COST_F_##id,
typedef enum cost_feature { COST_FEATURE_ROWS(COST_FEATURE_ID) COST_FEATURES } cost_feature;
#undef COST_FEATURE_ID

/* Their words, and who takes them. */
extern const char *const cost_feature_words[COST_FEATURES];
extern const unsigned cost_feature_taken[COST_FEATURES];

int cost_calls(const cost_list *l);
void cost_features(const cost_counts *c, double feature[static COST_FEATURES]);

#endif
