/* choice.h: choice of rows of a table (price_table.h) by limits of error, load, flash and RAM. */
#ifndef STUDY_CHOICE_H
#define STUDY_CHOICE_H

#include <stdio.h>

#include "host/study/price_table.h"

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
    double ram_bytes;    /* limit of RAM plus stack; 0: no limit */
    bool counts;         /* the cost of chosen rows will be measured, see choice_counted() */
    const char *prices;  /* the source of the prices, in words */
} choice_request;

/* A row compared with the limits. */
typedef struct choice_row {
    int row;      /* index of the row in the table, or -1 */
    double worst; /* cycles (if known) or instructions of the longest step / step length, 1/s */
    double load;  /* computing time of the longest step / simulated time of a step; 0: unknown */
    double load_most;
    unsigned fails;   /* bits: limits that the row exceeds */
    unsigned unknown; /* bits: limits whose figures are unknown for this row */
} choice_row;

typedef enum choice_kind {
    CHOICE_FASTEST,  /* the fewest cycles within all limits */
    CHOICE_SMALLEST, /* the least flash within all limits */
    /* Used if no row keeps all limits: */
    CHOICE_WEAKER, /* the least error; keeps all other limits */
    CHOICE_DEARER, /* the fewest cycles; keeps the limits of error, flash and RAM */
    CHOICE_LARGER, /* the least flash; keeps the limits of error and load */
    CHOICE_ANY,    /* the fewest cycles; keeps the limit of the error */
    CHOICES
} choice_kind;

typedef struct choice {
    choice_row of[CHOICES];
} choice;

choice choice_make(const trials *t, const table *made, const choice_request *w);

/* Repeats choice_make() and measured_count() until every chosen row is counted. If there are contacts, an uncounted row
 * gets the cost per evaluation of the last counted row with the same number type. */
measured_end choice_counted(trials *t, table *made, const choice_request *w, choice *c);

/* Prints the fastest and the smallest row. If no row is within the limits, prints limits that are high enough. */
void choice_print(FILE *out, const trials *t, const table *made, const choice_request *w,
                  const choice *c);
/* Prints the rows CHOICE_FASTEST and CHOICE_SMALLEST as a JSON object (docs/warnings.md). `status`: exit status. */
void choice_json(FILE *out, const trials *t, const table *made, const choice_request *w,
                 const choice *c, int status);

#endif
