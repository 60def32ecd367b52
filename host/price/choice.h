/* choice.h: the cheapest setting that keeps an error on a board. */
#ifndef PRICE_CHOICE_H
#define PRICE_CHOICE_H

#include "choice_wish.h"

/* An error is kept when what was measured is no more than this part of what is allowed. */
#define CHOICE_MARGIN 2.0

extern const char *const choice_limit_words[CHOICE_LIMITS];

/* Why a setting was not tried, or not as far as it could be of use: X(id, words, what tries it). Those without a price are
 * apart: choice_reason. */
#define CHOICE_LEFT_ROWS(X) \
    X(CHOICE_LEFT_WHOLE, "even the coarsest step takes too long", \
      "raise --effort, or a shorter --horizon") \
    X(CHOICE_LEFT_FINER, "finer steps take too long", "raise --effort") \
    X(CHOICE_LEFT_FINEST, "the finest step that is ever tried errs by more", "") \
    X(CHOICE_LEFT_UNRUN, "no step of it can be run", "") \
    X(CHOICE_LEFT_LONG, "its run has too many steps to be counted", "a shorter --horizon") \
    X(CHOICE_LEFT_UNBUILT, "it cannot be built, linked or run to its end on the board", "")
#define CHOICE_LEFT_ID(id, words, more) id,
typedef enum choice_left { CHOICE_LEFT_ROWS(CHOICE_LEFT_ID) CHOICE_LEFTS } choice_left;
#undef CHOICE_LEFT_ID

/* Why settings have no price. */
typedef struct choice_reason {
    const char *why;
    int settings;
} choice_reason;
enum { CHOICE_REASONS = 4 };

typedef struct choice {
    bool found;
    choice_row best;
    bool has_second;
    choice_row second; /* the next cheapest setting that keeps everything */
    bool has_coarser;
    choice_row coarser; /* the best setting's next coarser step, which does not */
    /* Where nothing was found, what comes nearest, by what would have to give: */
    bool has_weaker;
    choice_row weaker; /* the least error of all that keep the other limits */
    bool has_dearer;
    choice_row dearer; /* the least load of all that keep the error, flash and RAM */
    bool has_larger;
    choice_row larger; /* the least flash of all that keep the error and the load */
    bool has_any;
    choice_row any; /* the least load of all that keep the error */
    /* Every setting is one of: without a price; left; tried until no step of it could be of use. Nothing fits where all
     * are the last, and nothing was found. */
    int settings;
    int unpriced;
    choice_reason
        reason[CHOICE_REASONS]; /* why, as many as there are; further ones are the last's */
    int left[CHOICE_LEFTS];
    int tried;
    /* Of those tried: settings that fail by this at the coarsest step that keeps the error, or by the error; or that
     * keep flash, RAM or load by no step, so that there was nothing to run. */
    int failed[CHOICE_LIMITS];
    int refused;
} choice;

/* Settings that are not tried, or not to the end: without a price, or left. */
int choice_not_tried(const choice *c);

/* The substeps that are tried: entry `i` from 0 on, rising. */
uint64_t choice_substeps(int i);
enum { CHOICE_SUBSTEPS = 10 + 9 * 5 };

choice choice_make(trials *t, const choice_wish *w); /* look at t->stopped */

/* A rate that the dearer row would keep, a whole part of the wished one, and the row at that rate, checked by a trial: 0
 * where there is none. */
double choice_lower_rate(trials *t, const choice_wish *w, const choice *c, choice_row *row);

#endif
