/* step.h: the fixed-step integrators, as inline functions. One loop over the stages of a row of method.h serves all
 * methods; rk4.h has the classic method in full.
 *
 * A generated scene and the host's interpreter both include this file, so both have the same order of floating-point
 * operations and the same bits. In a generated scene the counts, the method and `compensated` are constants and the
 * right-hand side is inlined, so the compiler unrolls the loops and drops unused operations. C only: programs that
 * embed a scene include scene.h and the generated header.
 *
 * For q'' = f(q, q', u), positions and rates have separate sums. The result is that of the same method on the
 * first-order form, up to round-off, with fewer operations (Hairer, Norsett & Wanner, Solving Ordinary Differential
 * Equations I, section II.14). */
#ifndef WH_STEP_H
#define WH_STEP_H

#include "number/arithmetic.h"
#include "rk4.h"
#include "root.h"
#include "step/multi_step.h"
#include "step/step_end.h"

/* Computes the phase of `angle` + h / parts * `sum`. Returns as wh_phase_move() does. */
WH_INLINE bool wh_stage_angle(wh_angle angle, wh_real sum, wh_real h, wh_real parts,
                              wh_phase *phase) {
    return parts == WH_R(2.0)
               ? wh_phase_move_half(wh_phase_of(angle), sum * (h * WH_PHASE_PER_RAD), phase)
               : wh_phase_move(wh_phase_of(angle), sum * (h / parts * WH_PHASE_PER_RAD), phase);
}

/* The arguments that all stages of a step share. */
typedef struct wh_stepping {
    const wh_tableau *by; /* the method */
    const wh_state *state;
    wh_real h;
    unsigned angles;
    unsigned n; /* coordinates (second order) or components (first order) */
    bool compensated;
} wh_stepping;

/* Arguments and results of an operation list in one struct, so that a call of the list leaves other variables in
 * registers. */
typedef struct wh_stepped_list {
    wh_phase phase[WH_COORDS];
    wh_real at[WH_COORDS];    /* linear positions (second order), or reals (first order) */
    wh_real v[WH_COORDS];     /* rates */
    wh_real given[WH_COORDS]; /* accelerations, or slopes */
} wh_stepped_list;

/* Fills list->phase[], and zeroes the unused elements of list->at[]. */
WH_INLINE void wh_stepped_begin(const wh_state *state, unsigned angles, unsigned linears,
                                wh_stepped_list *list) {
    WH_UNROLL
    for (unsigned i = 0; i < WH_COORDS; i++) {
        list->phase[i] = i < angles ? wh_phase_of(state->angle[i]) : (wh_phase)0;
        if (i >= linears) {
            list->at[i] = WH_R(0.0);
        }
    }
}

/* A step of q'' = f(q, q', u) in progress. */
typedef struct wh_stepped_second {
    const wh_real *linear; /* linear positions at the begin */
    const wh_real *rate;
    const wh_real *input;
    wh_real a1[WH_COORDS];               /* accelerations of the first stage */
    wh_real rates[WH_STAGES][WH_COORDS]; /* rates of the later stages */
    wh_real accels[WH_STAGES][WH_COORDS];
    wh_real alike[WH_STAGES][WH_COORDS]; /* sums of the derivatives over stages of equal weight */
} wh_stepped_second;

/* Computes the positions of stage s, for a method with .places. Returns as wh_step_second_stage() does. */
WH_INLINE unsigned wh_step_reach(const wh_stepping *to, unsigned s, wh_given accels,
                                 wh_stepped_list *list, const wh_stepped_second *k) {
    const unsigned angles = to->angles;
    WH_UNROLL
    for (unsigned i = 0; i < to->n - angles; i++) {
        list->at[i] = k->linear[i] +
                      wh_stage_reach(to->by, s, k->rate[angles + i], accels, to->h, angles + i);
    }
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        const wh_real rad = wh_stage_reach(to->by, s, k->rate[i], accels, to->h, i);
        const wh_phase begin = wh_phase_of(to->state->angle[i]);
        if (!wh_phase_move(begin, rad * WH_PHASE_PER_RAD, &list->phase[i])) {
            return i;
        }
    }
    return angles;
}

/* Computes stage s > 0. Returns the first angle that would move by half a turn or more, or `angles`. */
WH_INLINE unsigned wh_step_second_stage(const void *model, wh_accel_fn *accel,
                                        const wh_stepping *to, unsigned s, wh_stepped_list *list,
                                        wh_stepped_second *k) {
    const wh_tableau *by = to->by;
    const wh_real h = to->h;
    const unsigned angles = to->angles;
    const wh_given all_rates = {k->rate, k->rates};
    const wh_given all_accels = {k->a1, k->accels};
    const wh_real *share = by->stage[s].share;
    const wh_real parts = by->stage[s].parts;
    if (s >= by->stages) {
        return angles;
    }
    WH_UNROLL
    for (unsigned i = 0; i < to->n; i++) {
        list->v[i] = k->rate[i] + h / parts * wh_stage_sum(share, s, all_accels, i);
        k->rates[s - 1][i] = list->v[i];
    }
    if (wh_stage_reaches(by)) {
        const unsigned far = wh_step_reach(to, s, all_accels, list, k);
        if (far < angles) {
            return far;
        }
    } else {
        WH_UNROLL
        for (unsigned i = 0; i < to->n - angles; i++) {
            list->at[i] = k->linear[i] + h / parts * wh_stage_sum(share, s, all_rates, angles + i);
        }
        WH_UNROLL
        for (unsigned i = 0; i < angles; i++) {
            if (!wh_stage_angle(to->state->angle[i], wh_stage_sum(share, s, all_rates, i), h, parts,
                                &list->phase[i])) {
                return i;
            }
        }
    }
    accel(model, list->phase, list->at, list->v, k->input, list->given);
    wh_stage_given(by, s, true, to->n, k->a1, list->given, k->accels, k->alike);
    return angles;
}

