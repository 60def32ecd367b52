/* step.h: the fixed-step integrators, one readable inline source.
 *
 * A generated scene and the host's interpreter both include this file. In a generated scene the
 * counts, the method and `compensated` are constants and the right-hand side is inlined, so the
 * compiler unrolls the loops and drops whatever the scene does not call for; the order of the
 * floating-point operations, and so every bit of the result, is the same in both. Neither is C++: what
 * embeds a scene includes scene.h and the generated header.
 *
 * One loop over a method's row (method.h) steps all of them; where the row is constant, the compiler unrolls it.
 *
 * For q'' = f(q, q', u) the position stages are written out, which gives the same method's numbers on the first-order
 * form to rounding, with fewer operations (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I,
 * section II.14). Of the classic method:
 *
 *     v2 = v + h/2 a1          q2 = q + h/2 v          a2 = f(q2, v2)
 *     v3 = v + h/2 a2          q3 = q + h/2 v2         a3 = f(q3, v3)
 *     v4 = v + h a3            q4 = q + h v3           a4 = f(q4, v4)
 *     q+ = q + h (v + h/6 (a1 + (a2 + a3)))
 *     v+ = v + h/6 ((a1 + (a2 + a3)) + ((a2 + a3) + a4))
 */
#ifndef WH_STEP_H
#define WH_STEP_H

#ifdef __cplusplus
#error \
    "core/step.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

#include "arithmetic.h"
#include "root.h"
#include "scene.h"
#include "sum.h"

/* Most coordinates (second order) or components (first order). A generated scene defines its own
 * and has its loops unrolled: by itself no compiler does, and arrays indexed by a counter stay in memory. */
#ifndef WH_COORDS
#define WH_COORDS 64
#define WH_UNROLL
#endif
#ifdef WH_UNROLL /* as it is */
#elif defined(__clang__)
#define WH_UNROLL _Pragma("clang loop unroll(full)")
#pragma clang diagnostic ignored "-Wpass-failed" /* loops whose bound is no constant stay loops */
#elif defined(__GNUC__) && __GNUC__ >= 8         /* which older ones do not know */
#define WH_UNROLL _Pragma("GCC unroll 64")
#else
#define WH_UNROLL
#endif

/* gcc would sink what a stage computes below the checks of the next one, where more of it has to be kept: up to 8 %
 * more instructions a step; and load, beside each check, the number that a refused step is blamed with: up to 3 %; and call
 * memcpy() for a loop over one or two values. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-sink", "no-if-conversion2", "no-tree-loop-distribute-patterns")
#endif

/* A long list is written in an order with few values live at a time. Where there are registers for that, gcc would put
 * its operations where their results come soonest and their operands stand, before it gives them registers: for ten links
 * of a pendulum 14 % more instructions a step on a Cortex-M4F, a third more code on an RV32IMAFC or an AArch64. (Short
 * lists fit into registers and have cycles to gain by it.) */
#if defined(WH_LONG_LIST) && defined(__GNUC__) && !defined(__clang__) && \
    (defined(__ARM_FP) || defined(__aarch64__) || defined(__riscv_flen))
#pragma GCC optimize("no-schedule-insns", "no-tree-ter")
#endif

/* A linear position or a rate beyond this is no mechanism's: the step is refused. */
#define WH_ABSURD WH_R(1e15)

/* Derivatives of a first-order system: slope[angles + reals], angles first (rad/s). */
typedef void wh_slope_fn(const void *model, const wh_phase *phase, const wh_real *real,
                         const wh_real *input, wh_real *slope);

/* True for finite numbers of a believable size; false for NaN. */
WH_INLINE bool wh_believable(wh_real value, wh_real limit) { return WH_ABS(value) < limit; }

/* The first of value[n] that is none, or n. Seldom is there one: first all are asked at once, by the sum of their sizes,
 * which is not below any of them. */
