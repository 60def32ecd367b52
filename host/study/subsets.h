/* subsets.h: runs of a scene without some of its effects, compared with the run that has all of them.
 *
 * The runs step side by side in double. An effect acts only if leaving it out changes a record. A term must also change
 * a slope by more than round-off. A contact other than friction must also have an event or be closed. */
#ifndef STUDY_SUBSETS_H
#define STUDY_SUBSETS_H

#include "cost.h"
#include "host/io/records.h"
#include "host/lang/model.h"

/* At most SUBSETS_EFFECTS_MAX effects are selected. If more than SUBSETS_ALL_MOST act, not all subsets are run. */
enum { SUBSETS_EFFECTS_MAX = 64, SUBSETS_ALL_MOST = 6 };

/* Costs with the number type float; NAN: unknown. SUBSET_STEP: cycles of a step, or instructions if board->cycles is
 * COST_RANGE. SUBSET_WORST: most evaluations in a step. SUBSET_FLASH and SUBSET_RAM: bytes. */
enum { SUBSET_STEP, SUBSET_WORST, SUBSET_FLASH, SUBSET_RAM, SUBSET_FIGURES };

/* The scene without the effects of the bits in `out`. */
typedef struct subset {
    uint64_t out;
    const char *failed; /* the reason why the run did not reach the end; NULL: it did */
    bool same;          /* its records have the same bits as those of the full run */
    int contacts;
    double *moved; /* [columns] largest difference from the full run, in the column's unit */
    double figure[SUBSET_FIGURES]; /* if contacts > 0, only SUBSET_WORST is valid */
} subset;

typedef struct subsets {
    const mechanism *of;
    const scene *in;
    const overrides *changes;
    const cost_board *board;
    image *image;     /* the full scene */
    records *columns; /* columns of the runs' records */
    int effects;
    int effect[SUBSETS_EFFECTS_MAX]; /* the scene's effects, as indices in of->effects */
    bool acted[SUBSETS_EFFECTS_MAX]; /* the effect acted in the full run */
    double *range;                   /* [columns] range in the full run, in the column's unit */
    double *limit;                   /* [columns] allowed error; INFINITY: no limit */
    subset **list; /* [0]: the full scene; [k + 1]: without effect[k]; others: without several */
    int count;
} subsets;

/* Makes the image of the full scene. Returns false without an image, or with too many effects (reported). Call
 * subsets_close() in any case. */
bool subsets_open(subsets *s, diags *errors);
void subsets_close(subsets *s);
/* Runs the full scene, and for each effect the scene without that effect. Returns false if
 * the full run diverges (reported). */
bool subsets_run(subsets *s, diags *errors);
bool subsets_keeps(const subsets *s, const subset *of);
/* Runs the subsets of the acting effects. If more than SUBSETS_ALL_MOST effects act, runs only some subsets, and sets
 * *greedy to true. If subsets_keeps() is true for several subsets, returns the one with the fewest effects. */
const subset *subsets_smallest(subsets *s, bool *greedy);

#endif
