/* folded.c: see folded.h. */
#include "folded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

static double *starts_off(const image *im) {
    const int n = im->angles + im->reals;
    double *off = room((1 + (int64_t)im->ways) * n, sizeof *off);
    double *own = off + (ptrdiff_t)im->ways * n;
    image_start(im, own);
    for (int k = 0; k < im->ways; k++) {
        image_start(im->otherwise[k], off + (ptrdiff_t)k * n);
        for (int i = 0; i < n; i++) {
            off[k * n + i] = fabs(off[k * n + i] - own[i]);
        }
    }
    return off;
}

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
    for (int k = 0; k <= im->ways; k++) {
        f->input[k] = room(im->inputs, sizeof **f->input);
        image_inputs(k < im->ways ? im->otherwise[k] : im, f->input[k]);
    }
    f->start = starts_off(im);
    f->value = room((3 + (int64_t)im->ways) * f->results, sizeof *f->value);
    f->beside = f->value + f->results;
    f->size = f->beside + f->results;
    f->off = f->size + f->results;
    return f;
}

void folded_close(folded *f) {
    if (f != NULL) {
        evaluator_free(f->own);
        for (int k = 0; k < f->image->ways; k++) {
            evaluator_free(f->other[k]);
        }
        for (int k = 0; k <= f->image->ways; k++) {
            free(f->input[k]);
        }
        free(f->start);
        free(f->value);
        free(f);
    }
}

static void evaluate(const folded *f, int way, const double *x, double *value) {
    const image *im = f->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const double *real = x + im->angles;
    evaluator_run(way < im->ways ? f->other[way] : f->own, 0.0, x, real, real + linear,
                  f->input[way], value);
}

void folded_look(folded *f, const double *x) {
    evaluate(f, f->image->ways, x, f->value);
    for (int k = 0; k < f->image->ways; k++) {
        evaluate(f, k, x, f->beside);
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

/* What each way is off, off[ways * count], of what the furthest is, each of them by itself: they have no unit in common. */
static void add_shares(const double *off, int ways, int count, double *share) {
    for (int i = 0; i < count; i++) {
        double most = 0.0;
        for (int k = 0; k < ways; k++) {
            most = number_most(most, off[k * count + i]);
        }
        for (int k = 0; k < ways && most > 0.0; k++) {
            share[k] += off[k * count + i] / most;
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
    image_start(im, x);
    add_shares(f->start, im->ways, n, share);
    for (int i = -1; i < n; i++) {
        const double kept = i >= 0 ? x[i] : 0.0;
        if (i >= 0) {
            x[i] = kept + 1.0;
        }
        memset(f->off, 0, (size_t)im->ways * (size_t)f->results * sizeof *f->off);
        folded_look(f, x);
        add_shares(f->off, im->ways, f->results, share);
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