WH_INLINE unsigned wh_first_absurd(const wh_real *value, unsigned n) {
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        all = i == 0 ? WH_ABS(value[i]) : all + WH_ABS(value[i]);
    }
    if (all < WH_ABSURD) {
        return n;
    }
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        if (!wh_believable(value[i], WH_ABSURD)) {
            return i;
        }
    }
    return n;
}

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

/* Where an angle stands at a stage whose shares of the rates have `sum`. In the middle of a step it goes half of
 * where the whole step leads. False as wh_phase_move(). */
WH_INLINE bool wh_stage_angle(wh_angle angle, wh_real sum, wh_real h, wh_real parts,
                              wh_phase *phase) {
    return parts == WH_R(2.0)
               ? wh_phase_move_half(wh_phase_of(angle), sum * (h * WH_PHASE_PER_RAD), phase)
               : wh_phase_move(wh_phase_of(angle), sum * (h / parts * WH_PHASE_PER_RAD), phase);
}

/* What the stages gave: of the first, and of the others. */
typedef struct wh_given {
    const wh_real *first;
    wh_real (*next)[WH_COORDS];
} wh_given;

/* sum_j share[j] * component i of stage j, stages in order. */
WH_INLINE wh_real wh_stage_sum(const wh_real *share, unsigned stage, wh_given given, unsigned i) {
    wh_real sum = WH_R(0.0);
    bool any = false;
    WH_UNROLL
    for (unsigned j = 0; j < WH_STAGES_MAX; j++) {
        if (j < stage && share[j] != WH_R(0.0)) {
            const wh_real one = share[j] * (j == 0 ? given.first[i] : given.next[j - 1][i]);
            sum = any ? sum + one : one;
            any = true;
        }
    }
    return sum;
}

/* Do a stage and the one before it count alike at the step's end? Those are added up first: a sum instead of a
 * product each, and it may serve positions and rates. Where there are no positions, the rates decide. */
WH_INLINE bool wh_stages_alike(const wh_tableau *by, unsigned stage, bool has_positions) {
    return stage < WH_STAGES_MAX && stage < by->stages &&
           by->rates[stage] == by->rates[stage - 1] &&
           (!has_positions || by->positions[stage] == by->positions[stage - 1]);
}

/* Stage `stage` gave `now`: kept in given[], and in the sums of those that count alike. */
WH_INLINE void wh_stage_given(const wh_tableau *by, unsigned stage, bool has_positions, unsigned n,
                              const wh_real *first, const wh_real *now, wh_real (*given)[WH_COORDS],
                              wh_real (*alike)[WH_COORDS]) {
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        given[stage - 1][i] = now[i];
        alike[stage - 1][i] = !wh_stages_alike(by, stage, has_positions)
                                  ? now[i]
                                  : (stage == 1 ? first[i] : alike[stage - 2][i]) + now[i];
    }
}

/* sum += share * more, and the first one is the sum. */
WH_INLINE void wh_total_add(wh_real *sum, bool *any, wh_real share, wh_real more) {
    if (share != WH_R(0.0)) {
        *sum = *any ? *sum + share * more : share * more;
        *any = true;
    }
}

/* The end of a step of q'' = f: what the stages gave, a1 and the sums of those that count alike, moves the state.
 * Returns as wh_step_second(). */
