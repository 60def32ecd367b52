/* lockin.c: digital lock-in: the load's once-per-turn component, turn by turn. */
#include "lockin.h"

#include "core/root.h"
#include "datasheet.h"
#include "polar.h"

#define PI WH_R(3.141592653589793)

/* A turn that violates one of these limits does not count. */
#define GAP_PERIODS WH_R(3.5) /* largest gap between nodes, in sample periods */
#define OUTLIERS_PER_TURN 10U /* one outlier is allowed per this many samples */

/* A load is frozen if this many successive samples equal the one before. */
#define FROZEN_SAMPLES 8U

/* An outlier deviates by more than 6 standard deviations plus 2 % of the first order. */
#define OUTLIER_DEVIATIONS WH_R(6.0)
#define OUTLIER_PART WH_R(0.02) /* 1 % more speed adds 2 % to the first order */

#define STEADY_PART 64U /* a turn counts if its duration changes by at most 1/64 */
#define STILL_PART 256U /* if the duration changes by at most 1/256, the inertia is estimated */

void wh_lockin_forget(const wh_rotor_config *rotor, wh_lockin *lockin) {
    lockin->stage = WH_LOCKIN_WAITS;
    lockin->piece = 0;
    lockin->count = 0;
    lockin->taken = false;
    lockin->any = false;
    lockin->equal = 0;
    lockin->most_equal = 0;
    lockin->open = false;
    lockin->expects = false;
    wh_turn_angle_start(rotor, &lockin->angle);
}

static WH_CALLED void close_turn(wh_lockin *lockin, uint32_t ticks) {
    if (lockin->stage != WH_LOCKIN_WAITS) { /* the load cell stopped in the middle of a turn */
        lockin->skipped++;
        return;
    }
    lockin->next = (wh_lockin_turn){.begin_ticks = lockin->begin_ticks,
                                    .turn_ticks = ticks - lockin->begin_ticks,
                                    .second_seen = lockin->second_seen,
                                    .second_ticks = lockin->second_ticks};
    lockin->next_equal = lockin->most_equal;
    lockin->stage = WH_LOCKIN_SHAPES;
}

void wh_lockin_pulse(wh_lockin *lockin, unsigned sensor, uint32_t ticks, uint32_t quarter) {
    const uint32_t quarters = quarter - lockin->begin_quarter;
    if (sensor != 0) {
        if (lockin->open && quarters == 1U) {
            lockin->second_seen = true;
            lockin->second_ticks = ticks;
        }
        return;
    }
    if (lockin->open && quarters == 4U) {
        close_turn(lockin, ticks);
    } else if (lockin->open) {
        lockin->skipped += quarters / 4U;
    }
    lockin->open = true;
    lockin->second_seen = false;
    lockin->begin_ticks = ticks;
    lockin->begin_quarter = quarter;
    lockin->most_equal = 0;
}

void wh_lockin_compensate(wh_lockin *lockin, bool compensated, wh_real stall_Nm_per_V) {
    if (lockin->angle.compensated != compensated) {
        wh_lockin_gap(lockin);
    }
    wh_turn_angle_compensate(&lockin->angle, compensated, stall_Nm_per_V);
}

void wh_lockin_gap(wh_lockin *lockin) {
    lockin->skipped += lockin->open ? 1U : 0U;
    lockin->open = false;
}

static void pop(wh_lockin *lockin) {
    lockin->taken = true;
    lockin->taken_ticks = lockin->ticks[lockin->first];
    lockin->taken_N = lockin->force_N[lockin->first];
    lockin->first = (uint16_t)(lockin->first + 1U == WH_LOCKIN_SAMPLES ? 0U : lockin->first + 1U);
    lockin->count--;
}

