#include "constant_sensitivity.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/engine/engine.h"
#include "host/number/functions.h"

/* Error of each way, off[ways * count], relative to the largest one. Components are scaled separately because their units
 * differ. */
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

static void evaluate(const image *im, image_role role, const double *x, double *value) {
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const double *real = x + im->angles;
    double *input = alloc(im->inputs, sizeof *input);
    evaluator *e = evaluator_new(im->list[role]);
    image_inputs(im, input);
    evaluator_run(e, 0.0, x, real, real + linear, input, value);
    evaluator_free(e);
    free(input);
}

static void look(const image *im, image_role role, const double *x, double *share) {
    const int results = im->list[role] != NULL ? im->list[role]->results : 0;
    double *value = alloc((1 + (int64_t)im->ways) * results, sizeof *value);
    double *off = value + results;
    if (results > 0) {
        evaluate(im, role, x, value);
        for (int k = 0; k < im->ways; k++) {
            evaluate(im->otherwise[k], role, x, off + (ptrdiff_t)k * results);
        }
        for (int i = 0; i < im->ways * results; i++) {
            const double now = fabs(off[i] - value[i % results]);
            off[i] = isfinite(now) ? now : 0.0; /* a pole: reported elsewhere */
        }
    }
    add_shares(off, im->ways, results, share);
    free(value);
}

static void compare_starts(const image *im, double *share) {
    const int n = im->angles + im->reals;
    double *off = alloc((int64_t)im->ways * n, sizeof *off);
    for (int i = 0; i < im->ways * n; i++) {
        off[i] = fabs(image_start(im->otherwise[i / n], i % n) - image_start(im, i % n));
    }
    add_shares(off, im->ways, n, share);
    free(off);
}

/* Evaluates at the start, and with each component one unit further, because other components may be zero there and
 * hide a factor. */
const image *constant_sensitivity_furthest(const image *im) {
    static const image_role roles[] = {IMAGE_STEP, IMAGE_SIGNALS, IMAGE_FORCES, IMAGE_SETS};
    const int n = im->angles + im->reals;
    double share[IMAGE_WAYS] = {0.0};
    if (im->ways == 0) {
        return NULL;
    }
    double *x = alloc(n, sizeof *x);
    compare_starts(im, share);
    for (int at = -1; at < n; at++) {
        for (int i = 0; i < n; i++) {
            x[i] = image_start(im, i) + (i == at ? 1.0 : 0.0);
        }
        for (size_t r = 0; r < sizeof roles / sizeof roles[0]; r++) {
            look(im, roles[r], x, share);
        }
    }
    free(x);
    int furthest = 0;
    for (int k = 1; k < im->ways; k++) {
        furthest = share[k] > share[furthest] ? k : furthest;
    }
    return im->otherwise[furthest];
}
