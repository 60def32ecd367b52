/* step.h: the fixed-step integrators, one readable inline source.
 *
 * A generated scene and the host's interpreter both include this file. In a generated scene the
 * counts, the method and `compensated` are constants and the right-hand side is inlined, so the
 * compiler unrolls the loops and drops whatever the scene does not call for; the order of the
 * floating-point operations, and so every bit of the result, is the same in both. Neither is C++: what
 * embeds a scene includes scene.h and the generated header.
 *
 * For q'' = f(q, q', u) the position stages of the Runge-Kutta methods are written out, which gives
 * the classic method's numbers to rounding with fewer operations (Hairer, Norsett & Wanner,
 * Solving Ordinary Differential Equations I, section II.14):
 *
 *     v2 = v + h/2 a1          q2 = q + h/2 v          a2 = f(q2, v2)
 *     v3 = v + h/2 a2          q3 = q + h/2 v2         a3 = f(q3, v3)
 *     v4 = v + h a3            q4 = q + h v3           a4 = f(q4, v4)
 *     q+ = q + h (v + h/6 (a1 + a2 + a3))              v+ = v + h/6 (a1 + 2 a2 + 2 a3 + a4)
 */
#ifndef WH_STEP_H
#define WH_STEP_H

#ifdef __cplusplus
#error \
    "core/step.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

#include "arithmetic.h"
#include "scene.h"
#include "sum.h"

/* Most coordinates (second order) or components (first order). A generated scene defines its own
 * and has its loops unrolled: gcc -O2 would not, and arrays indexed by a counter stay in memory. */
#ifndef WH_COORDS
#define WH_COORDS 64
#define WH_UNROLL
#elif defined(__GNUC__) && __GNUC__ >= 8 && !defined(__clang__) /* which older ones do not know */
#define WH_UNROLL _Pragma("GCC unroll 64")
#else
#define WH_UNROLL
#endif

/* A linear position or a rate beyond this is no mechanism's: the step is refused. */
#define WH_ABSURD WH_R(1e15)

/* Derivatives of a first-order system: slope[angles + reals], angles first (rad/s). */
typedef void wh_slope_fn(const void *model, const wh_phase *phase, const wh_real *real,
                         const wh_real *input, wh_real *slope);

/* True for finite numbers of a believable size; false for NaN. */
WH_INLINE bool wh_believable(wh_real value, wh_real limit) { return WH_ABS(value) < limit; }

/* *angle moved on by `steps` phase units, rounded to the nearest: dropping the fraction would slow every
 * angle down by half a unit a step. False, with *angle as it was, for half a turn or more, or NaN. */
WH_INLINE bool wh_angle_move(wh_angle *angle, wh_real steps, bool compensated, wh_real *carry) {
#if WH_DOUBLE
    if (!wh_believable(steps, WH_PHASE_STEP_MAX)) {
        return false;
    }
    *angle = wh_sum(*angle, steps, compensated, carry);
#else
    if (compensated) {
        steps += *carry;
    }
    if (!wh_believable(steps, WH_PHASE_STEP_MAX)) {
        return false;
    }
    const int32_t whole = wh_whole(steps);
    if (compensated) {
        *carry = steps - (float)whole;
    }
    /* turns beyond 2^31 wrap like the phase, and are no undefined behaviour */
    *angle = (wh_angle)((uint64_t)*angle + (uint64_t)(int64_t)whole);
#endif
    return true;
}

/* Whoever defines this is told what rounding took from the step of turn angle i, h long, in units: the interpreter
 * (host/run/loss.inc). Nothing else does, and then nothing is left of it. */
#ifndef WH_ANGLE_LOST
#define WH_ANGLE_LOST(i, h, lost) ((void)0)
#endif

/* Refuse the step: component `fault` left all bounds. */
WH_INLINE wh_status wh_refuse(wh_state *state, unsigned fault) {
    state->fault = (int)fault;
    return WH_E_DIVERGED;
}

/* Where a step's results wait until the whole step is known to be sound. */
typedef struct wh_trial {
    wh_angle angle[WH_COORDS];
    wh_real real[2 * WH_COORDS];
    wh_real carry[2 * WH_COORDS];
} wh_trial;

/* Take the trial over into the state. */
WH_INLINE void wh_commit(const wh_trial *trial, unsigned angles, unsigned reals, bool compensated,
                         wh_state *state) {
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        state->angle[i] = trial->angle[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        state->real[i] = trial->real[i];
    }
    if (compensated) {
        WH_UNROLL
        for (unsigned i = 0; i < angles + reals; i++) {
            state->carry[i] = trial->carry[i];
        }
    }
}

