/* three_rows.h: error and cost of a run at twice its step, at its step and at half of it: a short form of the
 * table of `whirl price`, by the same trials. The reference is a run in double at a quarter of the step. */
#ifndef STUDY_THREE_ROWS_H
#define STUDY_THREE_ROWS_H

#include <stdio.h>

#include "trial.h"

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
    uint64_t steps;          /* of it, which are looked at */
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
/* Look at trial.stopped, then at trial.reliable. At least two steps; three_rows_end() in any case. */
void three_rows_make(three_rows *t, const three_rows_wish *w);
void three_rows_print(FILE *out, const three_rows *t);
void three_rows_end(three_rows *t);

#endif
