/* step_end.h: the end of a step: what its stages gave moves the state, unless that leaves all bounds. Part of step.h. */
#ifndef WH_STEP_END_H
#define WH_STEP_END_H

#ifdef __cplusplus
#error \
    "core/step_end.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

#include "refuse.h"
#include "scene.h"
#include "span.h"
#include "stage_sums.h"
#include "sum.h"

/* *angle moved on by `steps` phase units, less than WH_PHASE_STEP_MAX in size, rounded to the nearest: dropping the
 * fraction would slow every angle down by half a unit a step. Compensated, *carry goes in and is what is rounded away;
 * by itself, for beside a large step nothing of it would be left. */
WH_INLINE void wh_angle_move(wh_angle *angle, wh_real steps, bool compensated, wh_real *carry) {
#if WH_DOUBLE
    *angle = wh_sum(*angle, steps, compensated, carry);
#else
    int32_t whole = wh_whole(steps);
    if (compensated) {
        const float left = (steps - (float)whole) + *carry;
        const int32_t more = wh_whole(left);
        *carry = left - (float)more;
        whole += more; /* no overflow: `steps` is whole where it is large */
    }
    /* turns beyond 2^31 wrap like the phase, and are no undefined behaviour */
    *angle = (wh_angle)((uint64_t)*angle + (uint64_t)(int64_t)whole);
#endif
}

/* Whoever defines this is told what rounding took from the step of turn angle i, h long, in units: the interpreter
 * (host/run/loss.inc). Nothing else does, and then nothing is left of it. */
#ifndef WH_ANGLE_LOST
#define WH_ANGLE_LOST(i, h, lost) ((void)0)
#endif

/* Is value[n] a mechanism's? All are asked at once, by the sum of their sizes, which is not below any of them. */
WH_INLINE bool wh_all_believable(const wh_real *value, unsigned n) {
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        all = i == 0 ? WH_ABS(value[i]) : all + WH_ABS(value[i]);
    }
    return n == 0 || all < WH_ABSURD;
}

/* Refuse the step for value[n], the components from `first` on, which are not all believable: the first that by itself
 * is not is blamed, or else the last. */
WH_INLINE wh_status wh_refuse_first(const wh_real *value, unsigned n, unsigned first,
                                    wh_state *state) {
    WH_UNROLL
    for (unsigned i = 0; i + 1 < n; i++) {
        if (!wh_believable(value[i], WH_ABSURD)) {
            return wh_refuse(state, first + i);
        }
    }
    return wh_refuse(state, first + n - 1);
}

/* wh_refuse_first(), with as little flash as may be. */
WH_INLINE wh_status wh_refuse_among(const wh_real *value, unsigned n, unsigned first,
                                    wh_state *state) {
    if (WH_REALS_IN_REGISTERS && n > 1 && n <= 4) {
        return wh_refuse_four(state, first, n, value[0], value[1], value[n > 2 ? 2 : 1],
                              value[n - 1]);
    }
    if (WH_REALS_IN_REGISTERS && n > 4 && n <= 8) {
        return wh_refuse_eight(state, first, n, value[0], value[1], value[2], value[3], value[4],
                               value[n > 5 ? 5 : 4], value[n > 6 ? 6 : n - 1], value[n - 1]);
    }
    return wh_refuse_first(value, n, first, state);
}

/* Refuse the step where `far`, an angle that was to move by half a turn or more, is one. */
#define WH_REFUSE_FAR(far) \
    do { \
        const unsigned far_angle = (far); \
        if (far_angle < angles) { \
            return wh_refuse(state, far_angle); \
        } \
    } while (false)

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

/* Take a sound trial over, or refuse the step. */
WH_INLINE wh_status wh_accept(const wh_trial *trial, unsigned angles, unsigned reals,
                              bool compensated, wh_state *state) {
    if (!wh_all_believable(trial->real, reals)) {
        return wh_refuse_among(trial->real, reals, angles, state);
    }
    wh_commit(trial, angles, reals, compensated, state);
    return WH_OK;
}

/* Count a step that was done. */
WH_INLINE wh_status wh_step_counted(wh_status status, wh_state *state) {
    if (status == WH_OK) {
        state->steps++;
    }
    return status;
}

/* trial->carry[count] as a step begins: what the last one's sums left, where they are compensated. */
WH_INLINE void wh_carry_begin(const wh_state *state, bool compensated, unsigned count,
                              wh_trial *trial) {
    WH_UNROLL
    for (unsigned i = 0; i < count; i++) {
        trial->carry[i] = compensated ? state->carry[i] : WH_R(0.0);
    }
}

