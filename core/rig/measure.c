/* measure.c: the measurement of a run. */
#include "measure.h"

#include "core/root.h"
#include "datasheet.h"

/* After a record's time, wh_measure_end() waits at most this long for the lock-in to finish a turn. */
#define LAST_TURN_MAX_S WH_R(0.5)

void wh_measure_begin(const wh_measure_config *config, wh_measure *measure) {
    measure->tare = (wh_tare){.count = 0};
    measure->records = false;
    measure->due = 0;
    measure->adds = false;
    wh_lockin_forget(&config->rotor, &measure->lockin);
}

void wh_measure_pulse(wh_measure *measure, const wh_index_pulse *index) {
    if (index->gap) {
        wh_lockin_gap(&measure->lockin);
    }
    wh_lockin_pulse(&measure->lockin, index->pulse.sensor, index->pulse.ticks, index->quarter);
}

bool wh_measure_lasts(const wh_measure *measure, uint32_t ticks) {
    return measure->records && wh_rig_since_s(measure->begin_ticks, ticks) <= measure->record_s;
}

void wh_measure_load(wh_measure *measure, const wh_load *load, bool at_rest) {
    if (!at_rest) {
        wh_lockin_load(&measure->lockin, load);
    }
    if (load->status != WH_LOAD_OK) {
        return;
    }
    if (at_rest) {
        wh_tare_add(&measure->tare, load->force_N);
    } else if (wh_measure_lasts(measure, load->ticks)) {
        wh_rig_result *result = &measure->result;
        const wh_real force_N = load->force_N - measure->tare.mean_N;
        if (!measure->peaks || !(result->low_N < force_N)) {
            result->low_N = force_N;
        }
        if (!measure->peaks || !(result->high_N > force_N)) {
            result->high_N = force_N;
        }
        measure->peaks = true;
    }
}

/* Pieces of work that merge the turns into a result. The last one judges the result's quality. */
#define MERGE_PIECES (WH_MERGE_MEAN_PIECES + 2U)

/* After each turn: one piece adds the turn's residual to merge->repeats, then the merge follows. */
#define TURN_PIECES (MERGE_PIECES + 1U)
/* At the record's end: one piece for each harmonic, then the merge. */
#define END_PIECES (MERGE_PIECES + WH_REPEATS_LAST - WH_REPEATS_FIRST + 1U)

/* The first piece that computes the scatter and half-widths. Earlier pieces compute the means. */
#define SCATTER 3U

static void mean_pieces(const wh_measure_config *config, wh_measure *measure) {
    wh_measured *force = &measure->result.force;
    unsigned piece = MERGE_PIECES - measure->due;
    do {
        wh_merge_mean_piece(&config->result, &config->rotor, &measure->merge,
                            &measure->lockin.angle, measure->tare.mean_N, force, piece);
        if (piece == 0) {
            force->left_out += measure->lockin.skipped - measure->skipped_before;
        }
        piece++;
    } while (!WH_RIG_SMALL_PIECES && piece != SCATTER && piece != WH_MERGE_MEAN_PIECES);
    measure->due = (uint8_t)(MERGE_PIECES - piece);
}

static WH_CALLED void merge_piece(const wh_measure_config *config, wh_measure *measure) {
    wh_merge *merge = &measure->merge;
    wh_measured *force = &measure->result.force;
    const wh_turn_angle *angle = &measure->lockin.angle;
    if (measure->due > 2U && measure->due <= MERGE_PIECES) {
        mean_pieces(config, measure);
        return;
    }
    if (measure->due <= 1U) {
        wh_merge_judge(&config->result, &config->rotor, merge, angle, force);
    } else if (measure->due == 2U) {
        wh_merge_compare(&config->rotor, merge, angle, force);
    } else if (measure->ends) {
        wh_merge_harmonic(merge, WH_REPEATS_FIRST - 1U + measure->due - MERGE_PIECES);
    } else if (measure->lockin.turn.fault == WH_TURN_OK) {
        wh_repeats_merge(&merge->repeats, &measure->lockin.repeats, measure->lockin.turn.samples);
    }
    measure->due--;
}

static WH_CALLED void add_turn(const wh_measure_config *config, wh_measure *measure) {
    wh_merge_add(&config->result, &config->rotor, &measure->merge, &measure->lockin.turn,
                 &measure->lockin.angle);
    measure->adds = false;
    measure->due = (uint8_t)TURN_PIECES;
}

