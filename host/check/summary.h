/* summary.h: what a run came to, in words. */
#ifndef CHECK_SUMMARY_H
#define CHECK_SUMMARY_H

#include <stdio.h>

#include "host/check/books.h"
#include "host/check/energy_residual.h"
#include "host/engine/engine.h"
#include "host/io/records.h"

/* === a step as --step takes it ================================================================ */

enum { STEP_WORD = 40 };

/* The largest of 1, 2 and 5 times powers of ten, s, from 1000 s down, that is not beyond it; 0: none. */
double step_nice_s(double most_s);
/* "200us", in as many digits as it takes to be read back as it is; returns `text`. */
const char *step_text(double step_s, char text[STEP_WORD]);

/* === about ==================================================================================== */
/* What a run was, as lines of TOML for the file beside its records (host/io/plot_run.h). */

/* Version, scene, step, method, state hash. Free it. */
char *about_facts(const image *im, const engine_kind *kind, const void *run);
/* Parameters and inputs, SI. Free it. */
char *about_tables(const image *im);

/* === the opening sentence ===================================================================== */
/* The sentence that a run's summary opens with: the outputs that stay, or a momentum that stays and from where
 * to where outputs and coordinates move. */

typedef struct opening {
    uint64_t each; /* steps between rows that are looked at */
    double *first; /* [columns] of the records: at the start, */
    double *low;   /* the least and the most of the rows */
    double *high;
} opening;

opening opening_begin(const records *r, uint64_t steps);
void opening_end(opening *o);
/* The row that the records hold. */
void opening_enter(opening *o, const records *r);
/* Does a coordinate move, of a run that ended? */
bool opening_moves(const opening *o, const records *r);
/* The sentence, of a run that ends with the row that the records hold. `b` may be NULL. */
void opening_print(FILE *out, const opening *o, const records *r, const books *b);

/* The scene, its effects, how it was integrated. */
void summary_head(FILE *out, const image *im, const engine_kind *kind, const void *run);

/* The numbers. `books` may be NULL; `balance` is theirs. The same run has the same summary: nothing in it is timed. */
void summary_print(FILE *out, const image *im, const engine_kind *kind, void *run, const books *b,
                   const energy_residual *balance);

#endif
