/* table_text.h: figures, each with how it is known, and a table of errors and prices, for people and for programs. */
#ifndef STUDY_TABLE_TEXT_H
#define STUDY_TABLE_TEXT_H

#include <stdio.h>

#include "host/base/json.h"
#include "host/study/price_table.h"
#include "host/study/trial.h"

/* === three rows =============================================================================== */
/* Error and cost of a run at twice its step, at its step and at half of it, a short form of the table of
 * `whirl price`. The reference is a run in double at a quarter of the step. */

enum { THREE_ROWS = 3 };

typedef struct three_rows_wish {
    const trial_source *source; /* of one point */
    const cost_board *board;
    setting setting;         /* the run's, in the board's number */
    image_settings plain;    /* of the reference's image */
    wh_method method;        /* the reference's, */
    int order;               /* and the order by which its error falls */
    double limit;            /* as of reference_steps */
    whole_ratio step;        /* the run's, s */
    whole_ratio priced_step; /* as of trial_wish */
    uint64_t steps;          /* of the run */
} three_rows_wish;

typedef struct three_rows {
    trials trial;
    setting setting;
    deviation_pace pace[THREE_ROWS];
    trial_result result[THREE_ROWS];
    cost cost[THREE_ROWS];
} three_rows;

/* Operations that the rows evaluate, about. */
double three_rows_operations(const three_rows_wish *w, const image *im);
/* Check trial.stopped, then trial.reliable. At least two steps; three_rows_end() in any case. */
void three_rows_make(three_rows *t, const three_rows_wish *w);
void three_rows_print(FILE *out, const three_rows *t);
void three_rows_end(three_rows *t);

enum { FIGURE_TEXT = 64 };

/* "1234 p": a letter for the basis, "-" if unknown. Returns text. */
const char *figure_text(const cost_figure *f, char text[FIGURE_TEXT]);
/* The letter of a basis. */
char figure_letter(cost_basis basis);
/* Explains the letters in `cost`, a line each: "p predicted: from the image, within a bound". */
void figure_legend(FILE *out, const cost *c);
/* "predicted, of simulated figures, within 8 %". Returns text. */
enum { FIGURE_WORDS = 120 };
const char *figure_words(const cost_figure *f, char text[FIGURE_WORDS]);

/* Describes the comparison and its reference, in lines that begin with two blanks. */
void figure_reference(FILE *out, const trials *t);

/* The command's words as typed, for command lines that repeat a row. */
typedef struct table_words {
    const char *target;
    const char *changes; /* "" or " --set m=3 ..." */
    bool all;            /* every row */
    double operations;   /* of --effort */
} table_words;

/* "cycles/s", ...: heads of a column of prices, by table_unit. */
extern const char *const table_heads[];

/* How many settings were tried, and why others were not, or not to the end. */
void table_print_left(FILE *out, const table *made, double operations);
/* At most TABLE_ROWS rows of the front, or every row. */
enum { TABLE_ROWS = 12 };
void table_print(FILE *out, const trials *t, const table *made, const table_words *words);
void table_csv(FILE *out, const trials *t, const table *made, const table_words *words);
/* One JSON object (docs/warnings.md has the schema) with every row, or without a table; `status`: exit status. */
void table_json(FILE *out, const trials *t, const table *made, const table_words *words,
                int status);
/* The keys with which it begins, and those of a row. */
void table_json_begin(json *j, const char *command, const trials *t);
void table_json_row(json *j, const trials *t, const table_row *row, const table_words *words);

/* The lines that do a row again: `whirl run ...` at a place, and `whirl derive ... --as c` with the scene's own values, as
 * a product has them. Free them. */
char *table_run_line(const trials *t, const setting *s, deviation_pace pace, int point,
                     const table_words *words);
char *table_derive_line(const trials *t, const setting *s, deviation_pace pace,
                        const table_words *words);
/* The command that counts this row's step in a source tree with the board's compiler: `sh mk/price/measure_one.sh
 * ...`. */
char *table_measure_line(const trials *t, const setting *s, deviation_pace pace, int point,
                         const table_words *words);

#endif
