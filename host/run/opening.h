/* opening.h: the sentence that a run's summary opens with: the outputs that stay, or a momentum that stays and from where
 * to where outputs and coordinates move. */
#ifndef RUN_OPENING_H
#define RUN_OPENING_H

#include "books.h"
#include "records.h"

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

#endif