/* trial->angle[] of this step, h long: the state's, each moved on by move[] times rad_a_move; trial->carry[], where sums
 * are compensated, goes in and is what is left. The first angle that was to move by half a turn or more, or by NaN, or
 * `angles`. Seldom is there one: first all are asked at once, by the sum of their sizes. */
WH_INLINE unsigned wh_angles_move(const wh_real *move, wh_span rad_a_move, wh_real h,
                                  bool compensated, unsigned angles, const wh_state *state,
                                  wh_trial *trial) {
    const wh_span per_rad = {WH_PHASE_PER_RAD, WH_PHASE_PER_RAD_REST};
    const wh_span phases = wh_span_times(rad_a_move, per_rad);
    wh_real steps[WH_COORDS];
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        trial->angle[i] = state->angle[i];
        steps[i] = move[i] * phases.s;
        if (compensated && !WH_DOUBLE) {
            trial->carry[i] += move[i] * phases.rest_s;
        }
        all = i == 0 ? WH_ABS(steps[i]) : all + WH_ABS(steps[i]);
    }
    if (WH_SELDOM(angles > 0 && !(all < WH_PHASE_STEP_MAX))) {
        WH_UNROLL
        for (unsigned i = 0; i < angles; i++) {
            if (!wh_believable(steps[i], WH_PHASE_STEP_MAX)) {
                return i;
            }
        }
    }
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        wh_angle_move(&trial->angle[i], steps[i], compensated, &trial->carry[i]);
        WH_ANGLE_LOST(i, h, steps[i] - (wh_real)(trial->angle[i] - state->angle[i]));
    }
    (void)h;
    return angles;
}

/* value + by factor, as wh_sum(); product is by.s factor, `h` the step. What the rest of `by` adds is less than half a unit
 * in the last place of the product: in one sum with it, it would be rounded away in every step. So what the state did not
 * take is told from the product alone, and the carry, which is small, keeps the rest. Not where the step has no rest:
 * those of contacts, whose carry is to be zero where nothing moves. */
WH_INLINE wh_real wh_sum_product(wh_real value, wh_span by, wh_real factor, wh_real product,
                                 wh_span h, bool compensated, wh_real *carry) {
    if (!compensated || WH_DOUBLE) {
        return wh_sum(value, product, compensated, carry);
    }
    const wh_real kept = *carry + by.rest_s * factor;
    if (h.rest_s == WH_R(0.0)) {
        *carry = kept;
        return wh_sum(value, product, true, carry);
    }
    const wh_real sum = value + (product + kept);
    *carry = kept + (product - (sum - value));
    return sum;
}

/* What h^2 over the row's parts is short of, in s^2, as two roundings and the stages leave it: a sum of accelerations is
 * to be taken by it once more where it moves positions. Stages go by h.s, whose rest would be rounded away there. So they
 * stand short of where they should by a part e of their way, which changes the rates as if h/2 e times the forces' change
 * were missing, and the energy in every step by as much, always the same way: 5e-13 of a pendulum's in a millisecond.
 * Where the positions lack the part e of h^2/2 times the accelerations, too, both together are the derivative of what
 * stays small, and the energy stays, where the mass matrix is constant; where it is not, most of it (docs/dev/numerics.md). A
 * row of one stage where the step begins has none that stands elsewhere. */
WH_INLINE wh_real wh_square_short(const wh_tableau *by, wh_span h, wh_span part) {
    const wh_real stages = wh_all_begin(by) ? WH_R(0.0) : h.rest_s / by->parts;
    return h.s * (part.rest_s + stages);
}

/* The same of angles, in phase units times s^2. Stages that turn sines on (stage_turn.h) go by h.s alone, others by its
 * product with WH_PHASE_PER_RAD, rounded, or by one after the other. */
WH_INLINE wh_real wh_turn_short(const wh_tableau *by, wh_span h, wh_span part, bool turned) {
    const wh_span per_rad = {WH_PHASE_PER_RAD, WH_PHASE_PER_RAD_REST};
    const wh_span phases = wh_span_times(h, per_rad);
    if (turned || wh_all_begin(by)) {
        return WH_PHASE_PER_RAD * wh_square_short(by, h, part);
    }
    if (wh_stage_reaches(by)) {
        return WH_PHASE_PER_RAD * wh_square_short(by, h, part) +
               h.s * part.s * WH_PHASE_PER_RAD_REST;
    }
    return phases.s * part.rest_s + part.s * phases.rest_s; /* wh_stage_angle() */
}

