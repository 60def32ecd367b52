/* noise_records.h: noise on recorded quantities: on outputs, and on measures of recorded outputs. */
#ifndef DERIVE_NOISE_RECORDS_H
#define DERIVE_NOISE_RECORDS_H

#include "conserve.h"
#include "host/derive/lower.h"

/* Add the active noises to those results that are outputs of the mechanism itself. A sweep's measures in their place
 * get no noise. result[mechanism->output_count]. */
void noise_on_outputs(const equations *e, lowering *l, int *result);

/* Recorded outputs (SYM_RECORD), the inputs of measures. */
typedef struct noise_records {
    const poly **exact; /* [noise_count] the output without noise; NULL if no measure names it */
    int *node;          /* [noise_count] the operation of the output with all its noise */
    int count;          /* number of exact that are not NULL */
} noise_records;

/* In wanted [count], folded and settled: replace records without active noise by their outputs, and find the others.
 * Free with noise_records_free(). */
noise_records noise_records_find(const equations *e, const conservation *conserved,
                                 const poly **wanted, int count);
/* Enter them before lowering the polys that contain them. */
void noise_records_lower(const equations *e, lowering *l, noise_records *r);
/* The operation of this record. */
int noise_record_node(const equations *e, const int *node, const symbol *record);
void noise_records_free(noise_records *r);

#endif