/* Where an angle stands at a stage, in the middle of a step or at its end, that moves it by `steps`. */
WH_INLINE bool wh_stage_angle(wh_angle angle, wh_real steps, bool middle, wh_phase *phase) {
    return middle ? wh_phase_move_half(wh_phase_of(angle), steps, phase)
                  : wh_phase_move(wh_phase_of(angle), steps, phase);
}

/* One step of q'' = f(q, q', u). angles <= n <= WH_COORDS. Returns WH_OK, or WH_E_DIVERGED with
 * state->fault set and the rest of the state as it was. */
WH_INLINE wh_status wh_step_second(const void *model, wh_accel_fn *accel, wh_method method,
                                   bool compensated, unsigned angles, unsigned n, wh_real h,
                                   wh_state *state) {
    const unsigned linears = n - angles;
    const wh_angle *angle = state->angle;
    const wh_real *linear = state->real;
    const wh_real *rate = state->real + linears;
    const wh_real *u = state->input;
    const wh_real unit = WH_PHASE_PER_RAD; /* phase units a radian */
    const wh_real half = WH_R(0.5) * h;

    /* zeroed for the compiler, which cannot know that no scene uses what it did not fill */
    wh_phase phase[WH_COORDS] = {0};
    wh_real at[WH_COORDS] = {0}; /* linear positions of a stage */
    wh_real v[WH_COORDS] = {0};  /* rates of a stage */
    wh_real v_before[WH_COORDS] = {0};
    wh_real a[WH_COORDS];
    wh_real a1[WH_COORDS];
    wh_real a_sum[WH_COORDS];
    wh_real move[WH_COORDS] = {0}; /* mean rate that moves the position over this step */
    wh_real kick[WH_COORDS] = {0}; /* change of the rate over this step */
    wh_trial trial = {0};

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        phase[i] = wh_phase_of(angle[i]);
    }
    accel(model, phase, linear, rate, u, a1);

    if (method == WH_EULER) {
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            move[i] = rate[i];
            kick[i] = h * a1[i];
        }
    } else if (method == WH_SEMI_IMPLICIT_EULER) {
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            kick[i] = h * a1[i];
            move[i] = rate[i] + kick[i];
        }
    } else if (method == WH_HEUN) {
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            v[i] = rate[i] + h * a1[i];
        }
        WH_UNROLL
        for (unsigned i = 0; i < angles; i++) {
            if (!wh_stage_angle(angle[i], rate[i] * (h * unit), false, &phase[i])) {
                return wh_refuse(state, i);
            }
        }
        WH_UNROLL
        for (unsigned i = 0; i < linears; i++) {
            at[i] = linear[i] + h * rate[angles + i];
        }
        accel(model, phase, at, v, u, a);
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            move[i] = rate[i] + half * a1[i];
            kick[i] = half * (a1[i] + a[i]);
        }
    } else {
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            v[i] = rate[i] + half * a1[i];
            a_sum[i] = WH_R(0.0);
            a[i] = a1[i];
            v_before[i] = rate[i];
        }
        WH_UNROLL
        for (unsigned stage = 2; stage <= 4; stage++) {
            const wh_real span = stage == 4 ? h : half;
            if (stage > 2) {
                WH_UNROLL
                for (unsigned i = 0; i < n; i++) {
                    v_before[i] = v[i];
                    v[i] = rate[i] + span * a[i];
                }
            }
            WH_UNROLL
            for (unsigned i = 0; i < angles; i++) {
                if (!wh_stage_angle(angle[i], v_before[i] * (h * unit), stage != 4, &phase[i])) {
                    return wh_refuse(state, i);
                }
            }
            WH_UNROLL
            for (unsigned i = 0; i < linears; i++) {
                at[i] = linear[i] + span * v_before[angles + i];
            }
            accel(model, phase, at, v, u, a);
            if (stage < 4) {
                WH_UNROLL
                for (unsigned i = 0; i < n; i++) {
                    a_sum[i] = stage == 2 ? a[i] : a_sum[i] + a[i];
                }
            }
        }
        const wh_real sixth = h / WH_R(6.0);
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            const wh_real first_three = a1[i] + a_sum[i];
            move[i] = rate[i] + sixth * first_three;
            kick[i] = sixth * (first_three + (a_sum[i] + a[i]));
        }
    }

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        trial.angle[i] = angle[i];
        trial.carry[i] = compensated ? state->carry[i] : WH_R(0.0);
        const wh_real turn = move[i] * (h * unit);
        if (!wh_angle_move(&trial.angle[i], turn, compensated, &trial.carry[i])) {
            return wh_refuse(state, i);
        }
        WH_ANGLE_LOST(i, h, turn - (wh_real)(trial.angle[i] - angle[i]));
    }
    WH_UNROLL
    for (unsigned i = 0; i < linears; i++) {
        wh_real *carry = &trial.carry[angles + i];
        *carry = compensated ? state->carry[angles + i] : WH_R(0.0);
        trial.real[i] = wh_sum(linear[i], h * move[angles + i], compensated, carry);
        if (!wh_believable(trial.real[i], WH_ABSURD)) {
            return wh_refuse(state, angles + i);
        }
    }
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        wh_real *carry = &trial.carry[n + i];
        *carry = compensated ? state->carry[n + i] : WH_R(0.0);
        trial.real[linears + i] = wh_sum(rate[i], kick[i], compensated, carry);
        if (!wh_believable(trial.real[linears + i], WH_ABSURD)) {
            return wh_refuse(state, n + i);
        }
    }
    wh_commit(&trial, angles, linears + n, compensated, state);
    return WH_OK;
}

