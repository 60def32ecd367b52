#include "table_check.h"
#include "test.h"

#include "core/step/table.h"
#include "host/base/alloc.h"
#include "host/engine/engine.h"

#define RAD_PER_PHASE (6.283185307179586477 / 4294967296.0)
#define ROUNDS 0x1p-24 /* relative error of one rounding to float */

static uint32_t scatter(uint32_t x) {
    x = (x ^ (x >> 16)) * UINT32_C(0x7feb352d);
    x = (x ^ (x >> 15)) * UINT32_C(0x846ca68b);
    return x ^ (x >> 16);
}

/* The cells in float, scaled in the same way as in generated code. */
static float *cells_of(const op_list_tables *t) {
    const int numbers = t->count * t->terms << t->bits;
    float *cells = alloc(numbers, sizeof *cells);
    for (int i = 0; i < numbers; i++) {
        const float x = (float)t->number[i];
        const float scaled[4] = {x, WH_TABLE_B(x), WH_TABLE_C(x), WH_TABLE_D(x)};
        cells[i] = scaled[i % t->terms];
    }
    return cells;
}

/* Bound on the error of function k: the table's own error, and the round-off of value, addend and sum. */
static double bound_of(const op_list_tables *t, int k) {
    double away = 0.0;
    for (int i = 0; i < 1 << t->bits; i++) {
        const double *number = &t->number[(i * t->count + k) * t->terms];
        double most = 0.0;
        for (int c = 1; c < t->terms; c++) {
            most += fabs(number[c]) / (1 << c);
        }
        away = fmax(away, most);
    }
    /* 2 % more: the largest error may lie between the phases that the image sampled */
    return 1.02 * t->off[k] + ROUNDS * (2.0 * t->size[k] + 6.0 * away) + 1e-14 * t->size[k];
}

static const op *cell_of(const op_list *t) {
    int i = 0;
    while (t->ops[i].code != OP_CELL) {
        i++;
    }
    return &t->ops[i];
}

uint64_t table_check(const image *const *im, int images, uint64_t stride,
                     table_error (*error)[TABLE_CHECK_MOST]) {
    const op_list *first = im[0]->list[IMAGE_STEP];
    const int *turns = cell_of(first)->turns;
    double angle_rad[IMAGE_COMPONENTS_MAX] = {0};
    double exact[TABLE_CHECK_MOST];
    float **cells = alloc(images, sizeof *cells);
    evaluator *ev = evaluator_new(im[0]->list[IMAGE_TABLES]);
    uint64_t phases = 0;
    int angle = 0;
    while (turns[angle] == 0) {
        angle++;
    }
    for (int m = 0; m < images; m++) {
        const op_list_tables *t = &im[m]->list[IMAGE_STEP]->tables;
        cells[m] = cells_of(t);
        for (int k = 0; k < t->count; k++) {
            error[m][k] = (table_error){.bound = bound_of(t, k)};
        }
    }
    for (uint64_t at = 0; at < UINT64_C(1) << 32; at += stride, phases++) {
        const uint32_t phase = (uint32_t)(at + scatter((uint32_t)at) % stride);
        /* from -1/2 to 1/2 turn, where a double is most accurate */
        angle_rad[angle] = (int32_t)phase * RAD_PER_PHASE / turns[angle];
        evaluator_run(ev, 0.0, angle_rad, NULL, NULL, NULL, exact);
        for (int m = 0; m < images; m++) {
            const op_list_tables *t = &im[m]->list[IMAGE_STEP]->tables;
            float y;
            const float *row = wh_table_cell(cells[m], (unsigned)t->bits,
                                             (unsigned)(t->count * t->terms), phase, &y);
            for (int k = 0; k < t->count; k++) {
                const float *of = &row[k * t->terms];
                const float value =
                    t->terms == WH_TABLE_LINEAR ? wh_table_linear(of, y) : wh_table_cubic(of, y);
                const double off = fabs((double)value - exact[k]);
                error[m][k].square += off * off;
                if (!(off <= error[m][k].worst)) { /* a NaN counts as the worst */
                    error[m][k].worst = off;
                    error[m][k].worst_at = phase;
                }
            }
        }
    }
    for (int m = 0; m < images; m++) {
        free(cells[m]);
    }
    free(cells);
    evaluator_free(ev);
    return phases;
}
