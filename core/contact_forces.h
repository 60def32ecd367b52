/* contact_forces.h: the forces and impulses of a scene's contacts (see contact.h). */
#ifndef WH_CONTACT_FORCES_H
#define WH_CONTACT_FORCES_H

#include "contact_ledger.h"

/* Solve sum_l (J_k M^-1 J_l^T) amount_l = wanted_k for the `count` contacts in member[], by elimination
 * without pivoting: the matrix is positive definite, but for contacts that repeat what others hold
 * already, which get nothing to do. wanted[] is used up. */
static inline void wh_contact_solve(const wh_hybrid *of, const wh_contact_work *w,
                                    const uint8_t *member, unsigned count, wh_real *wanted,
                                    wh_real *amount) {
    const wh_real least = WH_DOUBLE ? WH_R(1e-11) : WH_R(1e-5);
    wh_real matrix[WH_CONTACTS_MAX][WH_CONTACTS_MAX] = {{WH_R(0.0)}};
    bool idle[WH_CONTACTS_MAX] = {false};
    for (unsigned r = 0; r < count; r++) {
        for (unsigned c = 0; c < count; c++) {
            matrix[r][c] = wh_along(of, w, member[r],
                                    wh_law(of, w, member[c]) + WH_LAW_ROWS + of->coordinates);
        }
    }
    for (unsigned p = 0; p < count; p++) {
        const wh_real whole =
            wh_along(of, w, member[p], wh_law(of, w, member[p]) + WH_LAW_ROWS + of->coordinates);
        idle[p] = !(matrix[p][p] > least * whole);
        for (unsigned r = p + 1; r < count && !idle[p]; r++) {
            const wh_real factor = matrix[r][p] / matrix[p][p];
            for (unsigned c = p; c < count; c++) {
                matrix[r][c] -= factor * matrix[p][c];
            }
            wanted[r] -= factor * wanted[p];
        }
    }
    for (unsigned p = count; p-- > 0;) {
        wh_real sum = wanted[p];
        for (unsigned c = p + 1; c < count; c++) {
            sum -= matrix[p][c] * amount[c];
        }
        amount[p] = idle[p] ? WH_R(0.0) : sum / matrix[p][p];
    }
}

/* The accelerations with the contacts' forces, which stay in work->force. A wh_accel_fn. */
static inline void wh_contact_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                                    const wh_real *rate, const wh_real *input, wh_real *accel) {
    const wh_contact_model *m = model;
    const wh_hybrid *of = WH_CONTACTS_OF(m);
    wh_contact_work *w = m->work;
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX];
    wh_real amount[WH_CONTACTS_MAX];
    unsigned count = 0;

    of->accel(of->model, phase, linear, rate, input, accel);
    if (!wh_feels(of, w)) {
        wh_books_stage(of, w, phase, linear, rate, input);
        return;
    }
    of->forces(of->model, phase, linear, rate, input, w->law);
    for (unsigned k = 0; k < of->forced; k++) {
        w->force[k] = WH_R(0.0);
        if (wh_constrains(of, w, k)) {
            member[count++] = (uint8_t)k;
        } else if (of->contact[k].kind == WH_FRICTION) {
            const wh_real size = wh_law(of, w, k)[WH_LAW_SECOND];
            w->force[k] = w->mode[k] > 0 ? -size : size;
            wh_push(of, w, k, w->force[k], accel);
        }
    }
    for (unsigned i = 0; i < count; i++) {
        wanted[i] = -(wh_law(of, w, member[i])[WH_LAW_BIAS] + wh_along(of, w, member[i], accel));
    }
    wh_contact_solve(of, w, member, count, wanted, amount);
    for (unsigned i = 0; i < count; i++) {
        w->force[member[i]] = amount[i];
        wh_push(of, w, member[i], amount[i], accel);
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = of->contact[member[i]].pin;
        if (pin >= 0) {
            accel[pin] = WH_R(0.0);
        }
    }
    wh_books_stage(of, w, phase, linear, rate, input);
}

/* Give contact k the impulse that leaves J_k q' = target, with those that hold what they hold; resting
 * stops push but do not pull: those that would are let go. work->law must belong to this position.
 * Returns the impulse of k. */
static inline wh_real wh_contact_impulse(const wh_hybrid *of, wh_contact_work *w, unsigned k,
                                         wh_real target, wh_real *rate) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX];
    wh_real amount[WH_CONTACTS_MAX];
    unsigned count;
    bool again = true;
    do {
        again = false;
        count = 0;
        for (unsigned l = 0; l < of->forced; l++) {
            const bool holds = of->contact[l].kind != WH_FRICTION && w->mode[l] == WH_ACTIVE;
            if (l == k || holds) {
                const wh_real goal = l == k ? target : WH_R(0.0);
                wanted[count] = goal - wh_along(of, w, l, rate);
                member[count++] = (uint8_t)l;
            }
        }
        wh_contact_solve(of, w, member, count, wanted, amount);
        for (unsigned i = 0; i < count; i++) {
            const unsigned l = member[i];
            if (l != k && of->contact[l].kind == WH_STOP && amount[i] < WH_R(0.0)) {
                w->mode[l] = WH_FREE;
                again = true;
            }
        }
    } while (again);
    wh_real own = WH_R(0.0);
    for (unsigned i = 0; i < count; i++) {
        wanted[i] = wh_along(of, w, member[i], rate);
    }
    for (unsigned i = 0; i < count; i++) {
        wh_push(of, w, member[i], amount[i], rate);
        own = member[i] == k ? amount[i] : own;
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = of->contact[member[i]].pin;
        if (pin >= 0 && (member[i] != k || target == WH_R(0.0))) {
            rate[pin] = WH_R(0.0);
        }
        wh_books_impulse(of, w, member[i], amount[i], wanted[i], wh_along(of, w, member[i], rate));
    }
    return own;
}

#endif
