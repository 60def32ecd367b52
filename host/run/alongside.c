/* alongside.c: see alongside.h. */
#include "alongside.h"

#include <math.h>
#include <stdlib.h>

#include "again.h"
#include "host/base/room.h"
#include "host/number/functions.h"

/* The way's parts of a step; what may be spent, and what a step takes: its own stages at most, and the way's. */
#define PARTS 4
#define OPERATIONS_MOST 1e8
#define EVALUATIONS 24.0

/* Angles may be given within a turn. */
static double apart(const image *im, int i, double a, double b) {
    const double by = a - b;
    return fabs(i < im->angles ? number_centred(by, 6.283185307179586) : by);
}

bool alongside_agrees(const image *im, const engine_kind *kind, const watch *w, double part) {
    const int n = w->field->n;
    const double each = EVALUATIONS * (im->list[IMAGE_STEP]->count + AGAIN_BESIDE);
    bool agrees = (double)w->steps * each <= OPERATIONS_MOST;
    double *is = room(2 * (int64_t)n, sizeof *is);
    double *way = is + n;
    void *run = kind->start(im);
    kind->state(run, way, way + im->angles);
    for (uint64_t k = 0; k < w->steps && agrees; k++) {
        agrees = kind->step(run) == WH_OK;
        kind->state(run, is, is + im->angles);
        field_go(w->field, w->step_s, PARTS, way);
        for (int i = 0; i < n; i++) { /* what is no number agrees with nothing */
            agrees = agrees && apart(im, i, is[i], way[i]) <= part * (w->high[i] - w->low[i]);
        }
    }
    kind->stop(run);
    free(is);
    return agrees;
}
