/* rk4.h: the classic Runge-Kutta method of fourth order, a plain step. Begin here to read the core.
 *
 *     k1 = f(x)
 *     k2 = f(x + h/2 k1)
 *     k3 = f(x + h/2 k2)
 *     k4 = f(x + h k3)
 *     x  = x + h/6 (k1 + 2 k2 + 2 k3 + k4)
 *
 * (Kutta, Zeitschrift fuer Mathematik und Physik 46, 1901; Hairer, Norsett & Wanner, Solving Ordinary Differential
 * Equations I, section II.1). A step evaluates f four times, and its error is of order h^5.
 *
 * The vector x is a scene's state (state.h): its angles, then its reals. In a mechanism, q'' = f(q, q', u), x holds the
 * positions q and the rates q'. The slopes of the positions are the rates, and the slopes of the rates are the
 * accelerations. Angles are integers: wh_angle_move() moves an angle by slope times time (angle.h).
 *
 * `--method rk4-plain` runs a scene by this step. The method `rk4` is the same in exact arithmetic, but costs less:
 * step.h shares sums between positions and rates, and looks each sine up only once (stage_turn.h). */
#ifndef WH_RK4_H
#define WH_RK4_H

#include "step/step_end.h"

/* Derivatives of a first-order system: slope[angles + reals], the angles' slopes first (rad/s). */
typedef void wh_slope_fn(const void *model, const wh_phase *phase, const wh_real *real,
                         const wh_real *input, wh_real *slope);

/* The system x' = f(x, u). Either `slope` computes all slopes, or `accel` computes the accelerations of a mechanism
 * with `coordinates` positions, the first `angles` of them angles. The unused pointer is NULL. */
typedef struct wh_rk4_system {
    const void *model;
    wh_slope_fn *slope;
    wh_accel_fn *accel;
    unsigned coordinates;
    unsigned angles;
    unsigned reals; /* number of reals in the state: linear positions, then rates */
} wh_rk4_system;

typedef struct wh_rk4_slopes {
    wh_real angle[WH_COORDS]; /* rad/s */
    wh_real real[2 * WH_COORDS];
} wh_rk4_slopes;

/* k = f(x). */
WH_INLINE void wh_rk4_evaluate(const wh_rk4_system *f, const wh_phase *phase, const wh_real *real,
                               const wh_real *input, wh_rk4_slopes *k) {
    const unsigned linears = f->coordinates - f->angles;
    const wh_real *rate = real + linears;
    wh_real given[WH_COORDS];
    if (f->accel != NULL) {
        f->accel(f->model, phase, real, rate, input, given);
    } else {
        f->slope(f->model, phase, real, input, given);
    }
    WH_UNROLL
    for (unsigned i = 0; i < f->angles; i++) {
        k->angle[i] = f->accel != NULL ? rate[i] : given[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < f->reals; i++) {
        k->real[i] = f->accel == NULL ? given[f->angles + i]
                     : i < linears    ? rate[f->angles + i]
                                      : given[i - linears];
    }
}

/* k = f(x + h k0). Returns the first angle that would move by half a turn or more, or `angles` if there is none. */
WH_INLINE unsigned wh_rk4_stage(const wh_rk4_system *f, const wh_state *x, wh_real h,
                                const wh_rk4_slopes *k0, wh_rk4_slopes *k) {
    wh_phase phase[WH_COORDS] = {0};
    wh_real real[2 * WH_COORDS] = {0};
    WH_UNROLL
    for (unsigned i = 0; i < f->angles; i++) {
        const wh_real units = h * k0->angle[i] * WH_PHASE_PER_RAD;
        if (!wh_phase_move(wh_phase_of(x->angle[i]), units, &phase[i])) {
            return i;
        }
    }
    WH_UNROLL
    for (unsigned i = 0; i < f->reals; i++) {
        real[i] = x->real[i] + h * k0->real[i];
    }
    wh_rk4_evaluate(f, phase, real, x->input, k);
    return f->angles;
}

WH_INLINE wh_real wh_rk4_sum(wh_real k1, wh_real k2, wh_real k3, wh_real k4) {
    return k1 + WH_R(2.0) * (k2 + k3) + k4;
}

/* One step of h seconds. Returns WH_OK, or WH_E_DIVERGED with state->fault set and the rest of the state unchanged. */
WH_INLINE wh_status wh_rk4_step(const wh_rk4_system *f, wh_real h, wh_state *state) {
    const unsigned angles = f->angles;
    const wh_real half = h / WH_R(2.0);
    const wh_real sixth = h / WH_R(6.0);
    wh_rk4_slopes k1;
    wh_rk4_slopes k2 = {.angle = {0}, .real = {0}}; /* zeros for static analysers only */
    wh_rk4_slopes k3 = {.angle = {0}, .real = {0}};
    wh_rk4_slopes k4 = {.angle = {0}, .real = {0}};
    wh_phase phase[WH_COORDS] = {0};
    wh_trial next;

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        phase[i] = wh_phase_of(state->angle[i]);
    }
    wh_rk4_evaluate(f, phase, state->real, state->input, &k1);
    WH_REFUSE_FAR(wh_rk4_stage(f, state, half, &k1, &k2));
    WH_REFUSE_FAR(wh_rk4_stage(f, state, half, &k2, &k3));
    WH_REFUSE_FAR(wh_rk4_stage(f, state, h, &k3, &k4));

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        const wh_real sum = wh_rk4_sum(k1.angle[i], k2.angle[i], k3.angle[i], k4.angle[i]);
        const wh_real units = sixth * sum * WH_PHASE_PER_RAD;
        if (!wh_believable(units, WH_PHASE_STEP_MAX)) {
            return wh_refuse(state, i);
        }
        next.angle[i] = state->angle[i];
        wh_angle_move(&next.angle[i], units, false, &next.carry[i]);
        WH_ANGLE_LOST(i, h, units - (wh_real)(next.angle[i] - state->angle[i]));
    }
    WH_UNROLL
    for (unsigned i = 0; i < f->reals; i++) {
        const wh_real sum = wh_rk4_sum(k1.real[i], k2.real[i], k3.real[i], k4.real[i]);
        next.real[i] = state->real[i] + sixth * sum;
    }
    return wh_accept(&next, angles, f->reals, false, state);
}

#endif