/* One step of q'' = f(q, q', u), angles <= n <= WH_COORDS. Returns WH_OK, or WH_E_DIVERGED with state->fault set and
 * the rest of the state unchanged. */
WH_INLINE wh_status wh_step_second(const void *model, wh_accel_fn *accel, wh_method method,
                                   bool compensated, unsigned angles, unsigned n, wh_two_part h,
                                   wh_state *state) {
    if (method == WH_RK4_PLAIN && !compensated) {
        const wh_rk4_system plain = {.model = model,
                                     .accel = accel,
                                     .coordinates = n,
                                     .angles = angles,
                                     .reals = 2 * n - angles};
        return wh_rk4_step(&plain, h.high, state);
    }
    const wh_tableau *by = wh_tableau_of(method);
    const wh_stepping to = {by, state, h.high, angles, n, compensated};
    wh_stepped_second k = {
        .linear = state->real, .rate = state->real + (n - angles), .input = state->input};
    wh_stepped_list list;
    wh_stepped_begin(state, angles, n - angles, &list);
    if (wh_begins_away(by)) {
        const wh_given none = {k.a1, k.accels};
        WH_REFUSE_FAR(wh_step_reach(&to, 0, none, &list, &k));
        accel(model, list.phase, list.at, k.rate, k.input, list.given);
    } else {
        accel(model, list.phase, k.linear, k.rate, k.input, list.given);
    }
    wh_copy(list.given, n, k.a1);
#define WH_STAGE(stage) WH_REFUSE_FAR(wh_step_second_stage(model, accel, &to, stage, &list, &k))
    WH_LATER_STAGES(by, WH_STAGE);
#undef WH_STAGE
    return wh_second_end(by, k.a1, k.alike, false, compensated, angles, n, h, state);
}

/* A step of x' = f(x, u) in progress. */
typedef struct wh_stepped_first {
    wh_real k1[WH_COORDS];                /* derivatives of the first stage */
    wh_real slopes[WH_STAGES][WH_COORDS]; /* derivatives of the later stages */
    wh_real alike[WH_STAGES][WH_COORDS];  /* sums of the derivatives over stages of equal weight */
} wh_stepped_first;

/* Computes stage s > 0. Returns as wh_step_second_stage() does. */
WH_INLINE unsigned wh_step_first_stage(const void *model, wh_slope_fn *slope, const wh_stepping *to,
                                       unsigned s, wh_stepped_list *list, wh_stepped_first *k) {
    const wh_tableau *by = to->by;
    const wh_real h = to->h;
    const unsigned angles = to->angles;
    const wh_given all = {k->k1, k->slopes};
    const wh_real *share = by->stage[s].share;
    const wh_real parts = by->stage[s].parts;
    if (s >= by->stages) {
        return angles;
    }
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        if (!wh_stage_angle(to->state->angle[i], wh_stage_sum(share, s, all, i), h, parts,
                            &list->phase[i])) {
            return i;
        }
    }
    WH_UNROLL
    for (unsigned i = 0; i < to->n - angles; i++) {
        list->at[i] = to->state->real[i] + h / parts * wh_stage_sum(share, s, all, angles + i);
    }
    slope(model, list->phase, list->at, to->state->input, list->given);
    wh_stage_given(by, s, false, to->n, k->k1, list->given, k->slopes, k->alike);
    return angles;
}

/* One step of x' = f(x, u) with `angles` turn angles and `reals` reals, angles + reals <= WH_COORDS. Returns
 * WH_E_ARGUMENT, with the state unchanged, if the method is only for second-order systems. Otherwise returns as
 * wh_step_second() does. */
WH_INLINE wh_status wh_step_first(const void *model, wh_slope_fn *slope, wh_method method,
                                  bool compensated, unsigned angles, unsigned reals, wh_two_part h,
                                  wh_state *state) {
    if (method == WH_RK4_PLAIN && !compensated) {
        const wh_rk4_system plain = {.model = model,
                                     .slope = slope,
                                     .angles = angles,
                                     .reals = reals,
                                     .coordinates = angles};
        return wh_rk4_step(&plain, h.high, state);
    }
    const wh_tableau *by = wh_tableau_of(method);
    const wh_stepping to = {by, state, h.high, angles, angles + reals, compensated};
    wh_stepped_first k;
    wh_stepped_list list;

    if (!wh_method_takes(method, WH_FIRST_ORDER)) {
        return WH_E_ARGUMENT;
    }
    wh_stepped_begin(state, angles, reals, &list);
    slope(model, list.phase, state->real, state->input, list.given);
    wh_copy(list.given, angles + reals, k.k1);
#define WH_STAGE(stage) WH_REFUSE_FAR(wh_step_first_stage(model, slope, &to, stage, &list, &k))
    WH_LATER_STAGES(by, WH_STAGE);
#undef WH_STAGE
    return wh_first_end(by, k.k1, k.alike, compensated, angles, reals, h, state);
}

#endif