/* Drops at most WH_LOCKIN_STALE_AT_ONCE samples older than the turn. The last one dropped stays in taken_N. */
static void drop_stale(wh_lockin *lockin, uint32_t begin_ticks) {
    for (unsigned i = 0; i < WH_LOCKIN_STALE_AT_ONCE && lockin->count > 0; i++) {
        if ((int32_t)(lockin->ticks[lockin->first] - begin_ticks) > 0) {
            break;
        }
        pop(lockin);
    }
}

void wh_lockin_load(wh_lockin *lockin, const wh_load *load) {
    if (load->status != WH_LOAD_OK ||
        (lockin->any && (int32_t)(load->ticks - lockin->newest_ticks) <= 0)) {
        lockin->refused++;
        return;
    }
    if (lockin->any) {
        if (load->force_N < lockin->newest_N || load->force_N > lockin->newest_N) {
            lockin->equal = 0;
        } else if (lockin->equal < FROZEN_SAMPLES) {
            lockin->equal++;
        }
        if (lockin->equal > lockin->most_equal) {
            lockin->most_equal = lockin->equal;
        }
    }
    lockin->any = true;
    lockin->newest_ticks = load->ticks;
    lockin->newest_N = load->force_N;
    /* The queue is full only if no turn is open, or the turn is too slow to be measured. */
    if (lockin->count == WH_LOCKIN_SAMPLES) {
        pop(lockin);
    }
    uint32_t at = (uint32_t)lockin->first + lockin->count;
    at -= at >= WH_LOCKIN_SAMPLES ? WH_LOCKIN_SAMPLES : 0U;
    lockin->force_N[at] = load->force_N;
    lockin->ticks[at] = load->ticks;
    lockin->count++;
    if (lockin->stage == WH_LOCKIN_WAITS && !lockin->open) {
        pop(lockin);
    }
}

/* Adds the last node to the sums, weighted by half of the distance between its neighbours. */
WH_SHARED void weigh_last(wh_lockin *lockin, wh_real theta_rad, wh_real part) {
    const wh_lockin_node *node = &lockin->last;
    const wh_real rest = WH_R(0.5) * (theta_rad - lockin->before_rad) * node->residual_N;
    for (unsigned i = 0; i < WH_LOCKIN_ORDERS; i++) {
        lockin->sum.at[i] += rest * node->waves.at[i];
    }
    lockin->square += rest * node->residual_N;
    wh_repeats_add(&lockin->repeats, node->theta_rad, rest);
    lockin->mean += WH_R(0.5) * (part - lockin->before_part) * node->force_N;
}

/* Does the first half of a node's work: its angle and load. force_N is the load at the time `ticks`. */
static void place_node(wh_lockin *lockin, uint32_t ticks, wh_real force_N, wh_lockin_place place) {
    wh_lockin_node *node = &lockin->placed;
    node->force_N = force_N;
    node->part = (wh_real)(ticks - lockin->next.begin_ticks) * lockin->part_per_tick;
    node->theta_rad = wh_turn_angle_at(&lockin->angle, node->part);
    const wh_wave wave = wh_wave_of(node->theta_rad);
    node->waves = (wh_lockin_orders){{WH_R(1.0), wave.cosine, wave.sine,
                                      WH_R(2.0) * wave.cosine * wave.cosine - WH_R(1.0),
                                      WH_R(2.0) * wave.cosine * wave.sine}};
    lockin->place = place;
}

