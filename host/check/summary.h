/* summary.h: the result of a run in words. */
#ifndef CHECK_SUMMARY_H
#define CHECK_SUMMARY_H

#include <stdio.h>

#include "host/check/books.h"
#include "host/check/energy_residual.h"
#include "host/engine/engine.h"
#include "host/io/records.h"

/* === steps ==================================================================================== */

enum { STEP_WORD = 40 };

/* Rounds most_s down to 1, 2 or 5 times a power of ten. Returns at most 5000 s, and 0 below 1e-12 s. */
double step_nice_s(double most_s);
/* Writes the step for --step, as "200us", with a relative error below 1e-14. Returns `text`. */
const char *step_text(double step_s, char text[STEP_WORD]);

/* === about ==================================================================================== */
/* The settings of a run as lines of TOML, for the file next to its records (host/io/plot.h). */

/* Version, scene, step, method, state hash. The caller frees the result. */
char *about_facts(const image *im, const engine_kind *kind, const void *run);
/* Parameters and inputs in SI units. The caller frees the result. */
char *about_tables(const image *im);

/* === the opening sentence ===================================================================== */
/* A summary begins with the constant outputs. If there are none, it begins with the motions. */

typedef struct opening {
    uint64_t each; /* steps between sampled rows */
    double *first; /* [columns of the records] at the start */
    double *low;   /* [columns] least of the sampled values */
    double *high;  /* [columns] largest of the sampled values */
} opening;

opening opening_begin(const records *r, uint64_t steps);
void opening_end(opening *o);
void opening_enter(opening *o, const records *r);
/* Did a coordinate move in the sampled rows? */
bool opening_moves(const opening *o, const records *r);
/* Prints the sentence for a run that ends with the records' current row. `b` may be NULL. */
void opening_print(FILE *out, const opening *o, const records *r, const books *b);

/* Prints the scene, its effects, and the method. */
void summary_head(FILE *out, const image *im, const engine_kind *kind, const void *run);

/* Prints the numbers, without timings, so that equal runs have equal summaries. `b` may be NULL. */
void summary_print(FILE *out, const image *im, const engine_kind *kind, void *run, const books *b,
                   const energy_residual *balance);

#endif
