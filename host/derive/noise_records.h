/* noise_records.h: noise on what is recorded: on outputs, and on measures that name an output as it is recorded. */
#ifndef DERIVE_NOISE_RECORDS_H
#define DERIVE_NOISE_RECORDS_H

#include "conserve.h"
#include "host/derive/lower.h"

/* Add the noises that take part to those results that are outputs of the mechanism itself; a sweep's
 * measures, which stand in their place, are none. result[mechanism->output_count]. */
void noise_on_outputs(const equations *e, lowering *l, int *result);

/* Outputs as they are recorded (SYM_RECORD), which measures are made of. */
typedef struct noise_records {
    const poly **exact; /* [noise_count] the output without noise; NULL where no measure names it */
    int *node;          /* [noise_count] the operation that gives it with all its noise */
    int count;          /* of exact that are not NULL */
} noise_records;

/* Replace in wanted [count], folded and settled, the records that no noise takes part in by their outputs, and find the others. Free
 * with noise_records_free(). */
noise_records noise_records_find(const equations *e, const conservation *conserved,
                                 const poly **wanted, int count);
/* Enter them: before the polys that name them are lowered. */
void noise_records_lower(const equations *e, lowering *l, noise_records *r);
/* The operation of this record. */
int noise_record_node(const equations *e, const int *node, const symbol *record);
void noise_records_free(noise_records *r);

#endif