/* Skips the node if it is an outlier. Otherwise adds lockin->last to the sums and replaces it by the node. */
static void weigh_node(wh_lockin *lockin) {
    wh_lockin_node *node = &lockin->placed;
    const wh_lockin_place place = lockin->place;
    lockin->place = WH_LOCKIN_NOWHERE;
    wh_real residual_N = node->force_N;
    for (unsigned i = 0; i < WH_LOCKIN_ORDERS; i++) {
        residual_N -= lockin->expected_N.at[i] * node->waves.at[i];
    }
    if (lockin->expects && !(WH_ABS(residual_N) <= lockin->outlier_N)) {
        if (place == WH_LOCKIN_WITHIN) {
            lockin->next.outliers++;
            return;
        }
        node->force_N -= residual_N; /* never skip a pulse: use the predicted load */
        residual_N = WH_R(0.0);
    }
    node->residual_N = residual_N;
    if (place == WH_LOCKIN_BEGIN) {
        lockin->before_rad = node->theta_rad;
        lockin->before_part = node->part;
    } else {
        weigh_last(lockin, node->theta_rad, node->part);
        lockin->before_rad = lockin->last.theta_rad;
        lockin->before_part = lockin->last.part;
        const wh_real way = node->part - lockin->last.part;
        lockin->widest = way > lockin->widest ? way : lockin->widest;
    }
    if (place == WH_LOCKIN_WITHIN) {
        lockin->next.samples++;
        const wh_real change_N = residual_N - lockin->last.residual_N;
        lockin->repeats.changes_N2 += change_N * change_N;
    }
    lockin->last = *node;
}

/* Returns the load at a time between the last processed sample and the oldest waiting one. */
static wh_real load_between(const wh_lockin *lockin, uint32_t ticks) {
    const wh_real later_N = lockin->force_N[lockin->first];
    if (!lockin->taken) {
        return later_N;
    }
    const wh_real all = (wh_real)(lockin->ticks[lockin->first] - lockin->taken_ticks);
    const wh_real part = (wh_real)(ticks - lockin->taken_ticks) / all;
    return lockin->taken_N + part * (later_N - lockin->taken_N);
}

/* Begins the next node, if its sample has come. */
static void place_next(wh_lockin *lockin) {
    wh_lockin_turn *turn = &lockin->next;
    const uint32_t end_ticks = turn->begin_ticks + turn->turn_ticks;
    uint32_t ticks = lockin->ticks[lockin->first];
    wh_real force_N = lockin->force_N[lockin->first];
    wh_lockin_place place = WH_LOCKIN_WITHIN;
    if (lockin->count == 0 || (int32_t)(ticks - turn->begin_ticks) <= 0) {
        return;
    }
    if (lockin->stage == WH_LOCKIN_BEGINS) {
        ticks = turn->begin_ticks;
        force_N = load_between(lockin, ticks);
        turn->at_pulse_N[0] = force_N;
        place = WH_LOCKIN_BEGIN;
        lockin->stage = WH_LOCKIN_SUMS;
    } else if ((int32_t)(ticks - end_ticks) > 0) {
        ticks = end_ticks;
        force_N = load_between(lockin, ticks);
        place = WH_LOCKIN_END;
    } else {
        if (turn->second_seen && (int32_t)(ticks - turn->second_ticks) >= 0 &&
            (!lockin->taken || (int32_t)(lockin->taken_ticks - turn->second_ticks) < 0)) {
            turn->at_pulse_N[1] = load_between(lockin, turn->second_ticks);
        }
        pop(lockin);
    }
    place_node(lockin, ticks, force_N, place);
}

/* Does up to `halves` steps of work, two for each node. Returns true when the turn is finished. */
static bool take_samples(wh_lockin *lockin, unsigned halves) {
    if (lockin->stage == WH_LOCKIN_BEGINS) {
        drop_stale(lockin, lockin->next.begin_ticks);
    }
    const unsigned most = WH_RIG_SMALL_PIECES && halves > 1U ? 1U : halves;
    for (unsigned half = 0; half < most; half++) {
        if (lockin->place == WH_LOCKIN_NOWHERE) {
            place_next(lockin);
            continue;
        }
        const bool ends = lockin->place == WH_LOCKIN_END;
        weigh_node(lockin);
        if (ends) {
            return true;
        }
    }
    return false;
}

static bool is_steady(const wh_lockin *lockin, uint32_t part) {
    const uint32_t now = lockin->next.turn_ticks;
    const uint32_t before = lockin->turn.turn_ticks;
    return (now > before ? now - before : before - now) <= now / part;
}