/* What positions lack of this step, into their carries, pulled[] being the sums of accelerations that move them. Not where
 * the step has no rest, as in wh_sum_product(); but a turn has one. */
WH_INLINE void wh_carry_positions(const wh_tableau *by, const wh_real *pulled, wh_span part,
                                  wh_span h, bool turned, unsigned angles, unsigned linears,
                                  wh_trial *trial) {
    WH_UNROLL
    for (unsigned i = 0; i < angles + linears; i++) {
        if (!WH_DOUBLE && i < angles) {
            trial->carry[i] += pulled[i] * wh_turn_short(by, h, part, turned);
        } else if (!WH_DOUBLE && h.rest_s != WH_R(0.0)) {
            trial->carry[i] += pulled[i] * wh_square_short(by, h, part);
        }
    }
}

/* The end of a step of q'' = f: what the stages gave, a1 and the sums of those that count alike, moves the state. `turned`:
 * they turned sines on. Returns as wh_step_second(). */
WH_INLINE wh_status wh_second_end(const wh_tableau *by, const wh_real *a1,
                                  wh_real (*alike)[WH_COORDS], bool turned, bool compensated,
                                  unsigned angles, unsigned n, wh_span h, wh_state *state) {
    const wh_span part = wh_span_over(h, by->parts);
    const unsigned linears = n - angles;
    const wh_real *linear = state->real;
    const wh_real *rate = state->real + linears;
    wh_real move[WH_COORDS];   /* mean rate that moves the position over this step */
    wh_real gain[WH_COORDS];   /* sum of the accelerations over its parts */
    wh_real kick[WH_COORDS];   /* change of the rate over this step */
    wh_real pulled[WH_COORDS]; /* sum of the accelerations that moves the position */
    wh_trial trial;

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
        move[i] = any_moved ? rate[i] + part.s * moved : rate[i];
        gain[i] = any_moved && any_rest ? moved + rest : any_moved ? moved : rest;
        kick[i] = part.s * gain[i];
        pulled[i] = moved;
    }

    wh_carry_begin(state, compensated, angles + linears, &trial);
    if (compensated) {
        wh_carry_positions(by, pulled, part, h, turned, angles, linears, &trial);
    }
    WH_REFUSE_FAR(wh_angles_move(move, h, h.s, compensated, angles, state, &trial));
    WH_UNROLL
    for (unsigned i = 0; i < linears; i++) {
        wh_real *carry = &trial.carry[angles + i];
        trial.real[i] = wh_sum_product(linear[i], h, move[angles + i], h.s * move[angles + i], h,
                                       compensated, carry);
    }
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        wh_real *carry = &trial.carry[n + i];
        *carry = compensated ? state->carry[n + i] : WH_R(0.0);
        trial.real[linears + i] =
            wh_sum_product(rate[i], part, gain[i], kick[i], h, compensated, carry);
    }
    return wh_accept(&trial, angles, linears + n, compensated, state);
}

/* The end of a step of x' = f, likewise. */
WH_INLINE wh_status wh_first_end(const wh_tableau *by, const wh_real *k1,
                                 wh_real (*alike)[WH_COORDS], bool compensated, unsigned angles,
                                 unsigned reals, wh_span h, wh_state *state) {
    const wh_span part = wh_span_over(h, by->parts);
    const unsigned n = angles + reals;
    wh_real total[WH_COORDS];
    wh_trial trial;

    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        bool any = false;
        total[i] = WH_R(0.0);
        WH_UNROLL
        for (unsigned s = 0; s < by->stages; s++) {
            if (!wh_stages_alike(by, s + 1, false)) {
                wh_total_add(&total[i], &any, by->rates[s], s == 0 ? k1[i] : alike[s - 1][i]);
            }
        }
    }

    wh_carry_begin(state, compensated, angles, &trial);
    WH_REFUSE_FAR(wh_angles_move(total, part, h.s, compensated, angles, state, &trial));
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        wh_real *carry = &trial.carry[angles + i];
        *carry = compensated ? state->carry[angles + i] : WH_R(0.0);
        trial.real[i] = wh_sum_product(state->real[i], part, total[angles + i],
                                       part.s * total[angles + i], h, compensated, carry);
    }
    return wh_accept(&trial, angles, reals, compensated, state);
}

#endif
