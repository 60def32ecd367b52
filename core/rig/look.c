/* look.c: read-out of the controller's state: stage, speed, a result's age, the likely cause of a trip. */
#include "rig.h"

WH_CALLED unsigned wh_rig_stage(const wh_rig *rig) {
    return rig->run.phase == WH_PHASE_NONE ? (unsigned)rig->state
                                           : WH_RIG_STAGE_OF_PHASE + (unsigned)rig->run.phase;
}

WH_CALLED unsigned wh_rig_shown_stage(const wh_rig *rig) {
    return rig->command.way == WH_MOTOR_BRAKES && rig->run.phase == WH_PHASE_OFF
               ? WH_RIG_STAGE_BRAKES
               : wh_rig_stage(rig);
}

WH_CALLED const char *wh_rig_stage_text(unsigned stage) {
    return stage < WH_RIG_STAGE_OF_PHASE
               ? wh_rig_state_text((wh_rig_state)stage)
               : wh_phase_text((wh_rig_phase)(stage - WH_RIG_STAGE_OF_PHASE));
}

uint32_t wh_rig_result_age_s(const wh_rig *rig, uint32_t now_ticks) {
    return rig->result_s + (now_ticks - rig->result_ticks) / WH_RIG_TICKS_PER_S;
}

/* --- the last pulses ------------------------------------------------------------------------------ */

#define HEARD_TICKS (8U * WH_RIG_TICKS_PER_S)

/* Four pulses of alternating sensors: the ticks between them, the newest first, and the sensor of the last. */
static bool last_ways(const wh_rig *rig, uint32_t now_ticks, uint32_t *way, unsigned *last) {
    *last = (int32_t)(rig->heard_ticks[1][0] - rig->heard_ticks[0][0]) > 0 ? 1U : 0U;
    const uint32_t *newest = rig->heard_ticks[*last];
    const uint32_t *other = rig->heard_ticks[1U - *last];
    way[0] = newest[0] - other[0];
    way[1] = other[0] - newest[1];
    way[2] = newest[1] - other[1];
    bool alternate =
        rig->pulses_ever - rig->pulses_before >= 4U && now_ticks - other[1] < HEARD_TICKS;
    for (unsigned i = 0; i < 3U; i++) {
        alternate = alternate && way[i] > 0 && way[i] < HEARD_TICKS;
    }
    return alternate;
}

bool wh_rig_speed(const wh_rig *rig, uint32_t now_ticks, wh_real *speed_radps) {
    uint32_t way[3];
    unsigned last;
    const bool drives = wh_run_drives(&rig->run);
    *speed_radps = rig->pulses.speed.known ? rig->pulses.speed.turn_radps : WH_R(0.0);
    if (!drives && rig->guard.quiet) {
        return true;
    }
    /* speed.h takes a rotor that slows down over the top for a gap, and keeps the speed before it */
    if (!drives && last_ways(rig, now_ticks, way, &last)) {
        *speed_radps = WH_RIG_TWO_PI * (wh_real)WH_RIG_TICKS_PER_S / (wh_real)(way[0] + way[1]);
        return true;
    }
    return rig->pulses.speed.known;
}

/* --- the likely cause of a trip ------------------------------------------------------------------- */

/* A whole turn at 3,200 rpm: the fastest motor of the settings (2,000 rpm) at the highest supply turns slower. */
#define STORM_TICKS 18750U

/* The direction: forwards, from sensor 1 to sensor 2 is a quarter turn, backwards three quarters. It must take longer
 * than both ways back, because a starting rotor changes its speed. Pulses faster than any rotor show no direction. */
static bool order_is_wrong(const wh_rig *rig, uint32_t now_ticks) {
    uint32_t way[3];
    unsigned last;
    if (!last_ways(rig, now_ticks, way, &last)) {
        return false;
    }
    if (way[0] + way[1] < STORM_TICKS || way[1] + way[2] < STORM_TICKS) {
        return false;
    }
    return last == 1U ? way[0] > way[1] && way[2] > way[1] : way[1] > way[0] && way[1] > way[2];
}

/* The rotor starts or was just taken over: the commanded voltage leads it, not yet the loop. A falling bound then shows
 * after two further pulses. */
#define TWO_PULSES_S WH_R(0.5)

static bool starts(const wh_rig *rig, uint32_t now_ticks) {
    return rig->run.phase == WH_PHASE_SPIN_UP ||
           !wh_rig_is_over(rig->run.closed_ticks, now_ticks, WH_RUN_START_S + TWO_PULSES_S);
}

wh_trip wh_rig_cause(const wh_rig_config *config, const wh_rig *rig, uint32_t now_ticks) {
    const wh_trip trip = rig->guard.trip;
    const bool of_pulses = trip == WH_TRIP_OVERSPEED || trip == WH_TRIP_PULSES ||
                           trip == WH_TRIP_STALLED || trip == WH_TRIP_UNSETTLED;
    if (!of_pulses || !wh_run_drives(&rig->run)) {
        return trip;
    }
    if (order_is_wrong(rig, now_ticks)) {
        return WH_TRIP_ORDER;
    }
    return trip == WH_TRIP_OVERSPEED && starts(rig, now_ticks) &&
                   !(rig->pulses.speed.turn_radps > config->guard.limit_radps)
               ? WH_TRIP_FASTER
               : trip;
}
