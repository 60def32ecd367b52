/* stage_turn.h: steps whose stages rotate sines and cosines instead of looking them up.
 *
 * A step looks up the sine and cosine of each angle of its list once, at its begin (stage 0). Let r be the angle's rate
 * at stage 0 and r_j its rate at stage j. At stage s, with .stage[s] of method.h, the angle has increased by
 *
 *      c_s h r + h sum_j share_j (r_j - r) / parts,        c_s = sum_j share_j / parts.
 *
 * The first part is a whole multiple of d = c_1 h r, the rotation at stage 1. So all stages need only the sine and
 * cosine of one small angle, two short polynomials. Each rotation by d is p' = p + w, w' = w + b p'. Here p is the sine
 * or the cosine, w the increment of this rotation, w' that of the next one, and b = 2 (cos d - 1).
 *
 * The second part, the shear angle e, is of order h^2, because r_j - r is of order h. Three shears rotate the pair (s,
 * c) of sine and cosine by e: c -= s e/2, s += c e, c -= s e/2. Their error is e^3/6, of order h^6. So the stages agree
 * with looked-up ones to a higher order than any method here has. The classic method has d = h r/2. If a_0 and a_1 are
 * the angle's accelerations at stages 0 and 1, the angle has increased by
 *
 *      stage 1:  d     stage 2:  d, and the shear h^2 a_0/4     stage 3:  2 d, and the shear h^2 a_1/2
 *
 * The step moves the angle itself as usual (step.h), and the next step looks up its sine, so no error accumulates.
 *
 * The polynomials are used if the sum of |d| over the list's angles is at most half a radian. Otherwise the step
 * rotates by d / 2^k and doubles this rotation k times (sincos_small.h): the stages are nearly as accurate, but slower.
 * Every step that step.h would accept is accepted. */
#ifndef WH_STAGE_TURN_H
#define WH_STAGE_TURN_H

#include "../number/sincos_small.h"
#include "../step.h"

/* tree-pre would compute the operands of some branches before the branch: up to 3 % more cycles on a Cortex-M4F. */
#if defined(__GNUC__) && !defined(__clang__) && !WH_DOUBLE
#pragma GCC optimize("no-tree-pre")
#endif

/* Maximum number of waves. A generated scene defines its own. */
#ifndef WH_WAVES
#define WH_WAVES 256
#endif

/* On a PC, rename-registers saves copies. With at most one wave, no-gcse frees registers. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#pragma GCC optimize("rename-registers")
#if WH_WAVES <= 1
#pragma GCC optimize("no-gcse")
#endif
#endif

/* If 1, a step computes its rotations before its first accelerations. In double on a PC: 3 % more instructions. */
#define WH_TURN_ASKS_FIRST (!WH_DOUBLE)

/* Like wh_accel_fn and wh_slope_fn, but with the sine-cosine pairs of the waves instead of the phases. */
typedef void wh_turned_accel_fn(const void *model, const wh_wave *pair, const wh_real *linear,
                                const wh_real *rate, const wh_real *input, wh_real *accel);
typedef void wh_turned_slope_fn(const void *model, const wh_wave *pair, const wh_real *real,
                                const wh_real *input, wh_real *slope);

/* Waves: the angles whose sine and cosine an operation list takes. Each is a sum of whole multiples of turn angles. */
typedef struct wh_waves {
    const void *model;
    /* Computes parts[i], the sine and the cosine of each wave i, from phase[] of the turn angles. */
    void (*sines)(const void *model, const wh_phase *phase, wh_sine_parts *parts);
    /* Computes result[count], the waves' rates times `scale`, from rate[] of the angles. Also used for shear angles. */
    void (*rates)(const void *model, wh_real scale, const wh_real *rate, wh_real *result);
    unsigned count; /* <= WH_WAVES */
} wh_waves;

/* True if the method's stages can rotate sines: its row has .turns, or its only stage is at the step's begin. */
WH_INLINE bool wh_method_turns(wh_method method) {
    const wh_tableau *by = wh_tableau_of(method);
    return !wh_begins_away(by) && (by->stages == 1 || by->turns[1] == 1);
}

/* The sine-cosine pairs of a step in progress. */
typedef struct wh_turning {
    /* The pairs at the step's begin. If `precise`, rotations change .sine_rest and .cosine_rest. */
    wh_sine_parts parts[WH_WAVES];
    wh_wave at[WH_WAVES]; /* the pairs after `turns` rotations by the angle d */
    /* If `precise`, the last rotation's increments of the pairs. Otherwise the pairs before the last rotation. */
    wh_wave way[WH_WAVES];
    wh_real bend[WH_WAVES]; /* 2 (cos d - 1) if `precise`, otherwise 2 cos d */
    unsigned turns;         /* number of rotations done */
} wh_turning;

