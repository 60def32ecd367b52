/* reference_rows.c: see reference_rows.h; host/run/records.c is the same for a run. */
#include "reference_rows.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "long_list.h"

struct long_rows {
    const records *shape;
    long_list *observe;
    double *input;
    long double *output; /* [image->outputs] */
};

long_rows *long_rows_new(const records *shape) {
    const image *im = shape->image;
    long_rows *l = room(1, sizeof *l);
    *l = (long_rows){shape, long_list_new(im->list[IMAGE_OBSERVE]),
                     room(im->inputs, sizeof *l->input), room(im->outputs, sizeof *l->output)};
    image_inputs(im, l->input);
    return l;
}

void long_rows_free(long_rows *l) {
    if (l != NULL) {
        long_list_free(l->observe);
        free(l->input);
        free(l->output);
        free(l);
    }
}

static int column_of(const records *r, component c) {
    int column = 1;
    while (r->column[column].unknown != c.unknown || r->column[column].primes != c.primes) {
        column++;
    }
    return column;
}

void long_rows_read(long_rows *l, const long double *state, long double time_s, long double *row) {
    const records *r = l->shape;
    const image *im = r->image;
    const long double *real = state + im->angles;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
    const long_leaves in = {state, real, real + linear, l->input, time_s};
    long_list_run(l->observe, &in, l->output);
    memset(row, 0, (size_t)r->columns * sizeof *row);
    for (int i = 0; i < im->angles + im->reals; i++) {
        row[column_of(r, image_component(im, i))] = state[i];
    }
    for (int i = 0; i < im->own_outputs; i++) {
        row[r->columns - im->own_outputs + i] = l->output[i];
    }
    for (int k = 0; k < im->recovered; k++) {
        for (int primes = 0; primes < 2; primes++) {
            const component c = {im->from_momentum[k], primes};
            row[column_of(r, c)] = l->output[im->own_outputs + 2 * k + primes];
        }
    }
    for (int i = 1; i < r->columns; i++) {
        const image_unit *u = r->column[i].unit;
        row[i] = row[i] * (long double)u->divisor / (long double)u->scale;
    }
    row[0] = time_s;
}
