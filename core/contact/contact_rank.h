/* contact_rank.h: detects positions at which holds lose rank: their rows of the Jacobian become linearly dependent.
 *
 * An example is a linkage that is closed by holds, in its flat position. From there more than one motion satisfies the
 * holds, and an integrator would pick one at random. So a step that reaches or passes such a position is refused.
 *
 * Each row is made orthogonal to the earlier ones in the metric of M^-1 (Gram and Schmidt). If the remainder of a row
 * vanishes, the step has reached such a position; if the remainder has reversed its direction, the step has passed one.
 * Permanently redundant holds do not count: their remainder was zero before. */
#ifndef WH_CONTACT_RANK_H
#define WH_CONTACT_RANK_H

#include "contact_project.h"

/* For each active hold, `row` is its row of J, made orthogonal to the earlier rows, and `way` is M^-1 times `row`. */
typedef struct wh_contact_rows {
    wh_real row[WH_CONTACTS_MAX][WH_COORDS];
    wh_real way[WH_CONTACTS_MAX][WH_COORDS];
    wh_real size[WH_CONTACTS_MAX]; /* row . way; 0: the hold is redundant or inactive */
    unsigned holds;
} wh_contact_rows;

WH_INLINE wh_real wh_contact_dot(const wh_contact_system *of, const wh_real *a, const wh_real *b) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < of->coordinates; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static inline void wh_contact_rows_of(const wh_contact_system *of, wh_contact_work *w,
                                      const wh_contact_point *at, const wh_real *input,
                                      wh_contact_rows *rows) {
    of = WH_CONTACTS_HERE(of);
    of->forces(of->model, at->phase, at->linear, at->rate, input, w->law);
    rows->holds = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        rows->size[k] = WH_R(0.0);
        for (unsigned i = 0; i < of->coordinates; i++) {
            rows->row[k][i] = WH_R(0.0);
            rows->way[k][i] = WH_R(0.0);
        }
        if (!wh_contact_of(of, k, WH_HOLD) || w->mode[k] != WH_ACTIVE) {
            continue;
        }
        rows->holds++;
        for (unsigned i = 0; i < of->coordinates; i++) {
            rows->row[k][i] = wh_contact_law(of, w, k)[(unsigned)WH_LAW_ROWS + i];
            rows->way[k][i] = wh_contact_law(of, w, k)[(unsigned)WH_LAW_ROWS + of->coordinates + i];
        }
        for (unsigned j = 0; j < k; j++) {
            if (rows->size[j] > WH_R(0.0)) {
                const wh_real share =
                    wh_contact_dot(of, rows->row[k], rows->way[j]) / rows->size[j];
                for (unsigned i = 0; i < of->coordinates; i++) {
                    rows->row[k][i] -= share * rows->row[j][i];
                    rows->way[k][i] -= share * rows->way[j][i];
                }
            }
        }
        const wh_real size = wh_contact_dot(of, rows->row[k], rows->way[k]);
        const bool is_left = size > WH_CONTACT_ROUNDING * wh_delassus_diagonal(of, w, k);
        rows->size[k] = is_left ? size : WH_R(0.0);
    }
}

/* Returns the first hold whose orthogonal row vanishes or reverses from `before` to `after`, or of->contacts. */
static inline unsigned wh_contact_fallen(const wh_contact_system *of, const wh_contact_rows *before,
                                         const wh_contact_rows *after) {
    of = WH_CONTACTS_HERE(of);
    for (unsigned k = 0; k < of->forced; k++) {
        const wh_real along = wh_contact_dot(of, before->row[k], after->way[k]);
        const wh_real against = along < WH_R(0.0) ? along * along : WH_R(0.0);
        /* A coarse step can turn a single hold's row, so only an almost opposite row counts. */
        const wh_real least = before->holds > 1 ? WH_R(0.0) : WH_R(0.9);
        const bool passed = against > least * before->size[k] * after->size[k];
        if (before->size[k] > WH_R(0.0) && (passed || !(after->size[k] > WH_R(0.0)))) {
            return k;
        }
    }
    return of->contacts;
}

/* Returns the hold that lost rank in a step of length `span`, or of->contacts. `to` is the end of the step, or NULL if
 * the step failed. The function also tests the state that the rates would reach without accelerations, because
 * accelerations have no bound near a flat position. */
static inline unsigned wh_contact_lost(const wh_contact_system *of, wh_contact_work *w,
                                       wh_real span, wh_contact_state *from, wh_contact_state *to,
                                       const wh_real *input) {
    wh_contact_point at;
    wh_contact_rows before;
    wh_contact_rows after;
    wh_contact_point_of(of, from, &at);
    wh_contact_rows_of(of, w, &at, input, &before);
    wh_contact_point_ahead(of, from, span, NULL, &at);
    wh_contact_rows_of(of, w, &at, input, &after);
    const unsigned ahead = wh_contact_fallen(of, &before, &after);
    if (ahead < of->contacts || to == NULL) {
        return ahead;
    }
    wh_contact_point_of(of, to, &at);
    wh_contact_rows_of(of, w, &at, input, &after);
    return wh_contact_fallen(of, &before, &after);
}

/* Like wh_contact_lost(), but skips the tests if no hold can lose rank. */
WH_INLINE unsigned wh_contact_flat(const wh_contact_system *of, wh_contact_work *w, wh_real span,
                                   wh_contact_state *from, wh_contact_state *to,
                                   const wh_real *input) {
    bool any = false;
    for (unsigned k = 0; k < of->forced && of->held > 0; k++) {
        any = any || (wh_contact_slips(of, w, k) && of->contact[k].direction <= 0);
    }
    return any ? wh_contact_lost(of, w, span, from, to, input) : of->contacts;
}

#endif