WH_INLINE void wh_turning_look_up(const wh_waves *waves, const wh_angle *angle, unsigned angles,
                                  wh_phase *stage_phase, wh_turning *t) {
    wh_phase phase[WH_COORDS];
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        phase[i] = wh_phase_of(angle[i]);
        if (stage_phase != NULL) {
            stage_phase[i] = phase[i];
        }
    }
    waves->sines(waves->model, phase, t->parts);
    WH_UNROLL
    for (unsigned w = 0; w < waves->count; w++) {
        t->at[w].sine = t->parts[w].sine + t->parts[w].sine_rest;
        t->at[w].cosine = t->parts[w].cosine + t->parts[w].cosine_rest;
    }
    t->turns = 0;
}

/* Sets turn[i] to the sine, and the cosine minus 1, of d[i]. The sum of all |d[i]| exceeds WH_SINCOS_SMALL. */
WH_INLINE void wh_sincos_far_all(const wh_real *d, unsigned n, wh_wave *turn) {
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        turn[i] = WH_REALS_IN_REGISTERS && n > 1 ? wh_sincos_far_called(d[i])
                                                 : wh_sincos_far(d[i], n == 1);
    }
}

/* Sets turn[w] for the angle of wave w between stages 0 and 1. turn[w].cosine is the cosine minus 1. */
WH_INLINE void wh_turning_by(const wh_tableau *by, const wh_waves *waves, const wh_real *rate,
                             wh_real h, wh_wave *turn) {
    wh_real d[WH_WAVES];
    wh_real first = WH_R(0.0);
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned j = 0; j < WH_STAGES; j++) {
        first += by->stage[1].share[j];
    }
    waves->rates(waves->model, h / by->stage[1].parts * first, rate, d);
    WH_UNROLL
    for (unsigned w = 0; w < waves->count; w++) {
        all = w == 0 ? WH_ABS(d[w]) : all + WH_ABS(d[w]);
    }
    if (WH_SELDOM(!(all <= WH_SINCOS_SMALL))) {
        wh_sincos_far_all(d, waves->count, turn);
    } else {
        WH_UNROLL
        for (unsigned w = 0; w < waves->count; w++) {
            turn[w] = wh_sincos_small(d[w]);
        }
    }
}

/* Prepares rotations of the pairs t->at by turn[]. */
WH_INLINE void wh_turning_begin(const wh_waves *waves, const wh_wave *turn, bool precise,
                                wh_turning *t) {
    WH_UNROLL
    for (unsigned w = 0; w < waves->count; w++) {
        const wh_real sine = turn[w].sine;
        const wh_real less = turn[w].cosine;
        t->way[w].sine = t->at[w].sine * less + t->at[w].cosine * sine;
        t->way[w].cosine = t->at[w].cosine * less - t->at[w].sine * sine;
        t->bend[w] = precise ? less + less : less + less + WH_R(2.0);
    }
}

/* Rotates until `turns` rotations are done. If `precise`, sums the increments before it rounds the pairs. */
WH_INLINE void wh_turning_to(const wh_waves *waves, unsigned turns, bool precise, wh_turning *t) {
    WH_UNROLL
    for (unsigned k = 0; k < WH_STAGES; k++) {
        if (t->turns == turns) {
            break;
        }
        WH_UNROLL
        for (unsigned w = 0; w < waves->count; w++) {
            wh_sine_parts *parts = &t->parts[w];
            wh_wave *at = &t->at[w];
            wh_wave *way = &t->way[w];
            if (!precise && t->turns > 0) {
                const wh_wave last = *at;
                at->sine = t->bend[w] * at->sine - way->sine;
                at->cosine = t->bend[w] * at->cosine - way->cosine;
                *way = last;
                continue;
            }
            if (t->turns > 0) {
                way->sine += t->bend[w] * at->sine;
                way->cosine += t->bend[w] * at->cosine;
            }
            if (precise) {
                parts->sine_rest += way->sine;
                parts->cosine_rest += way->cosine;
                at->sine = parts->sine + parts->sine_rest;
                at->cosine = parts->cosine + parts->cosine_rest;
            } else {
                const wh_wave last = *at;
                at->sine += way->sine;
                at->cosine += way->cosine;
                *way = last;
            }
        }
        t->turns++;
    }
}

