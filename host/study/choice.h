/* choice.h: the rows of a table (price_table.h) with the fewest cycles and with the least flash, within an error and limits. */
#ifndef STUDY_CHOICE_H
#define STUDY_CHOICE_H

#include <stdio.h>

#include "host/study/price_table.h"

/* The limits that a row must keep. */
typedef enum choice_limit {
    CHOICE_ERROR,
    CHOICE_LOAD,
    CHOICE_FLASH,
    CHOICE_RAM,
    CHOICE_LIMITS
} choice_limit;
#define CHOICE_BIT(limit) (1U << (unsigned)(limit))

typedef struct choice_request {
    table_request table; /* has the allowed error, in trial_unit(), and the rate of calls */
    double clock_Hz;     /* 0: not known, and no limit */
    double flash_bytes;  /* 0: no limit */
    double ram_bytes;    /* limit of the RAM with the stack; 0: no limit */
    bool counts; /* chosen rows will be counted, so a prediction may exceed a limit by its error */
    const char *prices; /* the source of the prices, in words */
} choice_request;

/* A row compared with the limits. The load is the part of a period that its steps take if each takes as long as the longest
 * step. Without a rate the period is a second. */
typedef struct choice_row {
    int row; /* index of the row in the table, or -1 */
    /* upper bound on cycles (or instructions) per simulated second, if every step is as long as the longest */
    double worst;
    double load; /* 0: unknown */
    double load_most;
    unsigned fails;   /* bits: limits that it does not keep */
    unsigned unknown; /* bits: limits without a figure to compare */
} choice_row;

typedef enum choice_kind {
    CHOICE_FASTEST,  /* the fewest cycles within all limits */
    CHOICE_SMALLEST, /* the least flash within all limits */
    /* If no row fits, the candidates for relaxing a limit: */
    CHOICE_WEAKER, /* the least error within the other limits */
    CHOICE_DEARER, /* the fewest cycles within error, flash and RAM */
    CHOICE_LARGER, /* the least flash within error and load */
    CHOICE_ANY,    /* the fewest cycles within the error */
    CHOICES
} choice_kind;

typedef struct choice {
    choice_row of[CHOICES];
} choice;

choice choice_make(const trials *t, const table *made, const choice_request *w);

/* Does the same as choice_make(), but counts rows until no row of the choice is a prediction. With contacts, a row that was not counted
 * is expected to take as many cycles per evaluation as the last counted row with the same number type. */
measured_end choice_counted(trials *t, table *made, const choice_request *w, choice *c);

/* Prints the fastest and the smallest row. If no row is within the limits, prints limits that a row would keep. */
void choice_print(FILE *out, const trials *t, const table *made, const choice_request *w,
                  const choice *c);
/* Prints the rows as one JSON object (docs/warnings.md has the schema), without limits that a row would keep; `status`:
 * exit status. */
void choice_json(FILE *out, const trials *t, const table *made, const choice_request *w,
                 const choice *c, int status);

#endif
