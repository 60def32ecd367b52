/* table_text.h: a table of errors and prices for people and for programs. */
#ifndef PRICE_TABLE_TEXT_H
#define PRICE_TABLE_TEXT_H

#include "price_table.h"

/* What the command was given, as its words are typed, to build lines from that do a row again. */
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

/* The lines that do a row again: `whirl run ...` at a place, and `whirl derive ... --as c` with the scene's own values, as
 * a product has them. Free them. */
char *table_run_line(const trials *t, const setting *s, deviation_pace pace, int point,
                     const table_words *words);
char *table_derive_line(const trials *t, const setting *s, deviation_pace pace,
                        const table_words *words);
/* Counts the same row's step where a source tree and the board's compiler are: `sh mk/price/measure_one.sh ...`. */
char *table_measure_line(const trials *t, const setting *s, deviation_pace pace, int point,
                         const table_words *words);

#endif
