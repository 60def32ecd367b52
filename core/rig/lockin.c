/* lockin.c: amplitude of the load's once-per-turn part, and its phase to the masses. */
#include "lockin.h"

#include "core/angle.h"
#include "datasheet.h"

#define PI WH_R(3.141592653589793)

void wh_polar(wh_real x, wh_real y, wh_real *radius, wh_real *angle_rad) {
    wh_real angle = WH_R(0.0);
    if (WH_ABS(y) > WH_ABS(x)) {
        angle = y < WH_R(0.0) ? WH_R(-0.5) * PI : WH_R(0.5) * PI;
    } else if (x < WH_R(0.0)) {
        angle = y < WH_R(0.0) ? -PI : PI;
    }
    wh_real along = WH_R(0.0);
    /* |t| <= 1 at first and each round takes it to about its fifth power: four are plenty */
    for (unsigned round = 0; round < 4; round++) {
        wh_real sine;
        wh_real cosine;
        wh_sincos(wh_phase_from_rad(angle), &sine, &cosine);
        along = x * cosine + y * sine;
        if (!(along > WH_R(0.0))) {
            break;
        }
        const wh_real t = (y * cosine - x * sine) / along;
        angle += t * (WH_R(1.0) - t * t * (WH_R(1.0) / WH_R(3.0)));
    }
    *radius = along;
    *angle_rad = angle;
}

/* Position of a time in the record, samples from the first; negative before it. */
static wh_real sample_at(const wh_load_record *record, uint32_t ticks) {
    return (wh_real)(int32_t)(ticks - record->first_ticks) / (wh_real)record->period_ticks;
}

static bool within(const wh_load_record *record, uint32_t ticks) {
    const int64_t after = (int32_t)(ticks - record->first_ticks);
    return record->samples > 0 && after >= 0 &&
           after <= (int64_t)record->period_ticks * (int64_t)(record->samples - 1U);
}

bool wh_load_at(const wh_load_record *record, uint32_t ticks, wh_real *counts) {
    if (!within(record, ticks)) {
        return false;
    }
    const wh_real at = sample_at(record, ticks);
    const unsigned before = (unsigned)at;
    const wh_real left = (wh_real)record->raw[before];
    const wh_real right = before + 1U < record->samples ? (wh_real)record->raw[before + 1U] : left;
    *counts = left + (at - (wh_real)before) * (right - left);
    return true;
}

/* Whole turns from one mark to a later one of the same sensor. */
static uint32_t turns_between(const wh_mark *from, const wh_mark *to) {
    return (to->quarter - from->quarter) / 4U;
}

bool wh_lockin(const wh_load_record *record, const wh_mark *marks, unsigned mark_count,
               wh_real mark_rad, wh_lockin_result *result) {
    unsigned begin = 0;
    while (begin < mark_count && !within(record, marks[begin].ticks)) {
        begin++;
    }
    unsigned end = mark_count;
    while (end > begin && !within(record, marks[end - 1U].ticks)) {
        end--;
    }
    if (end < begin + 2U) {
        return false;
    }
    const unsigned last_mark = end - 1U;
    const wh_real from = sample_at(record, marks[begin].ticks);
    const wh_real to = sample_at(record, marks[last_mark].ticks);
    unsigned first = (unsigned)from;
    if ((wh_real)first < from) {
        first++;
    }
    const unsigned last = (unsigned)to;
    if (last <= first) {
        return false;
    }
    /* A turn is no whole number of samples: the end samples stand for what is left over too. */
    const wh_real first_weight = WH_R(0.5) + ((wh_real)first - from);
    const wh_real last_weight = WH_R(0.5) + (to - (wh_real)last);

    wh_real weights = WH_R(0.0);
    wh_real mean = WH_R(0.0);
    for (unsigned i = first; i <= last; i++) {
        const wh_real weight = i == first ? first_weight : i == last ? last_weight : WH_R(1.0);
        weights += weight;
        mean += weight * (wh_real)record->raw[i];
    }
    mean /= weights;

    wh_real in_phase = WH_R(0.0);
    wh_real quadrature = WH_R(0.0);
    unsigned mark = begin;
    for (unsigned i = first; i <= last; i++) {
        const uint32_t ticks = record->first_ticks + i * record->period_ticks;
        while (mark + 1U < last_mark && (int32_t)(ticks - marks[mark + 1U].ticks) >= 0) {
            mark++;
        }
        const wh_mark *from_mark = &marks[mark];
        const wh_mark *to_mark = &marks[mark + 1U];
        const wh_real turned = (wh_real)turns_between(from_mark, to_mark) *
                               (wh_real)(int32_t)(ticks - from_mark->ticks) /
                               (wh_real)(to_mark->ticks - from_mark->ticks);
        wh_real sine;
        wh_real cosine;
        wh_sincos(wh_phase_from_rad(mark_rad + WH_RIG_TWO_PI * turned), &sine, &cosine);
        const wh_real weight = i == first ? first_weight : i == last ? last_weight : WH_R(1.0);
        const wh_real load = weight * ((wh_real)record->raw[i] - mean);
        in_phase += load * cosine;
        quadrature += load * sine;
    }
    result->turns = (unsigned)turns_between(&marks[begin], &marks[last_mark]);
    result->turn_s = (wh_real)(marks[last_mark].ticks - marks[begin].ticks) /
                     ((wh_real)result->turns * (wh_real)WH_RIG_TICKS_PER_S);
    result->mean_counts = mean;
    result->in_phase_counts = WH_R(2.0) * in_phase / weights;
    result->quadrature_counts = WH_R(2.0) * quadrature / weights;
    wh_polar(result->in_phase_counts, -result->quadrature_counts, &result->amplitude_counts,
             &result->phase_rad);
    return true;
}
