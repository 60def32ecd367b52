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

bool swing_varies(const linearised *l, const linear_motion *m) {
    bool found = false;
    for (int i = 0; i < l->motions && is_swing(m); i++) {
        const linear_motion *other = &l->motion[i];
        const complex_number apart = {other->value.re - m->value.re, other->value.im - m->value.im};
        found = found || (is_swing(other) && other->value.re * l->span_s > 1.0 &&
                          complex_size(apart) < ALIKE * complex_size(m->value));
    }
    return found;
}

double swing_off(const watch *w) {
    const int n = w->field->n;
    double *x = room(n, sizeof *x);
    double off = 0.0;
    memcpy(x, w->record, (size_t)n * sizeof *x);
    for (int k = 1; k < w->records; k++) {
        const double from_s = w->record_s[k - 1];
        const double span_s = w->record_s[k] - from_s;
        const double *record = w->record + k * (ptrdiff_t)n;
        field_go(w->field, from_s, span_s, 2 * (int)(span_s / w->step_s + 0.5), x);
        for (int i = 0; i < n; i++) {
            const double range = w->high[i] - w->low[i];
            const double apart = fabs(x[i] - record[i]);
            off = range > 0.0 && !(apart <= off * range) ? apart / range : off;
        }
    }
    free(x);
    return isnan(off) ? (double)INFINITY : off;
}
