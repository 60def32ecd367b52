#include "vector_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

vector_field *vector_field_open(const image *im, const engine_kind *kind) {
    vector_field *f = alloc(1, sizeof *f);
    f->image = im;
    f->n = im->angles + im->reals;
    f->evaluator = evaluator_new(im->list[IMAGE_BOOKS]);
    if (kind == &engine_float) {
        evaluator_wrap(f->evaluator);
    }
    f->value = alloc(im->list[IMAGE_BOOKS]->results, sizeof *f->value);
    f->input = alloc(im->inputs, sizeof *f->input);
    f->base = alloc(im->count, sizeof *f->base);
    f->next = alloc(f->n, sizeof *f->next);
    f->rate = alloc(f->n, sizeof *f->rate);
    image_inputs(im, f->input);
    for (int i = 0; i < f->n; i++) {
        const component c = image_component(im, i);
        const bool top = c.primes + 1 >= im->unknown[c.unknown].order;
        f->next[i] = top ? -1 - c.unknown : image_find_component(im, c.unknown, c.primes + 1);
        if (c.primes == 1 && im->has_energies) {
            f->rate[f->rows++] = i;
        }
    }
    return f;
}

void vector_field_close(vector_field *f) {
    if (f != NULL) {
        evaluator_free(f->evaluator);
        free(f->value);
        free(f->input);
        free(f->base);
        free(f->next);
        free(f->rate);
        free(f);
    }
}

void vector_field_slope(vector_field *f, const double *x, double *slope) {
    const image *im = f->image;
    const double *real = x + im->angles;
    evaluator_run(f->evaluator, 0.0, x, real, real + (im->coordinates - im->angles), f->input,
                  f->value);
    for (int i = 0; i < f->n; i++) {
        slope[i] = f->next[i] >= 0 ? x[f->next[i]] : f->value[-1 - f->next[i]];
    }
}

void vector_field_rounding(vector_field *f, const double *x, double *off) {
    const image *im = f->image;
    double *error = alloc(im->list[IMAGE_BOOKS]->results, sizeof *error);
    evaluator_rounding(f->evaluator, x, 0.0, error);
    for (int i = 0; i < f->n; i++) {
        const int at = -1 - f->next[i];
        off[i] = f->next[i] >= 0 ? 0.0 : 0x1p-53 * error[at] + im->mass_blur * fabs(f->value[at]);
    }
    free(error);
}

/* The momenta are linear in the rates, or nearly so. */
void vector_field_mass(vector_field *f, const double *x, const double *size, double *matrix) {
    const image *im = f->image;
    double *at = alloc(2 * (int64_t)f->n, sizeof *at);
    memcpy(at, x, (size_t)f->n * sizeof *at);
    vector_field_slope(f, at, at + f->n);
    memcpy(f->base, f->value + im->count + BOOK_MOMENTA, (size_t)im->count * sizeof *f->base);
    for (int k = 0; k < f->rows; k++) {
        const int c = f->rate[k];
        const double change = size[c] > 0.0 ? size[c] : 1.0;
        at[c] = x[c] + change;
        vector_field_slope(f, at, at + f->n);
        at[c] = x[c];
        for (int i = 0; i < f->rows; i++) {
            const int unknown = image_component(im, f->rate[i]).unknown;
            const double *momentum = f->value + im->count + BOOK_MOMENTA;
            matrix[i * f->rows + k] = (momentum[unknown] - f->base[unknown]) / change;
        }
    }
    free(at);
}