void wh_measure_work(const wh_measure_config *config, wh_measure *measure, unsigned halves) {
    const bool adds = WH_RIG_SMALL_PIECES && measure->adds;
    const bool sums = measure->due == 0 && !adds && measure->lockin.stage <= WH_LOCKIN_SUMS &&
                      measure->lockin.stage >= WH_LOCKIN_BEGINS;
    if (!sums && halves < WH_LOCKIN_HALVES_AT_ONCE) {
        return; /* work that cannot be split waits for a step without other work */
    }
    if (adds) {
        add_turn(config, measure);
        return;
    }
    if (measure->due > 0) {
        merge_piece(config, measure);
        return;
    }
    if (!wh_lockin_work(&config->rotor, &config->cell, &measure->lockin, halves)) {
        return;
    }
    const wh_lockin_turn *turn = &measure->lockin.turn;
    const bool begins_within = (int32_t)(turn->begin_ticks - measure->begin_ticks) >= 0;
    if (begins_within && wh_measure_lasts(measure, turn->begin_ticks + turn->turn_ticks)) {
        if (WH_RIG_SMALL_PIECES) {
            measure->adds = true;
        } else {
            add_turn(config, measure);
        }
    }
}

void wh_measure_record(const wh_measure_config *config, wh_measure *measure, wh_real speed_radps,
                       uint32_t now_ticks) {
    const wh_real turns_s = config->record_turns * WH_RIG_TWO_PI / speed_radps;
    measure->record_s = turns_s > config->record_s ? turns_s : config->record_s;
    measure->merge = (wh_merge){.turns = 0};
    measure->result = (wh_rig_result){.lost = 0};
    measure->records = true;
    measure->begin_ticks = now_ticks;
    measure->due = 0;
    measure->adds = false;
    measure->peaks = false;
    measure->ends = false;
    measure->skipped_before = measure->lockin.skipped;
}

bool wh_measure_end(wh_measure *measure, uint32_t now_ticks) {
    const bool late =
        wh_rig_is_over(measure->begin_ticks, now_ticks, measure->record_s + LAST_TURN_MAX_S);
    if (!measure->ends && (measure->lockin.stage == WH_LOCKIN_WAITS || late) && measure->due == 0 &&
        !measure->adds) {
        measure->ends = true;
        measure->due = (uint8_t)END_PIECES;
    }
    if (!measure->ends || measure->due > 0) {
        return false;
    }
    measure->result.tare_N = measure->tare.mean_N;
    measure->result.tare_error_N = wh_tare_error_N(&measure->tare);
    measure->records = false;
    return true;
}

/* === the tare ================================================================================ */

/* Four times the variance of end_block()'s means, if the samples are white noise of variance 1. */
#define SLOW_NOISE (WH_R(8.0) / (WH_R(3.0) * (wh_real)WH_TARE_BLOCK))

/* Ends a block: takes the mean of this block and the previous one, with triangular weights. */
static void end_block(wh_tare *tare) {
    if (tare->count > WH_TARE_BLOCK) {
        const wh_real mean = (tare->before_N + tare->falls_N) / (wh_real)WH_TARE_BLOCK;
        const wh_real off = mean - tare->slow_N;
        tare->means++;
        tare->slow_N += off / (wh_real)tare->means;
        tare->slow_N2 += off * (mean - tare->slow_N);
    }
    tare->before_N = tare->rises_N;
    tare->rises_N = tare->falls_N = WH_R(0.0);
}

void wh_tare_add(wh_tare *tare, wh_real force_N) {
    if (tare->count > 0) {
        const wh_real change = force_N - tare->last_N;
        tare->changes_N2 += change * change;
    }
    tare->last_N = force_N;
    const wh_real weight =
        ((wh_real)(tare->count % WH_TARE_BLOCK) + WH_R(0.5)) / (wh_real)WH_TARE_BLOCK;
    tare->rises_N += weight * force_N;
    tare->falls_N += (WH_R(1.0) - weight) * force_N;
    tare->count++;
    if (tare->count % WH_TARE_BLOCK == 0) {
        end_block(tare);
    }
    const wh_real off = force_N - tare->mean_N;
    tare->mean_N += off / (wh_real)tare->count;
    tare->square_N2 += off * (force_N - tare->mean_N);
}

WH_CALLED wh_real wh_tare_error_N(const wh_tare *tare) {
    if (tare->count < 2U) {
        return WH_R(0.0);
    }
    const wh_real n = (wh_real)tare->count;
    return WH_SQRT(tare->square_N2 / (n * (n - WH_R(1.0))));
}

bool wh_tare_is_still(const wh_tare_config *config, const wh_tare *tare) {
    if (tare->means < 3U) {
        return false;
    }
    const wh_real slow = tare->slow_N2 / (wh_real)(tare->means - 1U);
    const wh_real noise = WH_R(0.5) * tare->changes_N2 / (wh_real)(tare->count - 1U);
    return slow <= SLOW_NOISE * noise + config->still_N * config->still_N &&
           wh_tare_error_N(tare) <= config->most_N;
}
