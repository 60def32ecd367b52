/* step_end.h: the end of a step: adds the stages' weighted sums to the state, or refuses the step. Part of step.h. */
#ifndef WH_STEP_END_H
#define WH_STEP_END_H

#include "../number/sum.h"
#include "../number/two_part.h"
#include "../scene.h"
#include "refuse.h"
#include "stage_sums.h"

/* Moves *angle by `steps` phase units, |steps| < WH_PHASE_STEP_MAX. Rounds to nearest, because truncation would slow
 * every angle down by half a unit per step. If compensated, also adds *carry, and sets *carry to the new round-off. */
WH_INLINE void wh_angle_move(wh_angle *angle, wh_real steps, bool compensated, wh_real *carry) {
#if WH_DOUBLE
    *angle = wh_sum(*angle, steps, compensated, carry);
#else
    int32_t whole = wh_whole(steps);
    if (compensated) {
        const float left = (steps - (float)whole) + *carry;
        const int32_t more = wh_whole(left);
        *carry = left - (float)more;
        whole += more;
    }
    /* A turn count beyond 2^31 wraps, without undefined behaviour. */
    *angle = (wh_angle)((uint64_t)*angle + (uint64_t)(int64_t)whole);
#endif
}

/* The interpreter redefines this. `lost` is the round-off in the move of angle i, in phase units. h is the step, s. */
#ifndef WH_ANGLE_LOST
#define WH_ANGLE_LOST(i, h, lost) ((void)0)
#endif

/* True if the sum of the magnitudes of value[n] is below WH_ABSURD. One comparison then bounds all n values. */
WH_INLINE bool wh_all_believable(const wh_real *value, unsigned n) {
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        all = i == 0 ? WH_ABS(value[i]) : all + WH_ABS(value[i]);
    }
    return n == 0 || all < WH_ABSURD;
}

/* Refuses the step, because the sum of the magnitudes of value[n] is too large. value[0] is component `first`. The
 * fault is the first component beyond the limit. If none is beyond it, the fault is the last component. */
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

/* wh_refuse_first() in the form that takes the least flash. */
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

/* Refuse the step if there is an angle `far` that would move by half a turn or more. */
#define WH_REFUSE_FAR(far) \
    do { \
        const unsigned far_angle = (far); \
        if (far_angle < angles) { \
            return wh_refuse(state, far_angle); \
        } \
    } while (false)

/* The results of a step, before their bounds are checked. */
typedef struct wh_trial {
    wh_angle angle[WH_COORDS];
    wh_real real[2 * WH_COORDS];
    wh_real carry[2 * WH_COORDS];
} wh_trial;

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

WH_INLINE wh_status wh_accept(const wh_trial *trial, unsigned angles, unsigned reals,
                              bool compensated, wh_state *state) {
    if (!wh_all_believable(trial->real, reals)) {
        return wh_refuse_among(trial->real, reals, angles, state);
    }
    wh_commit(trial, angles, reals, compensated, state);
    return WH_OK;
}

WH_INLINE wh_status wh_step_counted(wh_status status, wh_state *state) {
    if (status == WH_OK) {
        state->steps++;
    }
    return status;
}

/* Fills trial->carry[count]: with the carries of the last step if sums are compensated, otherwise with zeros. */
WH_INLINE void wh_carry_begin(const wh_state *state, bool compensated, unsigned count,
                              wh_trial *trial) {
    WH_UNROLL
    for (unsigned i = 0; i < count; i++) {
        trial->carry[i] = compensated ? state->carry[i] : WH_R(0.0);
    }
}

/* Sets trial->angle[i] to angle i plus move[i] * rad_a_move. If compensated, adds trial->carry[i], which
 * becomes the new round-off. Returns the index of the first angle whose move is NaN, or at least half a turn. If there
 * is no such angle, returns `angles`. */
