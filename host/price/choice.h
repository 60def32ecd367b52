/* choice.h: the cheapest setting that keeps an error on a board. */
#ifndef PRICE_CHOICE_H
#define PRICE_CHOICE_H

#include "measured.h"
#include "trial_memo.h"

/* An error is kept when what was measured is no more than this part of what is allowed. */
#define CHOICE_MARGIN 2.0

/* What must be kept, and what a setting may fail by: X(id, word). */
#define CHOICE_LIMIT_ROWS(X) \
    X(CHOICE_ERROR, "error") \
    X(CHOICE_LOAD, "load") \
    X(CHOICE_FLASH, "flash") \
    X(CHOICE_RAM, "RAM")
#define CHOICE_LIMIT_ID(id, word) id,
typedef enum choice_limit { CHOICE_LIMIT_ROWS(CHOICE_LIMIT_ID) CHOICE_LIMITS } choice_limit;
#undef CHOICE_LIMIT_ID
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

typedef struct choice_wish {
    double error;             /* in the unit of the trial's errors */
    double rate_Hz;           /* of calls, each of which takes whole steps; 0: any step will do */
    uint64_t periods;         /* of 1/rate in a record's spacing; 1 without a rate */
    double clock_Hz;          /* 0: not known, and no limit */
    double flash_bytes;       /* 0: no limit */
    double ram_bytes;         /* with the stack; 0: no limit */
    double operations;        /* most that all trials may evaluate */
    measured_prices *counted; /* prices that take the place of predicted ones; NULL: none */
    const char *prices;       /* for people: how they are known; NULL: nothing is said */
    trial_memo *memo;         /* of trials that are asked for again; NULL: all are run */
    void (*progress)(void *context, int done, int of); /* may be NULL */
    void (*counting)(void *context, int counted);      /* likewise */
    void *context;
} choice_wish;

/* A setting at one step. Loads are parts of the period, or of a second where there is no rate: of the longest step. */
typedef struct choice_row {
    setting setting;
    deviation_pace pace;
    uint64_t substeps; /* in a period; 0 without a rate */
    trial_result result;
    cost cost;
    measured_run run; /* of a scene with contacts, once it was counted */
    double
        worst; /* what it is judged by: cycles a second of the longest step, or instructions, the most promised */
    double load;      /* of the clock, by the best one number; 0: not known */
    double load_most; /* and the most promised */
    bool fails[CHOICE_LIMITS];
    bool unknown[CHOICE_LIMITS]; /* a limit is there, and nobody can tell */
} choice_row;

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
