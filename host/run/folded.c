/* folded.c: see folded.h. */
#include "folded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

static double *starts_off(const image *im) {
    const int n = im->angles + im->reals;
    double *off = room((int64_t)im->ways * n, sizeof *off);
    for (int k = 0; k < im->ways; k++) {
        for (int i = 0; i < n; i++) {
            off[k * n + i] = fabs(image_start(im->otherwise[k], i) - image_start(im, i));
        }
    }
    return off;
}

static folded_list list_open(const image *im, image_role role, bool in_float) {
    folded_list l = {.results = im->list[role] != NULL ? im->list[role]->results : 0};
    for (int k = 0; k <= im->ways && l.results > 0; k++) {
        const image *of = k < im->ways ? im->otherwise[k] : im;
        l.list[k] = evaluator_new(of->list[role]);
        if (in_float) {
            evaluator_wrap(l.list[k]);
        }
    }
    l.value = room((3 + (int64_t)im->ways) * l.results, sizeof *l.value);
    l.beside = l.value + l.results;
    l.size = l.beside + l.results;
    l.off = l.size + l.results;
    return l;
}

static void list_close(folded_list *l, int ways) {
    for (int k = 0; k <= ways && l->results > 0; k++) {
        evaluator_free(l->list[k]);
    }
    free(l->value);
}

static const image_role contact_roles[FOLDED_CONTACTS] = {IMAGE_SIGNALS, IMAGE_FORCES, IMAGE_SETS};

folded *folded_open(const image *im, const engine_kind *kind) {
    if (im->ways == 0) {
        return NULL;
    }
    const bool in_float = kind == &engine_float;
    folded *f = room(1, sizeof *f);
    f->image = im;
    f->step = list_open(im, IMAGE_STEP, in_float);
    for (int c = 0; c < FOLDED_CONTACTS; c++) {
        f->contact[c] = list_open(im, contact_roles[c], in_float);
    }
    for (int k = 0; k <= im->ways; k++) {
        f->input[k] = room(im->inputs, sizeof **f->input);
        image_inputs(k < im->ways ? im->otherwise[k] : im, f->input[k]);
    }
    f->start = starts_off(im);
    return f;
}

void folded_close(folded *f) {
    if (f != NULL) {
        list_close(&f->step, f->image->ways);
        for (int c = 0; c < FOLDED_CONTACTS; c++) {
            list_close(&f->contact[c], f->image->ways);
        }
        for (int k = 0; k <= f->image->ways; k++) {
            free(f->input[k]);
        }
        free(f->start);
        free(f);
    }
}

static void evaluate(const folded *f, const folded_list *l, int way, const double *x,
                     double *value) {
    const image *im = f->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const double *real = x + im->angles;
    evaluator_run(l->list[way], 0.0, x, real, real + linear, f->input[way], value);
}

static void look(const folded *f, const folded_list *l, const double *x) {
    if (l->results == 0) {
        return;
    }
    evaluate(f, l, f->image->ways, x, l->value);
    for (int k = 0; k < f->image->ways; k++) {
        evaluate(f, l, k, x, l->beside);
        for (int i = 0; i < l->results; i++) {
            double *off = &l->off[k * l->results + i];
            const double now = fabs(l->beside[i] - l->value[i]);
            *off = isfinite(now) ? number_most(*off, now) : *off; /* a pole: told elsewhere */
        }
    }
    for (int i = 0; i < l->results; i++) {
        const double size = fabs(l->value[i]);
        l->size[i] = isfinite(size) ? number_most(l->size[i], size) : l->size[i];
    }
}

void folded_look(folded *f, const double *x) {
    look(f, &f->step, x);
    for (int c = 0; c < FOLDED_CONTACTS; c++) {
        look(f, &f->contact[c], x);
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

static void clear(const folded_list *l, int ways) {
    memset(l->off, 0, (size_t)ways * (size_t)l->results * sizeof *l->off);
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
        x[i] = image_start(im, i);
    }
    add_shares(f->start, im->ways, n, share);
    for (int i = -1; i < n; i++) {
        const double kept = i >= 0 ? x[i] : 0.0;
        if (i >= 0) {
            x[i] = kept + 1.0;
        }
        clear(&f->step, im->ways);
        for (int c = 0; c < FOLDED_CONTACTS; c++) {
            clear(&f->contact[c], im->ways);
        }
        folded_look(f, x);
        add_shares(f->step.off, im->ways, f->step.results, share);
        for (int c = 0; c < FOLDED_CONTACTS; c++) {
            add_shares(f->contact[c].off, im->ways, f->contact[c].results, share);
        }
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
