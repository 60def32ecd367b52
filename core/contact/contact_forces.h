/* contact_forces.h: the forces and impulses of a scene's contacts. */
#ifndef WH_CONTACT_FORCES_H
#define WH_CONTACT_FORCES_H

#include "contact_lcp.h"

/* Computes work->force again if a force exceeds its limit, or if a redundant contact contradicts the others. `repeats`
 * has the redundant contacts, as bits of indices in member[]. */
WH_APART void wh_contact_redistribute(const wh_contact_system *of, wh_contact_work *w,
                                      const uint8_t *member, unsigned count, unsigned repeats,
                                      wh_real *accel) {
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real left[WH_CONTACTS_MAX];
    wh_real way[WH_COORDS] = {WH_R(0.0)};
    int8_t push[WH_CONTACTS_MAX] = {0};
    bool exceeds = false;
    bool contradicts = false;
    for (unsigned i = 0; i < count; i++) {
        exceeds = exceeds || wh_contact_exceeds(of, w, member[i], w->force[member[i]]);
        wh_contact_apply(of, w, member[i], w->force[member[i]], way);
    }
    wh_contact_magnitudes(of, w, member, count, accel);
    const wh_contact_set set = {member, count, NULL};
    wh_contact_contradicts(of, w, &set, repeats, NULL, w->wanted, way, push);
    for (unsigned i = 0; i < count; i++) {
        contradicts = contradicts || push[i] != 0;
    }
    if (!exceeds && !contradicts) {
        return;
    }
    const unsigned giving = wh_contact_lcp(of, w, member, count, w->wanted, true, lambda, left);
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = member[i];
        if (contradicts) {
            wh_contact_apply(of, w, k, lambda[i] - w->force[k], accel);
        }
        w->force[k] = lambda[i];
        if ((giving >> k & 1U) != 0) {
            w->force[k] -= left[i] / wh_delassus_diagonal(of, w, k);
            if (!wh_contact_exceeds(of, w, k, w->force[k])) {
                /* round-off hides that the force is beyond its limit: move it farther */
                w->force[k] += left[i] < WH_R(0.0) ? WH_CONTACT_SHOWS * WH_ABS(lambda[i])
                                                   : -WH_CONTACT_SHOWS * WH_ABS(lambda[i]);
            }
        }
    }
}

/* Computes the accelerations with the contacts' forces, and stores the forces in work->force. A wh_accel_fn. */
static inline void wh_contact_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                                    const wh_real *rate, const wh_real *input, wh_real *accel) {
    const wh_contact_model *m = model;
    const wh_contact_system *of = WH_CONTACTS_OF(m);
    wh_contact_work *w = m->work;
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real lambda[WH_CONTACTS_MAX];
    unsigned count = 0;

    WH_MARK(WH_MARK_ACCEL);
    of->accel(of->model, phase, linear, rate, input, accel);
    if (!wh_contact_any_acts(of, w)) {
        wh_books_stage(of, w, phase, linear, rate, input);
        return;
    }
    of->forces(of->model, phase, linear, rate, input, w->law);
    for (unsigned k = 0; k < of->forced; k++) {
        w->force[k] = WH_R(0.0);
        if (wh_contact_constrains(of, w, k)) {
            member[count++] = (uint8_t)k;
        } else if (wh_contact_of(of, k, WH_FRICTION)) {
            const wh_real size = wh_contact_law(of, w, k)[WH_LAW_SECOND];
            w->force[k] = w->mode[k] > 0 ? -size : size;
            wh_contact_apply(of, w, k, w->force[k], accel);
        }
    }
    for (unsigned i = 0; i < count; i++) {
        w->wanted[i] = -(wh_contact_law(of, w, member[i])[WH_LAW_BIAS] +
                         wh_jacobian_times(of, w, member[i], accel));
    }
    const unsigned repeats = wh_delassus_solve(of, w, member, count, NULL, w->wanted, lambda);
    for (unsigned i = 0; i < count; i++) {
        w->force[member[i]] = lambda[i];
        wh_contact_apply(of, w, member[i], lambda[i], accel);
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = wh_contact_pin(of, member[i]);
        if (pin >= 0) { /* the coordinate's acceleration is exactly 0, or NaN if the force is NaN */
            accel[pin] = lambda[i] - lambda[i];
        }
    }
    if (repeats != 0 && of->forced > 1) {
        wh_contact_redistribute(of, w, member, count, repeats, accel);
    }
    wh_books_stage(of, w, phase, linear, rate, input);
}

/* Evaluates the accelerations, forces and signals at state `s`, with the contacts' modes in `w`. */
static inline void wh_contact_look(const wh_contact_system *of, wh_contact_work *w,
                                   wh_contact_state *s, const wh_real *input, wh_real *accel,
                                   wh_real *signal) {
    const wh_contact_model model = {of, w};
    wh_contact_point at;
    wh_contact_point_of(of, s, &at);
    wh_contact_accel(&model, at.phase, at.linear, at.rate, input, accel);
    if (!wh_contact_any_acts(of, w)) {
        of->forces(of->model, at.phase, at.linear, at.rate, input, w->law);
    }
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, signal);
}

/* Applies impulses. J_k q' becomes target[k] for contacts in `set` (bits), and 0 for stops in `beside` (bits) and for
 * active stops and holds outside `set`. Returns, as bits, the stops whose impulse would pull. */
static inline unsigned wh_contact_impulses(const wh_contact_system *of, wh_contact_work *w,
                                           unsigned set, unsigned beside, const wh_real *target,
                                           wh_real *rate, wh_real *impulse) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real before[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real left[WH_CONTACTS_MAX];
    unsigned count = 0;
    for (unsigned l = 0; l < of->forced; l++) {
        const bool holds = !wh_contact_is(of, l, WH_LIMITED) && wh_contact_constrains(of, w, l);
        if (holds || ((set | beside) >> l & 1U) != 0) {
            const wh_real goal = (set >> l & 1U) != 0 ? target[l] : WH_R(0.0);
            before[count] = wh_jacobian_times(of, w, l, rate);
            wanted[count] = goal - before[count];
            member[count++] = (uint8_t)l;
        }
    }
    const unsigned giving = wh_contact_lcp(of, w, member, count, wanted, false, lambda, left);
    for (unsigned i = 0; i < count; i++) {
        wh_contact_apply(of, w, member[i], lambda[i], rate);
    }
    for (unsigned i = 0; i < count; i++) {
        const unsigned l = member[i];
        const int pin = wh_contact_pin(of, l);
        const bool stays =
            (giving >> l & 1U) == 0 && ((set >> l & 1U) == 0 || target[l] == WH_R(0.0));
        if (pin >= 0 && stays) {
            rate[pin] = WH_R(0.0);
        }
        impulse[l] += lambda[i];
        wh_books_impulse(of, w, l, lambda[i], before[i], wh_jacobian_times(of, w, l, rate), rate);
    }
    return giving;
}

#endif