/* The state of a stage of a first-order system: start + h * slope, or half of that in the middle. False when
 * h * slope would move an angle by half a turn or more; *fault is then its number. */
WH_INLINE bool wh_stage_first(const wh_state *state, unsigned angles, unsigned reals, wh_real h,
                              bool middle, const wh_real *slope, wh_phase *phase, wh_real *real,
                              unsigned *fault) {
    const wh_real span = middle ? WH_R(0.5) * h : h;
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        if (!wh_stage_angle(state->angle[i], slope[i] * (h * WH_PHASE_PER_RAD), middle,
                            &phase[i])) {
            *fault = i;
            return false;
        }
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        real[i] = state->real[i] + span * slope[angles + i];
    }
    return true;
}

/* One step of x' = f(x, u) with `angles` turn angles and `reals` reals, angles + reals <= WH_COORDS.
 * The classic Runge-Kutta method, Heun's, or Euler's. Semi-implicit Euler moves rates before positions, and
 * here is no telling them apart: WH_E_ARGUMENT, with the state as it was. Else returns as wh_step_second(). */
WH_INLINE wh_status wh_step_first(const void *model, wh_slope_fn *slope, wh_method method,
                                  bool compensated, unsigned angles, unsigned reals, wh_real h,
                                  wh_state *state) {
    const unsigned n = angles + reals;
    const wh_real *u = state->input;
    const wh_real half = WH_R(0.5) * h;
    wh_phase phase[WH_COORDS] = {0}; /* zeroed for the compiler: a scene may have no angle */
    wh_real at[WH_COORDS] = {0};
    wh_real k1[WH_COORDS];
    wh_real k[WH_COORDS];
    wh_real sum[WH_COORDS];
    wh_real move[WH_COORDS];
    unsigned fault = 0;
    wh_trial trial;

    if (method == WH_SEMI_IMPLICIT_EULER) {
        return WH_E_ARGUMENT;
    }
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        phase[i] = wh_phase_of(state->angle[i]);
    }
    slope(model, phase, state->real, u, k1);
    if (method == WH_HEUN) {
        if (!wh_stage_first(state, angles, reals, h, false, k1, phase, at, &fault)) {
            return wh_refuse(state, fault);
        }
        slope(model, phase, at, u, k);
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            move[i] = half * (k1[i] + k[i]);
        }
    } else if (method == WH_RK4) {
        if (!wh_stage_first(state, angles, reals, h, true, k1, phase, at, &fault)) {
            return wh_refuse(state, fault);
        }
        slope(model, phase, at, u, k);
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            sum[i] = k[i];
        }
        if (!wh_stage_first(state, angles, reals, h, true, k, phase, at, &fault)) {
            return wh_refuse(state, fault);
        }
        slope(model, phase, at, u, k);
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            sum[i] = sum[i] + k[i];
        }
        if (!wh_stage_first(state, angles, reals, h, false, k, phase, at, &fault)) {
            return wh_refuse(state, fault);
        }
        slope(model, phase, at, u, k);
        const wh_real sixth = h / WH_R(6.0);
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            move[i] = sixth * (k1[i] + (sum[i] + sum[i]) + k[i]);
        }
    } else {
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            move[i] = h * k1[i];
        }
    }

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        trial.angle[i] = state->angle[i];
        trial.carry[i] = compensated ? state->carry[i] : WH_R(0.0);
        const wh_real turn = move[i] * WH_PHASE_PER_RAD;
        if (!wh_angle_move(&trial.angle[i], turn, compensated, &trial.carry[i])) {
            return wh_refuse(state, i);
        }
        WH_ANGLE_LOST(i, h, turn - (wh_real)(trial.angle[i] - state->angle[i]));
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        wh_real *carry = &trial.carry[angles + i];
        *carry = compensated ? state->carry[angles + i] : WH_R(0.0);
        trial.real[i] = wh_sum(state->real[i], move[angles + i], compensated, carry);
        if (!wh_believable(trial.real[i], WH_ABSURD)) {
            return wh_refuse(state, angles + i);
        }
    }
    wh_commit(&trial, angles, reals, compensated, state);
    return WH_OK;
}

#endif