/* Computes shear[i]: the shear angle of turn angle i is shear[i] * h / of->parts. gained[j][i] is the change of rate i
 * from the step's begin to stage j + 1. Returns false if the stage's shares make all shear angles zero. */
WH_INLINE bool wh_turning_shears(const wh_shares *of, unsigned stage, wh_real (*gained)[WH_COORDS],
                                 unsigned angles, wh_real *shear) {
    bool shears = false;
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        bool any = false;
        shear[i] = WH_R(0.0);
        WH_UNROLL
        for (unsigned j = 1; j < WH_STAGES; j++) {
            if (j < stage) {
                wh_total_add(&shear[i], &any, of->share[j], gained[j - 1][i]);
            }
        }
        shears = shears || any;
    }
    return shears;
}

/* Rotates the pair `at` by the small angle `shear`, by three shears. */
WH_INLINE_WITH_FPU wh_wave wh_shear(wh_wave at, wh_sine_parts parts, wh_real shear, bool precise) {
    const wh_real half = WH_R(0.5) * shear;
    const wh_real cosine = at.cosine - half * at.sine;
    wh_wave sheared;
    if (precise) {
        sheared.sine = parts.sine + (parts.sine_rest + shear * cosine);
        sheared.cosine = parts.cosine + (parts.cosine_rest - half * (at.sine + sheared.sine));
    } else {
        sheared.sine = at.sine + shear * cosine;
        sheared.cosine = cosine - half * sheared.sine;
    }
    return sheared;
}

/* Rotates the pair `at` by the angle `shear` of any size. */
WH_INLINE wh_wave wh_shear_far(wh_wave at, wh_sine_parts parts, wh_real shear, bool precise) {
    const wh_wave turn =
        WH_ABS(shear) <= WH_SINCOS_SMALL ? wh_sincos_small(shear) : wh_sincos_far(shear, true);
    const wh_real sine = at.sine * turn.cosine + at.cosine * turn.sine;
    const wh_real cosine = at.cosine * turn.cosine - at.sine * turn.sine;
    wh_wave sheared;
    if (precise) {
        sheared.sine = parts.sine + (parts.sine_rest + sine);
        sheared.cosine = parts.cosine + (parts.cosine_rest + cosine);
    } else {
        sheared.sine = at.sine + sine;
        sheared.cosine = at.cosine + cosine;
    }
    return sheared;
}

/* Computes the pairs at stage `stage`; gained[] as in wh_turning_shears(). If `far`, the shear angles may be large. */
WH_INLINE void wh_turning_stage(const wh_stepping *to, const wh_waves *waves, unsigned stage,
                                wh_real (*gained)[WH_COORDS], bool far, wh_turning *t,
                                wh_wave *pair) {
    const wh_shares *of = &to->by->stage[stage];
    const bool precise = to->compensated;
    wh_real of_angles[WH_COORDS];
    wh_real shear[WH_WAVES];
    const bool shears = wh_turning_shears(of, stage, gained, to->angles, of_angles);
    if (shears) {
        waves->rates(waves->model, to->h / of->parts, of_angles, shear);
    }
    wh_turning_to(waves, to->by->turns[stage], precise, t);
    WH_UNROLL
    for (unsigned w = 0; w < waves->count; w++) {
        pair[w] = !shears ? t->at[w]
                  : far   ? wh_shear_far(t->at[w], t->parts[w], shear[w], precise)
                          : wh_shear(t->at[w], t->parts[w], shear[w], precise);
    }
}

/* Sets pair[] to the sines and cosines at stage `stage` of a method with .places. */
WH_INLINE void wh_turning_reach(const wh_stepping *to, const wh_waves *waves, unsigned stage,
                                wh_given accels, wh_turning *t, wh_wave *pair) {
    const wh_shares *of = &to->by->places->reach[stage];
    const bool precise = to->compensated;
    wh_real of_angles[WH_COORDS];
    wh_real shear[WH_WAVES];
    WH_UNROLL
    for (unsigned i = 0; i < to->angles; i++) {
        of_angles[i] = wh_stage_sum(of->share, stage, accels, i);
    }
    waves->rates(waves->model, to->h * to->h / of->parts, of_angles, shear);
    wh_turning_to(waves, to->by->turns[stage], precise, t);
    WH_UNROLL
    for (unsigned w = 0; w < waves->count; w++) {
        pair[w] = wh_shear(t->at[w], t->parts[w], shear[w], precise);
    }
}

