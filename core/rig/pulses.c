/* pulses.c: separates true slot pulses from disturbances. */
#include "pulses.h"

#include "datasheet.h"

#define TWICE_PART WH_R(0.5) /* least part of a turn between two true pulses of a sensor */
#define ALERT_PART WH_R(0.005)
#define CLIMB_PART WH_R(0.01)
#define BOUNCE_PART WH_R(0.02)
#define DOUBT 2U
/* If pulses->slow, a speed above this multiple of bound_radps adds 2 to pulses->fast. */
#define SUDDEN WH_R(1.6)
#define SURE_PART WH_R(0.125) /* a pulse is confirmed after this part of a turn */

void wh_pulses_start(wh_pulses *pulses, wh_real impossible_radps) {
    *pulses = (wh_pulses){.window = WH_R(1.0)};
    wh_speed_start(&pulses->speed, impossible_radps);
    wh_speed_start(&pulses->before, impossible_radps);
}

void wh_pulses_forget(wh_pulses *pulses) {
    wh_pulses_start(pulses, pulses->speed.impossible_radps);
}

static WH_CALLED wh_real turn_ticks(const wh_speed *speed) {
    return WH_RIG_TWO_PI / speed->turn_radps * (wh_real)WH_RIG_TICKS_PER_S;
}

/* The pulse is expected `turn` ticks after the previous pulse of its sensor. Returns by how many ticks it is early, or
 * 0 if the previous pulse is unknown. */
static wh_real early_ticks(const wh_speed *speed, const wh_pulse *pulse, wh_real turn) {
    if (!speed->known || !speed->seen[pulse->sensor] ||
        speed->quarter - speed->seen_quarter[pulse->sensor] > 3U) {
        return WH_R(0.0);
    }
    return turn - (wh_real)(pulse->ticks - speed->seen_ticks[pulse->sensor]);
}

static void release(wh_pulses *pulses) {
    if (pulses->waits && pulses->confirmed_count < WH_PULSES_CONFIRMED) {
        pulses->confirmed[pulses->confirmed_count++] = pulses->last;
    }
    pulses->waits = false;
}

bool wh_pulses_sure(wh_pulses *pulses, uint32_t now_ticks, wh_index_pulse *index) {
    if (pulses->waits && pulses->speed.known &&
        (wh_real)(int32_t)(now_ticks - pulses->last.pulse.ticks) >
            SURE_PART * turn_ticks(&pulses->speed)) {
        release(pulses);
    }
    if (pulses->confirmed_count == 0) {
        return false;
    }
    *index = pulses->confirmed[0];
    pulses->confirmed_count--;
    for (unsigned i = 0; i < pulses->confirmed_count; i++) {
        pulses->confirmed[i] = pulses->confirmed[i + 1U];
    }
    return true;
}

static bool is_fast(const wh_pulses *pulses, const wh_speed *speed) {
    return pulses->bound_radps > WH_R(0.0) && speed->interval_radps > pulses->bound_radps;
}

static WH_CALLED bool is_sudden(const wh_pulses *pulses, const wh_speed *speed) {
    return pulses->slow && speed->interval_radps > SUDDEN * pulses->bound_radps;
}

/* Accepts a pulse that changes the speed from pulses->before to `after`. */
static void accept(wh_pulses *pulses, const wh_pulse *pulse, const wh_speed *after) {
    const wh_speed *before = &pulses->before;
    const bool alternates = after->lost == before->lost && before->running;
    pulses->fast =
        is_fast(pulses, after) ? pulses->fast + (is_sudden(pulses, after) ? 2U : 1U) : 0U;
    pulses->alternate = alternates ? pulses->alternate + 1U : 0U;
    const wh_real may = pulses->climb_radps2 * wh_rig_since_s(before->ticks, after->ticks);
    const wh_real beyond = after->turn_radps - before->turn_radps - may;
    pulses->climb_radps = before->known && after->known && beyond > WH_R(0.0) ? beyond : WH_R(0.0);
    pulses->last = (wh_index_pulse){
        .pulse = *pulse, .quarter = after->quarter, .gap = after->restarts != before->restarts};
    pulses->waits = true;
    pulses->speed = *after;
}

/* Computes the speed after one more pulse. Returns false if the pulse is impossible. */
static bool with(const wh_speed *speed, const wh_pulse *pulse, wh_speed *after) {
    *after = *speed;
    return wh_speed_pulse(after, pulse->sensor, pulse->ticks);
}

