/* swing.c: see swing.h. */
#include "swing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

/* Motions whose values differ by less than this part are one and the same motion. */
#define ALIKE 0.5

static bool is_swing(const linear_motion *m) {
    return fabs(m->value.im) > 0.1 * complex_size(m->value);
}

/* A decay is one with a growth that the same component has elsewhere. */
static bool is_alike(const linear_motion *m, const linear_motion *other) {
    const complex_number apart = {other->value.re - m->value.re, other->value.im - m->value.im};
    return is_swing(m) ? is_swing(other) && complex_size(apart) < ALIKE * complex_size(m->value)
                       : !is_swing(other) && other->unknown[0] == m->unknown[0];
}

bool swing_varies(const linearised *l, const linear_motion *m) {
    bool found = false;
    for (int i = 0; i < l->motions; i++) {
        const linear_motion *other = &l->motion[i];
        found = found || (is_alike(m, other) && other->value.re * l->span_s > 1.0);
    }
    return found;
}

double swing_off(const watch *w) {
    const int n = w->field->n;
    double *x = room(n, sizeof *x);
    double off = 0.0;
    memcpy(x, w->record, (size_t)n * sizeof *x);
    for (int k = 1; k < w->records; k++) {
        const double span_s = w->record_s[k] - w->record_s[k - 1];
        const double *record = w->record + k * (ptrdiff_t)n;
        field_go(w->field, span_s, 2 * (int)(span_s / w->step_s + 0.5), x);
        for (int i = 0; i < n; i++) {
            const double range = w->high[i] - w->low[i];
            const double apart = fabs(x[i] - record[i]);
            off = range > 0.0 && !(apart <= off * range) ? apart / range : off;
        }
    }
    free(x);
    return isnan(off) ? (double)INFINITY : off;
}
