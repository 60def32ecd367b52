/* price_table.h: the table of settings, with error and price, that `whirl price` and `whirl choose` print. */
#ifndef STUDY_PRICE_TABLE_H
#define STUDY_PRICE_TABLE_H

#include <stdio.h>

#include "host/base/json.h"
#include "host/study/trial.h"

/* === the table ================================================================================ */
/* The unit of a price. A row's price is the cost of one simulated second. */
typedef enum table_unit {
    PRICE_CYCLES,
    PRICE_INSTRUCTIONS, /* on boards without counted cycles */
    PRICE_EVALUATIONS   /* if the scene has contacts: evaluations of accelerations in the trial */
} table_unit;
extern const char *const table_unit_words[]; /* "cycles", ... */

typedef struct table_price {
    table_unit unit;
    cost_basis basis;
    double value;
    double least, most;
} table_price;

/* If the scene has contacts, Whirl counts whole runs: one at each point of the trials. */
typedef struct counted_run {
    double steps;              /* number of steps of all counted runs; 0: no run was counted */
    double instructions_bound; /* declared bound for a step (docs/dev/events.md); 0: unknown */
    double cycles_bound;
} counted_run;

typedef struct table_row {
    setting setting;
    deviation_pace pace;
    trial_result result;
    cost cost;
    counted_run run;
    table_price price;
    bool counted;  /* the row's cost was counted, not predicted */
    bool on_front; /* no row with at most this price has a smaller error */
} table_row;

typedef struct table {
    table_row *row; /* [count], sorted by price; rows of equal price, by error */
    int count;
    int settings;    /* number of settings that the scene allows */
    int unpriced;    /* number of settings without a price, which are left out */
    const char *why; /* the reason for one unpriced setting, or "" */
    int broken_off;  /* number of settings whose finer steps would exceed the allowed operations */
    double operations; /* the allowed operations of all trials */
} table;

#define TABLE_MARGIN 2.0 /* a chosen row's error is at most the requested error divided by this */

typedef struct table_request {
    double operations;  /* limit on the operations of all trials */
    const bool *method; /* [WH_METHODS]; NULL: the default ones */
    double error;       /* requested error; 0: no request */
    double rate_Hz;     /* a period of 1/rate_Hz s has a whole number of steps; 0: no request */
    uint64_t periods;   /* number of periods of 1/rate_Hz s between two records; 1 without a rate */
    int workers;
    bool shows; /* progress on standard error */
} table_request;

/* 1, 2, 5, 10, 20, 50, ... for i = 0, 1, 2, ... */
uint64_t table_decade(int i);
/* Sets *pace for trial number `rung`, from 0 on. Each trial has shorter steps than the one before. Returns false if
 * there is no such trial. */
bool table_pace(const table_request *w, int rung, deviation_pace *pace);
/* The number of the row's steps in a period, 1/rate_Hz; 0 without a rate. */
uint64_t table_substeps(const table_request *w, const table_row *row);

/* Tries the settings in several worker processes. Each setting has its own share of the allowed operations, so the rows
 * do not depend on the number of workers. Check t->stopped. */
table *table_new(trials *t, const table_request *w);
void table_free(table *made);
/* Sorts the rows by price, and sets `on_front` of each row. */
void table_sort(table *made);

/* The price of steps of this length. */
table_price table_price_of(const cost *c, double step_s);

/* Returns `text`: a figure's basis in words, such as "predicted: within 8 % in nine of ten counted cases". */
enum { FIGURE_WORDS = 120 };
const char *figure_words(const cost_figure *f, char text[FIGURE_WORDS]);

/* Describes the comparison and its reference, in lines that begin with two blanks. */
void figure_reference(FILE *out, const trials *t);

/* The heading of a column of prices in each table_unit, such as "cycles/s". */
extern const char *const table_heads[];

/* Prints how many settings were tried, how many have no price, and for how many --effort was too small. */
void table_print_left(FILE *out, const table *made);
/* Prints every row if `all`, else at most TABLE_ROWS rows of the front. */
enum { TABLE_ROWS = 12 };
void table_print(FILE *out, const trials *t, const table *made, bool all);
void table_csv(FILE *out, const trials *t, const table *made);
/* Writes one JSON object (schema: docs/warnings.md) with all rows; `made` NULL: no rows. `status`: exit status. */
void table_json(FILE *out, const trials *t, const table *made, int status);
/* table_json_begin() writes the first keys of table_json()'s object, table_json_row() the keys of a row. */
void table_json_begin(json *j, const char *command, const trials *t);
void table_json_row(json *j, const trials *t, const table_row *row);

/* The command `whirl run ...` that repeats a trial at a point of the ranges. The caller frees it. */
char *table_run_line(const trials *t, const setting *s, deviation_pace pace, int point);
/* The command `whirl derive ... --as c` with this setting and step, and the scene's own values. The caller frees it. */
char *table_derive_line(const trials *t, const setting *s, deviation_pace pace);
/* The command `sh mk/price/measure_one.sh ...` that measures a step in Whirl's source tree. The caller frees it. */
char *table_measure_line(const trials *t, const setting *s, deviation_pace pace, int point);

/* === counted prices =========================================================================== */
/* These prices are counted by the command of table_measure_line(), with the board's compiler and emulator. */

typedef enum measured_end {
    MEASURED_COUNTED,
    MEASURED_MISSING /* a tool is missing */
} measured_end;

/* Compiles the files that all counts need. Returns NULL, or why counting is impossible (may point into `text`). */
enum { MEASURED_TEXT = 160 };
const char *measured_missing(const trials *t, const cost_board *board, char text[MEASURED_TEXT]);
/* Counts the cost of the row's step, or of its whole run if the scene has contacts. Enters the cost in all rows to
 * which it applies. Removes these rows if their code cannot be built, linked or run. Sorts the table again. */
measured_end measured_count(const trials *t, table *made, int row);
/* Counts all rows of the front. Does nothing if the scene has contacts. `shows`: progress on standard error. */
measured_end measured_front(const trials *t, table *made, bool shows);

#endif