static bool is_likely(const wh_pulses *pulses, const wh_speed *speed) {
    return speed->interval_radps > WH_R(0.0) && !is_fast(pulses, speed);
}

static void take_next(wh_pulses *pulses, const wh_pulse *pulse, const wh_speed *after) {
    release(pulses);
    pulses->before = pulses->speed;
    pulses->climb_before_radps = pulses->climb_radps;
    accept(pulses, pulse, after);
}

static WH_CALLED void reject(wh_pulses *pulses, unsigned doubt) {
    pulses->rejected++;
    pulses->doubt += doubt;
}

/* Accepts or rejects the suspect. `pulse` is the next pulse after the suspect. */
static void decide(wh_pulses *pulses, const wh_pulse *pulse) {
    const wh_pulse suspect = pulses->suspect;
    wh_speed without;
    wh_speed both;
    pulses->suspects = false;
    pulses->alert = false;
    const bool alone_likely = with(&pulses->speed, pulse, &without) && is_likely(pulses, &without);
    const bool both_are = with(&pulses->suspected, pulse, &both);
    const bool fits = both_are && both.lost == pulses->speed.lost &&
                      (is_likely(pulses, &both) || without.lost > pulses->speed.lost);
    if (alone_likely && (pulse->sensor == suspect.sensor || !fits)) {
        reject(pulses, DOUBT);
        take_next(pulses, pulse, &without);
        return;
    }
    take_next(pulses, &suspect, &pulses->suspected);
    if (both_are) {
        take_next(pulses, pulse, &both);
    } else {
        reject(pulses, DOUBT);
    }
}

/* Did the sensor of the last pulse fire again before `part` times `turn` ticks had passed? */
static WH_CALLED bool soon_after(const wh_pulses *pulses, const wh_pulse *pulse, wh_real part,
                                 wh_real turn) {
    const wh_pulse *last = &pulses->last.pulse;
    return pulses->waits && pulses->speed.known && pulse->sensor == last->sensor &&
           (wh_real)(pulse->ticks - last->ticks) < part * turn;
}

/* Handles a pulse that comes impossibly soon after the last one. One of the two is false. */
static void compare(wh_pulses *pulses, const wh_pulse *pulse, wh_real turn) {
    wh_speed instead;
    reject(pulses, soon_after(pulses, pulse, BOUNCE_PART, turn) ? 0U : DOUBT);
    if (!pulses->waits || pulse->sensor != pulses->last.pulse.sensor ||
        !with(&pulses->before, pulse, &instead) || !is_likely(pulses, &instead)) {
        return;
    }
    const wh_real before = turn_ticks(&pulses->before);
    const wh_real last = early_ticks(&pulses->before, &pulses->last.pulse, before);
    const wh_real this = early_ticks(&pulses->before, pulse, before);
    if (WH_ABS(this) < WH_ABS(last)) {
        accept(pulses, pulse, &instead);
    }
}

void wh_pulses_take(wh_pulses *pulses, unsigned sensor, uint32_t ticks) {
    const wh_pulse pulse = {.ticks = ticks, .sensor = sensor};
    if (pulses->suspects) {
        decide(pulses, &pulse);
        return;
    }
    wh_speed after;
    const wh_real turn = pulses->speed.known ? turn_ticks(&pulses->speed) : WH_R(0.0);
    if (soon_after(pulses, &pulse, TWICE_PART, turn) || !with(&pulses->speed, &pulse, &after)) {
        compare(pulses, &pulse, turn);
        return;
    }
    const wh_real early =
        pulses->speed.known ? early_ticks(&pulses->speed, &pulse, turn) / turn : WH_R(0.0);
    /* The second early pulse in succession is trusted, because the rotor is faster. */
    const bool trusted =
        !pulses->speed.running || pulses->fast > 0 || pulses->alert || is_sudden(pulses, &after);
    pulses->alert = early > ALERT_PART;
    if (!trusted && (is_fast(pulses, &after) || early > pulses->window)) {
        pulses->suspect = pulse;
        pulses->suspected = after;
        pulses->suspects = true;
        return;
    }
    pulses->doubt -= pulses->doubt > 0 ? 1U : 0U;
    take_next(pulses, &pulse, &after);
    if (pulses->climb_radps > CLIMB_PART * after.turn_radps) {
        pulses->alert = true;
    }
}
