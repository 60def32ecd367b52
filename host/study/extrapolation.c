#include "extrapolation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "long_list.h"

struct extrapolation {
    const image *image;
    extrapolation_setting how;
    long_list *list;
    evaluator *rough; /* bounds the round-off of a zero */
    double *input;    /* [inputs] */
    int count;        /* components */
    long double *state;
    long double *lost;  /* round-off of the sums of steps (Kahan) */
    long double *slope; /* at the state */
    long double *largest;
    long double *row[2]; /* [columns][count]: two rows of the tableau */
    long double *before, *here, *work;
    double *rounding;   /* [results] of the list */
    long double step_s; /* to try next; 0: not chosen yet */
    double operations;
    double most_operations;
};

static long double *numbers(int count) { return alloc(count, sizeof(long double)); }

static void slope_at(extrapolation *e, const long double *state, long double *slope) {
    const image *im = e->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const long double *rate = state + im->angles + linear;
    const long_leaves in = {state, state + im->angles, rate, e->input, 0.0L};
    e->operations += im->list[IMAGE_STEP]->count;
    if (im->form == WH_SECOND_ORDER) {
        memcpy(slope, rate, (size_t)im->coordinates * sizeof *slope);
        long_list_run(e->list, &in, slope + im->coordinates);
    } else {
        long_list_run(e->list, &in, slope);
    }
}

extrapolation *extrapolation_new(const image *im, extrapolation_setting how, double operations) {
    extrapolation *e = alloc(1, sizeof *e);
    const int count = im->angles + im->reals;
    *e = (extrapolation){.image = im,
                         .how = how,
                         .list = long_list_new(im->list[IMAGE_STEP]),
                         .rough = evaluator_new(im->list[IMAGE_STEP]),
                         .input = alloc(im->inputs, sizeof *e->input),
                         .count = count,
                         .state = numbers(count),
                         .lost = numbers(count),
                         .slope = numbers(count),
                         .largest = numbers(count),
                         .row = {numbers(count * how.columns), numbers(count * how.columns)},
                         .before = numbers(count),
                         .here = numbers(count),
                         .work = numbers(count),
                         .rounding = alloc(im->list[IMAGE_STEP]->results, sizeof *e->rounding),
                         .most_operations = operations};
    image_inputs(im, e->input);
    for (int i = 0; i < count; i++) {
        e->state[i] = (long double)image_start(im, i);
        e->largest[i] = long_size(e->state[i]);
    }
    return e;
}

void extrapolation_free(extrapolation *e) {
    if (e == NULL) {
        return;
    }
    long_list_free(e->list);
    evaluator_free(e->rough);
    free(e->input);
    free(e->state);
    free(e->lost);
    free(e->slope);
    free(e->largest);
    free(e->row[0]);
    free(e->row[1]);
    free(e->before);
    free(e->here);
    free(e->work);
    free(e->rounding);
    free(e);
}

const long double *extrapolation_state(const extrapolation *e) { return e->state; }
double extrapolation_operations(const extrapolation *e) { return e->operations; }

/* The scale of a step's error: the largest value so far, or the round-off of the list's own operations within the
 * step. The latter matters for a component that should stay at zero. */
static void scale_of(extrapolation *e, long double span_s, long double *scale) {
    const image *im = e->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    double value[2 * IMAGE_COMPONENTS_MAX];
    double slope[2 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < e->count; i++) {
        value[i] = (double)e->state[i];
    }
    evaluator_run(e->rough, 0.0, value, value + im->angles, value + im->angles + linear, e->input,
                  slope);
    evaluator_rounding(e->rough, value, 0.0, e->rounding);
    const int first = im->form == WH_SECOND_ORDER ? im->coordinates : 0;
    for (int i = 0; i < e->count; i++) {
        scale[i] = e->largest[i];
        if (i >= first && isfinite(e->rounding[i - first])) {
            const long double rounded = span_s * (long double)e->rounding[i - first];
            scale[i] = rounded > scale[i] ? rounded : scale[i];
        }
    }
    for (int i = 0; i < first; i++) { /* a coordinate moves as its rate */
        const long double moved = span_s * scale[first + i];
        scale[i] = moved > scale[i] ? moved : scale[i];
    }
}

/* The increment of the state by the modified midpoint rule with this many substeps. Increments are summed and
 * extrapolated instead of states, so that a short step has little round-off. False if a value is not finite. */