static wh_turn_fault fault_of(const wh_cell_config *cell, const wh_lockin *lockin) {
    const wh_lockin_turn *turn = &lockin->next;
    const wh_real widest_ticks = lockin->widest * (wh_real)turn->turn_ticks;
    if (lockin->next_equal >= FROZEN_SAMPLES) {
        return WH_TURN_FROZEN;
    }
    if (turn->outliers * OUTLIERS_PER_TURN > turn->samples) {
        return WH_TURN_OUTLIERS;
    }
    if (!(widest_ticks <= GAP_PERIODS * (wh_real)cell->period_ticks) || turn->samples < 16U) {
        return WH_TURN_GAP;
    }
    if (!is_steady(lockin, STEADY_PART)) {
        return WH_TURN_UNSTEADY;
    }
    return lockin->expects ? WH_TURN_OK : WH_TURN_FIRST;
}

static void end_sums(wh_lockin *lockin) {
    wh_lockin_turn *turn = &lockin->next;
    weigh_last(lockin, lockin->last.theta_rad, lockin->last.part);
    wh_real square = lockin->square / WH_RIG_TWO_PI;
    for (unsigned i = 0; i < WH_LOCKIN_ORDERS; i++) {
        const wh_real more = lockin->sum.at[i] / (i == 0 ? WH_RIG_TWO_PI : PI);
        square -= (i == 0 ? WH_R(1.0) : WH_R(0.5)) * more * more;
        turn->force_N.at[i] = lockin->expected_N.at[i] + more;
    }
    lockin->square = square;
}

static WH_CALLED void end_turn(const wh_cell_config *cell, wh_lockin *lockin) {
    wh_lockin_turn *turn = &lockin->next;
    const wh_real square = lockin->square;
    const wh_real samples = (wh_real)turn->samples;
    const wh_real spare = samples - (wh_real)WH_LOCKIN_ORDERS;
    turn->residual_N =
        square > WH_R(0.0) && spare > WH_R(0.0) ? WH_SQRT(square * samples / spare) : WH_R(0.0);
    turn->mean_N = lockin->mean;
    turn->fault = fault_of(cell, lockin);
    const bool whole = turn->fault <= WH_TURN_FIRST;
    /* After a turn with a gap, the prediction stays valid, unless the turn had outliers. */
    if (whole) {
        lockin->expects = true;
        lockin->expected_N = turn->force_N;
        lockin->outlier_N =
            OUTLIER_DEVIATIONS * turn->residual_N +
            OUTLIER_PART * (WH_ABS(turn->force_N.at[1]) + WH_ABS(turn->force_N.at[2]));
    } else if (turn->fault != WH_TURN_GAP || turn->outliers > 0) {
        lockin->expects = false;
    }
    lockin->turn = *turn;
}

static void begin_turn(wh_lockin *lockin) {
    if (!lockin->expects) {
        lockin->expected_N = (wh_lockin_orders){{WH_R(0.0)}};
    }
    lockin->part_per_tick = WH_R(1.0) / (wh_real)lockin->next.turn_ticks;
    lockin->sum = (wh_lockin_orders){{WH_R(0.0)}};
    lockin->repeats = (wh_repeats){.samples = 0};
    lockin->square = lockin->mean = lockin->widest = WH_R(0.0);
    lockin->place = WH_LOCKIN_NOWHERE;
}

#if WH_RIG_SMALL_PIECES
/* Counts a piece. Returns true after the last one. */
static bool last_piece(wh_lockin *lockin, unsigned pieces) {
    lockin->piece++;
    if (lockin->piece < pieces) {
        return false;
    }
    lockin->piece = 0;
    return true;
}
#endif

static bool shape(const wh_rotor_config *rotor, wh_lockin *lockin) {
    const wh_real speed_radps =
        WH_RIG_TWO_PI * (wh_real)WH_RIG_TICKS_PER_S / (wh_real)lockin->next.turn_ticks;
#if WH_RIG_SMALL_PIECES
    wh_turn_angle_shape_piece(rotor, &lockin->angle, speed_radps, lockin->piece);
    return last_piece(lockin, WH_TURN_ANGLE_SHAPES);
#else
    wh_turn_angle_shape(rotor, &lockin->angle, speed_radps);
    return true;
#endif
}

