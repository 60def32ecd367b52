/* choice_wish.h: what is asked of a choice, and a setting that is judged by it. */
#ifndef PRICE_CHOICE_WISH_H
#define PRICE_CHOICE_WISH_H

#include "measured.h"
#include "trial_memo.h"

/* What must be kept, and what a setting may fail by: X(id, word). */
#define CHOICE_LIMIT_ROWS(X) \
    X(CHOICE_ERROR, "error") \
    X(CHOICE_LOAD, "load") \
    X(CHOICE_FLASH, "flash") \
    X(CHOICE_RAM, "RAM")
#define CHOICE_LIMIT_ID(id, word) id,
typedef enum choice_limit { CHOICE_LIMIT_ROWS(CHOICE_LIMIT_ID) CHOICE_LIMITS } choice_limit;
#undef CHOICE_LIMIT_ID

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

#endif