static bool midpoint(extrapolation *e, long double span_s, int substeps, long double *result) {
    const long double h = span_s / (long double)substeps;
    long double *here = result; /* moves: after k substeps, and before that */
    for (int i = 0; i < e->count; i++) {
        e->before[i] = 0.0L;
        here[i] = h * e->slope[i];
    }
    for (int k = 1; k < substeps; k++) {
        for (int i = 0; i < e->count; i++) {
            e->here[i] = e->state[i] + here[i];
        }
        slope_at(e, e->here, e->work);
        for (int i = 0; i < e->count; i++) {
            const long double next = e->before[i] + 2.0L * h * e->work[i];
            e->before[i] = here[i];
            here[i] = next;
        }
    }
    bool finite = true;
    for (int i = 0; i < e->count; i++) {
        finite = finite && isfinite(here[i]);
    }
    return finite;
}

/* The increment of a step by the last column; *error is the difference of the last two, as a part of the tolerance.
 * Infinite if a value is not finite: the increment is then invalid. */
static const long double *try_step(extrapolation *e, long double span_s, double *error) {
    long double scale[2 * IMAGE_COMPONENTS_MAX] = {0};
    const int n = e->count;
    const int columns = e->how.columns;
    scale_of(e, span_s, scale);
    long double *above = e->row[0];
    long double *row = e->row[1];
    for (int j = 0; j < columns; j++) {
        if (!midpoint(e, span_s, 2 * (j + 1), row)) {
            *error = (double)INFINITY;
            return row;
        }
        for (int k = 1; k <= j; k++) {
            const long double ratio = (long double)(j + 1) / (long double)(j + 1 - k);
            for (int i = 0; i < n; i++) {
                const long double better = row[(k - 1) * n + i];
                row[k * n + i] =
                    better + (better - above[(k - 1) * n + i]) / (ratio * ratio - 1.0L);
            }
        }
        long double *swap = above;
        above = row;
        row = swap;
    }
    *error = 0.0;
    const long double *made = above + (size_t)(columns - 1) * (size_t)n;
    const long double *other = above + (size_t)(columns - 2) * (size_t)n;
    for (int i = 0; i < n; i++) {
        const long double size = long_size(e->state[i] + made[i]);
        const long double allowed = size > scale[i] ? size : scale[i];
        const long double off = long_size(made[i] - other[i]);
        if (!isfinite(off)) {
            *error = (double)INFINITY;
        } else if (off > 0.0L) {
            *error = number_most(*error, (double)(off / allowed) / e->how.tolerance);
        }
    }
    return made;
}

/* Kahan's sum: the next step adds back the round-off of the last. */
static void take(extrapolation *e, const long double *made) {
    for (int i = 0; i < e->count; i++) {
        const long double move = made[i] - e->lost[i];
        const long double moved = e->state[i] + move;
        e->lost[i] = (moved - e->state[i]) - move;
        e->state[i] = moved;
        const long double size = long_size(moved);
        e->largest[i] = size > e->largest[i] ? size : e->largest[i];
    }
}

/* How much longer a step may be than one with this error: it grows with the power 2 columns - 1 of the step. */
static long double longer(const extrapolation *e, double error) {
    if (!(error > 0.0)) {
        return 3.0L;
    }
    if (!isfinite(error)) {
        return 0.2L;
    }
    const double factor = 0.9 * number_power(error, -1.0 / (2.0 * e->how.columns - 1.0));
    return (long double)number_least(number_most(factor, 0.2), 3.0);
}

extrapolation_status extrapolation_go(extrapolation *e, long double span_s) {
    long double left_s = span_s;
    if (!(e->step_s > 0.0L)) {
        e->step_s = span_s;
    }
    while (left_s > 0.0L) {
        const bool last = e->step_s >= left_s;
        const long double step_s = last                         ? left_s
                                   : 2.0L * e->step_s >= left_s ? 0.5L * left_s
                                                                : e->step_s;
        slope_at(e, e->state, e->slope);
        double error;
        const long double *made = try_step(e, step_s, &error);
        if (e->operations > e->most_operations) {
            return EXTRAPOLATION_LONG;
        }
        const long double next_s = step_s * longer(e, error);
        if (error <= 1.0) {
            take(e, made);
            left_s = last ? 0.0L : left_s - step_s;
            e->step_s = !last || next_s > e->step_s ? next_s : e->step_s;
        } else {
            e->step_s = next_s < 0.7L * step_s ? next_s : 0.7L * step_s;
        }
        if (!(e->step_s > 1e-9L * span_s)) {
            return EXTRAPOLATION_SMALL;
        }
    }
    return EXTRAPOLATION_OK;
}