static bool correct(const wh_rotor_config *rotor, wh_lockin *lockin) {
    const wh_lockin_turn *turn = &lockin->next;
    if (!turn->second_seen || !is_steady(lockin, STILL_PART)) {
        return true;
    }
    const wh_real ratio =
        (wh_real)(turn->second_ticks - turn->begin_ticks) / (wh_real)turn->turn_ticks;
#if WH_RIG_SMALL_PIECES
    if (lockin->piece == 0) {
        wh_turn_angle_ratio_waves(&lockin->angle, ratio);
    } else {
        wh_turn_angle_ratio_rest(rotor, &lockin->angle, ratio);
    }
    return last_piece(lockin, 2);
#else
    wh_turn_angle_by_ratio(rotor, &lockin->angle, ratio);
    return true;
#endif
}

static bool end(const wh_cell_config *cell, wh_lockin *lockin) {
    if (lockin->piece == 0) {
        end_sums(lockin);
        if (WH_RIG_SMALL_PIECES) {
            lockin->piece = 1;
            return false;
        }
    }
    lockin->piece = 0;
    end_turn(cell, lockin);
    return true;
}

WH_CALLED bool wh_lockin_work(const wh_rotor_config *rotor, const wh_cell_config *cell,
                              wh_lockin *lockin, unsigned halves) {
    bool done = false;
    const wh_lockin_stage stage = lockin->stage;
    switch (stage) {
    case WH_LOCKIN_WAITS:
        if (lockin->open) {
            drop_stale(lockin, lockin->begin_ticks);
        }
        break;
    case WH_LOCKIN_SHAPES:
    case WH_LOCKIN_RESHAPES:
        done = shape(rotor, lockin);
        if (done && stage == WH_LOCKIN_RESHAPES) {
            begin_turn(lockin);
        }
        break;
    case WH_LOCKIN_CORRECTS: done = correct(rotor, lockin); break;
    case WH_LOCKIN_BEGINS:
    case WH_LOCKIN_SUMS: done = take_samples(lockin, halves); break;
    case WH_LOCKIN_ENDS:
        done = end(cell, lockin);
        if (done) {
            lockin->stage = WH_LOCKIN_WAITS;
        }
        return done;
    }
    if (done) {
        lockin->stage = (wh_lockin_stage)(lockin->stage + 1);
    }
    return false;
}

/* === what repeats from turn to turn ========================================================== */

void wh_repeats_merge(wh_repeats *sum, const wh_repeats *turn, uint32_t samples) {
    sum->samples += samples;
    sum->changes_N2 += turn->changes_N2;
    for (unsigned i = 0; i < WH_REPEATS_BINS; i++) {
        sum->bin_N[i] += turn->bin_N[i];
    }
}

/* Goertzel's recurrence (American Mathematical Monthly 65 (1958) 34). */
wh_real wh_repeats_power_N2(const wh_repeats *sum, uint32_t turns, unsigned harmonic) {
    /* 2 cos(2 pi harmonic / 32) */
    static const wh_real factors[] = {WH_R(1.6629392246), WH_R(1.4142135624), WH_R(1.1111404660),
                                      WH_R(0.7653668647)};
    const wh_real factor = factors[harmonic - WH_REPEATS_FIRST];
    wh_real last = WH_R(0.0);
    wh_real before = WH_R(0.0);
    for (unsigned i = 0; i < WH_REPEATS_BINS; i++) {
        const wh_real now = sum->bin_N[i] + factor * last - before;
        before = last;
        last = now;
    }
    const wh_real per = WH_R(1.0) / (PI * (wh_real)turns);
    return per * per * (last * last + before * before - factor * last * before);
}