/* Computes stage_phase[to->angles], the phases at a stage, for the ledger. */
WH_INLINE void wh_turning_phases(const wh_stepping *to, unsigned stage, const wh_real *rate,
                                 wh_given rates, wh_given accels, wh_phase *stage_phase) {
    const wh_shares *of = &to->by->stage[stage];
    for (unsigned i = 0; i < to->angles; i++) {
        const wh_angle angle = to->state->angle[i];
        if (wh_stage_reaches(to->by)) {
            const wh_real rad = wh_stage_reach(to->by, stage, rate[i], accels, to->h, i);
            (void)wh_phase_move(wh_phase_of(angle), rad * WH_PHASE_PER_RAD, &stage_phase[i]);
        } else {
            (void)wh_stage_angle(angle, wh_stage_sum(of->share, stage, rates, i), to->h, of->parts,
                                 &stage_phase[i]);
        }
    }
}

/* Arguments and results of an operation list. */
typedef struct wh_turned_list {
    wh_wave pair[WH_WAVES];
    wh_real at[WH_COORDS];    /* linear positions, or reals */
    wh_real v[WH_COORDS];     /* rates */
    wh_real given[WH_COORDS]; /* accelerations, or slopes */
} wh_turned_list;

WH_INLINE void wh_turned_take(const wh_waves *waves, const wh_turning *t, wh_turned_list *list) {
    WH_UNROLL
    for (unsigned w = 0; w < waves->count; w++) {
        list->pair[w] = t->at[w];
    }
}

typedef struct wh_turned_second {
    const wh_real *linear; /* linear positions at the begin */
    const wh_real *rate;
    const wh_real *input;
    wh_turning t;
    wh_real a1[WH_COORDS];                /* accelerations of the first stage */
    wh_real gained[WH_STAGES][WH_COORDS]; /* change of the rates since the begin */
    wh_real rates[WH_STAGES][WH_COORDS];
    wh_real accels[WH_STAGES][WH_COORDS];
    wh_real alike[WH_STAGES][WH_COORDS]; /* accelerations, summed over stages of equal weights */
} wh_turned_second;