WH_INLINE unsigned wh_angles_move(const wh_real *move, wh_two_part rad_a_move, wh_real h,
                                  bool compensated, unsigned angles, const wh_state *state,
                                  wh_trial *trial) {
    const wh_two_part per_rad = {WH_PHASE_PER_RAD, WH_PHASE_PER_RAD_REST};
    const wh_two_part phases = wh_two_part_times(rad_a_move, per_rad);
    wh_real steps[WH_COORDS];
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        trial->angle[i] = state->angle[i];
        steps[i] = move[i] * phases.high;
        if (compensated && !WH_DOUBLE) {
            trial->carry[i] += move[i] * phases.low;
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

/* Returns value + by * factor. `product` is by.high * factor, and `h` the step. If compensated, adds
 * *carry, which becomes the new round-off. */
WH_INLINE wh_real wh_sum_product(wh_real value, wh_two_part by, wh_real factor, wh_real product,
                                 wh_two_part h, bool compensated, wh_real *carry) {
    if (!compensated || WH_DOUBLE) {
        return wh_sum(value, product, compensated, carry);
    }
    const wh_real kept = *carry + by.low * factor;
    if (h.low == WH_R(0.0)) {
        *carry = kept;
        return wh_sum(value, product, true, carry);
    }
    const wh_real sum = value + (product + kept);
    *carry = kept + (product - (sum - value));
    return sum;
}

/* Returns h.high * part.low, in s^2. Adds a correction if stages leave out h.low (docs/dev/numerics.md). */
WH_INLINE wh_real wh_square_short(const wh_tableau *by, wh_two_part h, wh_two_part part) {
    const wh_real stages = wh_all_begin(by) ? WH_R(0.0) : h.low / by->parts;
    return h.high * (part.low + stages);
}

/* Returns wh_square_short() for angles, in (phase units) s^2/rad. `turned` is true if the stages rotated sines. */
WH_INLINE wh_real wh_turn_short(const wh_tableau *by, wh_two_part h, wh_two_part part,
                                bool turned) {
    const wh_two_part per_rad = {WH_PHASE_PER_RAD, WH_PHASE_PER_RAD_REST};
    const wh_two_part phases = wh_two_part_times(h, per_rad);
    if (turned || wh_all_begin(by)) {
        return WH_PHASE_PER_RAD * wh_square_short(by, h, part);
    }
    if (wh_stage_reaches(by)) {
        return WH_PHASE_PER_RAD * wh_square_short(by, h, part) +
               h.high * part.high * WH_PHASE_PER_RAD_REST;
    }
    return phases.high * part.low + part.high * phases.low;
}

WH_INLINE void wh_carry_positions(const wh_tableau *by, const wh_real *pulled, wh_two_part part,
                                  wh_two_part h, bool turned, unsigned angles, unsigned linears,
                                  wh_trial *trial) {
    WH_UNROLL
    for (unsigned i = 0; i < angles + linears; i++) {
        if (!WH_DOUBLE && i < angles) {
            trial->carry[i] += pulled[i] * wh_turn_short(by, h, part, turned);
        } else if (!WH_DOUBLE && h.low != WH_R(0.0)) {
            trial->carry[i] += pulled[i] * wh_square_short(by, h, part);
        }
    }
}

/* Ends a step of q'' = f. a1[] are the accelerations of the first stage; alike[] are sums from wh_stage_given().
 * `turned` is true if the stages rotated sines. Returns what wh_step_second() returns. */
WH_INLINE wh_status wh_second_end(const wh_tableau *by, const wh_real *a1,
                                  wh_real (*alike)[WH_COORDS], bool turned, bool compensated,
                                  unsigned angles, unsigned n, wh_two_part h, wh_state *state) {
    const wh_two_part part = wh_two_part_over(h, by->parts);
    const unsigned linears = n - angles;
    const wh_real *linear = state->real;
    const wh_real *rate = state->real + linears;
    wh_real move[WH_COORDS];   /* mean rate that moves the position in this step */
    wh_real gain[WH_COORDS];   /* sum of the accelerations, weighted by .rates */
    wh_real kick[WH_COORDS];   /* change of the rate in this step */
    wh_real pulled[WH_COORDS]; /* sum of the accelerations, weighted by .positions */
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
        move[i] = any_moved ? rate[i] + part.high * moved : rate[i];
        gain[i] = any_moved && any_rest ? moved + rest : any_moved ? moved : rest;
        kick[i] = part.high * gain[i];
        pulled[i] = moved;
    }

    wh_carry_begin(state, compensated, angles + linears, &trial);
    if (compensated) {
        wh_carry_positions(by, pulled, part, h, turned, angles, linears, &trial);
    }
    WH_REFUSE_FAR(wh_angles_move(move, h, h.high, compensated, angles, state, &trial));
    WH_UNROLL
    for (unsigned i = 0; i < linears; i++) {
        wh_real *carry = &trial.carry[angles + i];
        trial.real[i] = wh_sum_product(linear[i], h, move[angles + i], h.high * move[angles + i], h,
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

/* wh_second_end() for a step of x' = f. */
WH_INLINE wh_status wh_first_end(const wh_tableau *by, const wh_real *k1,
                                 wh_real (*alike)[WH_COORDS], bool compensated, unsigned angles,
                                 unsigned reals, wh_two_part h, wh_state *state) {
    const wh_two_part part = wh_two_part_over(h, by->parts);
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
    WH_REFUSE_FAR(wh_angles_move(total, part, h.high, compensated, angles, state, &trial));
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        wh_real *carry = &trial.carry[angles + i];
        *carry = compensated ? state->carry[angles + i] : WH_R(0.0);
        trial.real[i] = wh_sum_product(state->real[i], part, total[angles + i],
                                       part.high * total[angles + i], h, compensated, carry);
    }
    return wh_accept(&trial, angles, reals, compensated, state);
}

#endif
