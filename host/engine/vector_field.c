#include "vector_field.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

vector_field *vector_field_open(const image *im, const engine_kind *kind) {
    vector_field *f = alloc(1, sizeof *f);
    f->n = im->angles + im->reals;
    f->list = state_list_open(im, IMAGE_BOOKS);
    if (kind == &engine_float) {
        evaluator_wrap(f->list.evaluator);
    }
    f->next = alloc(f->n, sizeof *f->next);
    for (int i = 0; i < f->n; i++) {
        const component c = image_component(im, i);
        const bool top = c.primes + 1 >= im->unknown[c.unknown].order;
        f->next[i] = top ? -1 - c.unknown : image_find_component(im, c.unknown, c.primes + 1);
    }
    return f;
}

void vector_field_close(vector_field *f) {
    if (f != NULL) {
        state_list_close(&f->list);
        free(f->next);
        free(f);
    }
}

void vector_field_slope(vector_field *f, const double *x, double *slope) {
    const double *value = state_list_at(&f->list, x, x + f->list.image->angles);
    for (int i = 0; i < f->n; i++) {
        slope[i] = f->next[i] >= 0 ? x[f->next[i]] : value[-1 - f->next[i]];
    }
}

void vector_field_rounding(vector_field *f, const double *x, double *off) {
    const image *im = f->list.image;
    double *error = alloc(im->list[IMAGE_BOOKS]->results, sizeof *error);
    evaluator_rounding(f->list.evaluator, x, 0.0, error);
    for (int i = 0; i < f->n; i++) {
        const int at = -1 - f->next[i];
        off[i] =
            f->next[i] >= 0 ? 0.0 : 0x1p-53 * error[at] + im->mass_blur * fabs(f->list.result[at]);
    }
    free(error);
}