WH_INLINE void wh_turn_second_stage(const void *model, wh_turned_accel_fn *accel,
                                    const wh_waves *waves, const wh_stepping *to,
                                    wh_phase *stage_phase, unsigned s, wh_turned_list *list,
                                    wh_turned_second *k) {
    const wh_tableau *by = to->by;
    const wh_shares *of = &by->stage[s];
    const wh_real h = to->h;
    const unsigned angles = to->angles;
    const wh_given all_rates = {k->rate, k->rates};
    const wh_given all_accels = {k->a1, k->accels};
    if (s >= by->stages) {
        return;
    }
    WH_UNROLL
    for (unsigned i = 0; i < to->n; i++) {
        k->gained[s - 1][i] = h / of->parts * wh_stage_sum(of->share, s, all_accels, i);
        list->v[i] = k->rate[i] + k->gained[s - 1][i];
        k->rates[s - 1][i] = list->v[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < to->n - angles; i++) {
        list->at[i] =
            wh_stage_reaches(by)
                ? k->linear[i] +
                      wh_stage_reach(by, s, k->rate[angles + i], all_accels, h, angles + i)
                : k->linear[i] + h / of->parts * wh_stage_sum(of->share, s, all_rates, angles + i);
    }
    if (wh_stage_reaches(by)) {
        wh_turning_reach(to, waves, s, all_accels, &k->t, list->pair);
    } else {
        wh_turning_stage(to, waves, s, k->gained, false, &k->t, list->pair);
    }
    if (stage_phase != NULL) {
        wh_turning_phases(to, s, k->rate, all_rates, all_accels, stage_phase);
    }
    accel(model, list->pair, list->at, list->v, k->input, list->given);
    wh_stage_given(by, s, true, to->n, k->a1, list->given, k->accels, k->alike);
}

/* Does a second-order step. to->h is h.high. If stage_phase is not NULL, stores the phases of each stage in
 * stage_phase[to->angles] before accel() is called. */
WH_INLINE wh_status wh_turn_second_phases(const void *model, wh_turned_accel_fn *accel,
                                          const wh_waves *waves, const wh_stepping *to,
                                          wh_two_part h, wh_phase *stage_phase, wh_state *state) {
    const wh_tableau *by = to->by;
    const bool compensated = to->compensated;
    const unsigned angles = to->angles;
    const unsigned n = to->n;
    wh_turned_second k;
    k.linear = state->real;
    k.rate = state->real + (n - angles);
    k.input = state->input;
    wh_turned_list list;
    wh_wave turn[WH_WAVES];

    if (WH_TURN_ASKS_FIRST && by->stages > 1) {
        wh_turning_by(by, waves, k.rate, h.high, turn);
    }
    wh_turning_look_up(waves, state->angle, angles, stage_phase, &k.t);
    wh_turned_take(waves, &k.t, &list);
    accel(model, list.pair, k.linear, k.rate, k.input, list.given);
    wh_copy(list.given, n, k.a1);
    if (!WH_TURN_ASKS_FIRST && by->stages > 1) {
        wh_turning_by(by, waves, k.rate, h.high, turn);
    }
    wh_turning_begin(waves, turn, compensated, &k.t);
#define WH_STAGE(stage) wh_turn_second_stage(model, accel, waves, to, stage_phase, stage, &list, &k)
    WH_LATER_STAGES(by, WH_STAGE);
#undef WH_STAGE
    return wh_second_end(by, k.a1, k.alike, true, compensated, angles, n, h, state);
}

/* wh_step_second() with rotated sines, for a method that has .turns. */
WH_INLINE wh_status wh_turn_second(const void *model, wh_turned_accel_fn *accel,
                                   const wh_waves *waves, wh_method method, bool compensated,
                                   unsigned angles, unsigned n, wh_two_part h, wh_state *state) {
    const wh_stepping to = {wh_tableau_of(method), state, h.high, angles, n, compensated};
    return wh_turn_second_phases(model, accel, waves, &to, h, NULL, state);
}

typedef struct wh_turned_first {
    wh_turning t;
    wh_real k1[WH_COORDS];                /* derivatives of the first stage */
    wh_real gained[WH_STAGES][WH_COORDS]; /* derivatives minus the first stage's */
    wh_real slopes[WH_STAGES][WH_COORDS]; /* derivatives of the later stages */
    wh_real alike[WH_STAGES][WH_COORDS];  /* running sums over stages of equal weights */
} wh_turned_first;

WH_INLINE void wh_turn_first_stage(const void *model, wh_turned_slope_fn *slope,
                                   const wh_waves *waves, const wh_stepping *to, unsigned s,
                                   wh_turned_list *list, wh_turned_first *k) {
    const wh_tableau *by = to->by;
    const wh_shares *of = &by->stage[s];
    const wh_state *state = to->state;
    const unsigned angles = to->angles;
    const wh_given all = {k->k1, k->slopes};
    if (s >= by->stages) {
        return;
    }
    WH_UNROLL
    for (unsigned i = 0; i < to->n - angles; i++) {
        list->at[i] =
            state->real[i] + to->h / of->parts * wh_stage_sum(of->share, s, all, angles + i);
    }
    wh_turning_stage(to, waves, s, k->gained, true, &k->t, list->pair);
    slope(model, list->pair, list->at, state->input, list->given);
    wh_stage_given(by, s, false, to->n, k->k1, list->given, k->slopes, k->alike);
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        k->gained[s - 1][i] = list->given[i] - k->k1[i];
    }
}

/* wh_step_first() with rotated sines, for a method that has .turns. */
WH_INLINE wh_status wh_turn_first(const void *model, wh_turned_slope_fn *slope,
                                  const wh_waves *waves, wh_method method, bool compensated,
                                  unsigned angles, unsigned reals, wh_two_part h, wh_state *state) {
    const wh_tableau *by = wh_tableau_of(method);
    const wh_stepping to = {by, state, h.high, angles, angles + reals, compensated};
    wh_turned_first k;
    wh_turned_list list;
    wh_wave turn[WH_WAVES];

    if (!wh_method_takes(method, WH_FIRST_ORDER)) {
        return WH_E_ARGUMENT;
    }
    wh_turning_look_up(waves, state->angle, angles, NULL, &k.t);
    wh_turned_take(waves, &k.t, &list);
    slope(model, list.pair, state->real, state->input, list.given);
    wh_copy(list.given, angles + reals, k.k1);
    if (by->stages > 1) {
        wh_turning_by(by, waves, k.k1, h.high, turn);
        wh_turning_begin(waves, turn, compensated, &k.t);
    }
#define WH_STAGE(stage) wh_turn_first_stage(model, slope, waves, &to, stage, &list, &k)
    WH_LATER_STAGES(by, WH_STAGE);
#undef WH_STAGE
    return wh_first_end(by, k.k1, k.alike, compensated, angles, reals, h, state);
}

#endif