WH_INLINE wh_status wh_second_end(const wh_tableau *by, const wh_real *a1,
                                  wh_real (*alike)[WH_COORDS], bool compensated, unsigned angles,
                                  unsigned n, wh_real h, wh_state *state) {
    const unsigned linears = n - angles;
    const wh_angle *angle = state->angle;
    const wh_real *linear = state->real;
    const wh_real *rate = state->real + linears;
    /* zeroed for the compiler, which cannot know that no scene uses what it did not fill */
    wh_real move[WH_COORDS] = {0}; /* mean rate that moves the position over this step */
    wh_real kick[WH_COORDS] = {0}; /* change of the rate over this step */
    wh_trial trial = {0};

    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        wh_real moved = WH_R(0.0);
        wh_real rest = WH_R(0.0);
        bool any_moved = false;
        bool any_rest = false;
        WH_UNROLL
        for (unsigned s = 0; s < by->stages; s++) {
            if (!wh_stages_alike(by, s + 1, true)) {
                const wh_real more = s == 0 ? a1[i] : alike[s - 1][i];
                wh_total_add(&moved, &any_moved, by->positions[s], more);
                wh_total_add(&rest, &any_rest, by->rates[s] - by->positions[s], more);
            }
        }
        move[i] = any_moved ? rate[i] + h / by->parts * moved : rate[i];
        kick[i] = h / by->parts * (any_moved && any_rest ? moved + rest : any_moved ? moved : rest);
    }

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        trial.angle[i] = angle[i];
        trial.carry[i] = compensated ? state->carry[i] : WH_R(0.0);
        const wh_real turn = move[i] * (h * WH_PHASE_PER_RAD);
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
    }
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        wh_real *carry = &trial.carry[n + i];
        *carry = compensated ? state->carry[n + i] : WH_R(0.0);
        trial.real[linears + i] = wh_sum(rate[i], kick[i], compensated, carry);
    }
    const unsigned absurd = wh_first_absurd(trial.real, linears + n);
    if (absurd < linears + n) {
        return wh_refuse(state, angles + absurd);
    }
    wh_commit(&trial, angles, linears + n, compensated, state);
    return WH_OK;
}

/* The end of a step of x' = f, likewise. */
WH_INLINE wh_status wh_first_end(const wh_tableau *by, const wh_real *k1,
                                 wh_real (*alike)[WH_COORDS], bool compensated, unsigned angles,
                                 unsigned reals, wh_real h, wh_state *state) {
    const unsigned n = angles + reals;
    wh_real move[WH_COORDS];
    wh_trial trial;

    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        wh_real total = WH_R(0.0);
        bool any = false;
        WH_UNROLL
        for (unsigned s = 0; s < by->stages; s++) {
            if (!wh_stages_alike(by, s + 1, false)) {
                wh_total_add(&total, &any, by->rates[s], s == 0 ? k1[i] : alike[s - 1][i]);
            }
        }
        move[i] = h / by->parts * total;
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
    }
    const unsigned absurd = wh_first_absurd(trial.real, reals);
    if (absurd < reals) {
        return wh_refuse(state, angles + absurd);
    }
    wh_commit(&trial, angles, reals, compensated, state);
    return WH_OK;
}

/* One step of q'' = f(q, q', u). angles <= n <= WH_COORDS. Returns WH_OK, or WH_E_DIVERGED with
 * state->fault set and the rest of the state as it was. */
