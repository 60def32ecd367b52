/* contact_forces.h: the forces and impulses of a scene's contacts (see contact.h). */
#ifndef WH_CONTACT_FORCES_H
#define WH_CONTACT_FORCES_H

#include "contact_lcp.h"

/* Contacts that repeat what others hold, as bits of places in member[], had nothing to do. Where that leaves
 * another with more than it can take, or where they contradict the others, share the load out: work->force has
 * the shares, those that give way even so beyond their limits by what they would have to take on top. Where
 * they contradict, the accelerations change with that; where they agree, they stay the same to the bit. */
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
        exceeds = exceeds || wh_contact_exceeds(of, w, member[i], 0, w->force[member[i]]);
        wh_contact_apply(of, w, member[i], w->force[member[i]], way);
    }
    wh_contact_magnitudes(of, w, member, count, accel);
    wh_contact_contradicts(of, w, member, count, NULL, repeats, w->wanted, way, push);
    for (unsigned i = 0; i < count; i++) {
        contradicts = contradicts || push[i] != 0;
    }
    if (!exceeds && !contradicts) {
        return;
    }
    const unsigned giving = wh_contact_lcp(of, w, member, count, w->wanted, 0, true, lambda, left);
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = member[i];
        if (contradicts) {
            wh_contact_apply(of, w, k, lambda[i] - w->force[k], accel);
        }
        w->force[k] = lambda[i];
        if ((giving >> k & 1U) != 0) {
            w->force[k] -= left[i] / wh_delassus_diagonal(of, w, k);
            if (!wh_contact_exceeds(of, w, k, 0, w->force[k])) { /* by less than shows */
                w->force[k] += left[i] < WH_R(0.0) ? WH_CONTACT_SHOWS * WH_ABS(lambda[i])
                                                   : -WH_CONTACT_SHOWS * WH_ABS(lambda[i]);
            }
        }
    }
}

/* The accelerations with the contacts' forces, which stay in work->force. A wh_accel_fn. */
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
        } else if (of->contact[k].kind == WH_FRICTION) {
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
        const int pin = of->contact[member[i]].pin;
        if (pin >= 0) { /* zero, unless what is held back is no number */
            accel[pin] = lambda[i] - lambda[i];
        }
    }
    if (repeats != 0 && of->forced > 1) {
        wh_contact_redistribute(of, w, member, count, repeats, accel);
    }
    wh_books_stage(of, w, phase, linear, rate, input);
}

/* Give contact k the impulse that leaves J_k q' = target, with those that hold what they hold; resting stops, and
 * those in `beside`, as bits, push but do not pull: those that would are let go. work->law must belong to this
 * position. Returns the impulse of k. */
static inline wh_real wh_contact_impulse(const wh_contact_system *of, wh_contact_work *w,
                                         unsigned k, unsigned beside, wh_real target,
                                         wh_real *rate) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real left[WH_CONTACTS_MAX];
    unsigned count = 0;
    for (unsigned l = 0; l < of->forced; l++) {
        const bool holds = of->contact[l].kind != WH_FRICTION && w->mode[l] == WH_ACTIVE;
        if (l == k || holds || (beside >> l & 1U) != 0) {
            const wh_real goal = l == k ? target : WH_R(0.0);
            wanted[count] = goal - wh_jacobian_times(of, w, l, rate);
            member[count++] = (uint8_t)l;
        }
    }
    const unsigned giving =
        wh_contact_lcp(of, w, member, count, wanted, 1U << k, false, lambda, left) & ~(1U << k);
    for (unsigned l = 0; l < of->forced; l++) {
        if ((giving >> l & 1U) != 0) {
            w->mode[l] = WH_FREE;
        }
    }
    wh_real own = WH_R(0.0);
    for (unsigned i = 0; i < count; i++) {
        wanted[i] = wh_jacobian_times(of, w, member[i], rate);
    }
    for (unsigned i = 0; i < count; i++) {
        wh_contact_apply(of, w, member[i], lambda[i], rate);
        own = member[i] == k ? lambda[i] : own;
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = of->contact[member[i]].pin;
        const bool held =
            (giving >> member[i] & 1U) == 0 && (member[i] != k || target == WH_R(0.0));
        if (pin >= 0 && held) {
            rate[pin] = WH_R(0.0);
        }
        wh_books_impulse(of, w, member[i], lambda[i], wanted[i],
                         wh_jacobian_times(of, w, member[i], rate));
    }
    return own;
}

#endif
