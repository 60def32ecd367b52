/* folded.c: see folded.h. */
#include "folded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

folded *folded_open(const image *im, const engine_kind *kind) {
    if (im->ways == 0) {
        return NULL;
    }
    const tape *list = im->list[IMAGE_STEP];
    folded *f = room(1, sizeof *f);
    f->image = im;
    f->results = list->results;
    f->own = evaluator_new(list);
    for (int k = 0; k < im->ways; k++) {
        f->other[k] = evaluator_new(im->otherwise[k]->list[IMAGE_STEP]);
    }
    if (kind == &engine_float) {
        evaluator_wrap(f->own);
        for (int k = 0; k < im->ways; k++) {
            evaluator_wrap(f->other[k]);
        }
    }
    f->input = room(im->inputs, sizeof *f->input);
    f->value = room((3 + (int64_t)im->ways) * f->results, sizeof *f->value);
    f->beside = f->value + f->results;
    f->size = f->beside + f->results;
    f->off = f->size + f->results;
    image_inputs(im, f->input);
    return f;
}

void folded_close(folded *f) {
    if (f != NULL) {
        evaluator_free(f->own);
        for (int k = 0; k < f->image->ways; k++) {
            evaluator_free(f->other[k]);
        }
        free(f->input);
        free(f->value);
        free(f);
    }
}

static void evaluate(const folded *f, evaluator *list, const double *x, double *value) {
    const image *im = f->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const double *real = x + im->angles;
    evaluator_run(list, 0.0, x, real, real + linear, f->input, value);
}

void folded_look(folded *f, const double *x) {
    evaluate(f, f->own, x, f->value);
    for (int k = 0; k < f->image->ways; k++) {
        evaluate(f, f->other[k], x, f->beside);
        for (int i = 0; i < f->results; i++) {
            double *off = &f->off[k * f->results + i];
            const double now = fabs(f->beside[i] - f->value[i]);
            *off = isfinite(now) ? number_most(*off, now) : *off; /* a pole: told elsewhere */
        }
    }
    for (int i = 0; i < f->results; i++) {
        const double size = fabs(f->value[i]);
        f->size[i] = isfinite(size) ? number_most(f->size[i], size) : f->size[i];
    }
}

/* --- the furthest ------------------------------------------------------------------------------------*/

/* What each way is off at all that was looked at, of what the furthest is, in each result by itself: they have no unit in
 * common. */
static void add_shares(const folded *f, double *share) {
    for (int i = 0; i < f->results; i++) {
        double most = 0.0;
        for (int k = 0; k < f->image->ways; k++) {
            most = number_most(most, f->off[k * f->results + i]);
        }
        for (int k = 0; k < f->image->ways && most > 0.0; k++) {
            share[k] += f->off[k * f->results + i] / most;
        }
    }
}

/* At the start, and with each component a unit further: what stands with it shows itself where others are zero. */
const image *folded_furthest(const image *im) {
    folded *f = folded_open(im, &engine_double);
    if (f == NULL) {
        return NULL;
    }
    const int n = im->angles + im->reals;
    double share[IMAGE_WAYS] = {0.0};
    double *x = room(n, sizeof *x);
    for (int i = 0; i < n; i++) {
        x[i] = i < im->angles ? im->start_rad[i] : im->start_real[i - im->angles];
    }
    for (int i = -1; i < n; i++) {
        const double kept = i >= 0 ? x[i] : 0.0;
        if (i >= 0) {
            x[i] = kept + 1.0;
        }
        memset(f->off, 0, (size_t)im->ways * (size_t)f->results * sizeof *f->off);
        folded_look(f, x);
        add_shares(f, share);
        if (i >= 0) {
            x[i] = kept;
        }
    }
    int furthest = 0;
    for (int k = 1; k < im->ways; k++) {
        furthest = share[k] > share[furthest] ? k : furthest;
    }
    free(x);
    folded_close(f);
    return im->otherwise[furthest];
}