WH_INLINE wh_status wh_step_second(const void *model, wh_accel_fn *accel, wh_method method,
                                   bool compensated, unsigned angles, unsigned n, wh_real h,
                                   wh_state *state) {
    const wh_tableau *by = wh_tableau_of(method);
    const unsigned linears = n - angles;
    const wh_angle *angle = state->angle;
    const wh_real *linear = state->real;
    const wh_real *rate = state->real + linears;
    const wh_real *u = state->input;

    /* zeroed for the compiler, which cannot know that no scene uses what it did not fill */
    wh_phase phase[WH_COORDS] = {0};
    wh_real at[WH_COORDS] = {0};             /* linear positions of a stage, */
    wh_real v[WH_COORDS] = {0};              /* its rates */
    wh_real a[WH_COORDS];                    /* and its accelerations, */
    wh_real a1[WH_COORDS];                   /* those of the first one */
    wh_real rates[WH_STAGES_MAX][WH_COORDS]; /* and of all others */
    wh_real accels[WH_STAGES_MAX][WH_COORDS];
    wh_real alike[WH_STAGES_MAX][WH_COORDS] = {{0}}; /* sums of those that count alike */
    const wh_given all_rates = {rate, rates};
    const wh_given all_accels = {a1, accels};

    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        phase[i] = wh_phase_of(angle[i]);
    }
    accel(model, phase, linear, rate, u, a1);
    WH_UNROLL
    for (unsigned s = 1; s < WH_STAGES_MAX; s++) { /* with this bound gcc has fewer to spill */
        if (s >= by->stages) {
            break;
        }
        const wh_real *share = by->stage[s].share;
        const wh_real parts = by->stage[s].parts;
        WH_UNROLL
        for (unsigned i = 0; i < n; i++) {
            v[i] = rate[i] + h / parts * wh_stage_sum(share, s, all_accels, i);
            rates[s - 1][i] = v[i];
        }
        WH_UNROLL
        for (unsigned i = 0; i < linears; i++) {
            at[i] = linear[i] + h / parts * wh_stage_sum(share, s, all_rates, angles + i);
        }
        WH_UNROLL
        for (unsigned i = 0; i < angles; i++) {
            if (!wh_stage_angle(angle[i], wh_stage_sum(share, s, all_rates, i), h, parts,
                                &phase[i])) {
                return wh_refuse(state, i);
            }
        }
        accel(model, phase, at, v, u, a);
        wh_stage_given(by, s, true, n, a1, a, accels, alike);
    }
    return wh_second_end(by, a1, alike, compensated, angles, n, h, state);
}

/* One step of x' = f(x, u) with `angles` turn angles and `reals` reals, angles + reals <= WH_COORDS. A method that
 * does not take such a system, semi-implicit Euler: it moves rates before positions, and here is no telling them
 * apart: WH_E_ARGUMENT, with the state as it was. Else returns as wh_step_second(). */
WH_INLINE wh_status wh_step_first(const void *model, wh_slope_fn *slope, wh_method method,
                                  bool compensated, unsigned angles, unsigned reals, wh_real h,
                                  wh_state *state) {
    const wh_tableau *by = wh_tableau_of(method);
    const unsigned n = angles + reals;
    const wh_real *u = state->input;
    wh_phase phase[WH_COORDS] = {0}; /* zeroed for the compiler: a scene may have no angle */
    wh_real at[WH_COORDS] = {0};
    wh_real k1[WH_COORDS];                           /* derivatives of the first stage */
    wh_real k[WH_COORDS];                            /* of the present one */
    wh_real slopes[WH_STAGES_MAX][WH_COORDS];        /* those of all but the first */
    wh_real alike[WH_STAGES_MAX][WH_COORDS] = {{0}}; /* sums of those that count alike */
    const wh_given all = {k1, slopes};

    if (!wh_method_takes(method, WH_FIRST_ORDER)) {
        return WH_E_ARGUMENT;
    }
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        phase[i] = wh_phase_of(state->angle[i]);
    }
    slope(model, phase, state->real, u, k1);
    WH_UNROLL
    for (unsigned s = 1; s < WH_STAGES_MAX; s++) {
        if (s >= by->stages) {
            break;
        }
        const wh_real *share = by->stage[s].share;
        const wh_real parts = by->stage[s].parts;
        WH_UNROLL
        for (unsigned i = 0; i < angles; i++) {
            if (!wh_stage_angle(state->angle[i], wh_stage_sum(share, s, all, i), h, parts,
                                &phase[i])) {
                return wh_refuse(state, i);
            }
        }
        WH_UNROLL
        for (unsigned i = 0; i < reals; i++) {
            at[i] = state->real[i] + h / parts * wh_stage_sum(share, s, all, angles + i);
        }
        slope(model, phase, at, u, k);
        wh_stage_given(by, s, false, n, k1, k, slopes, alike);
    }
    return wh_first_end(by, k1, alike, compensated, angles, reals, h, state);
}

#endif
