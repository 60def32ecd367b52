/* pulse_window.c: bounds on the speed and time of the next slot pulse. */
#include "pulse_window.h"

#include "datasheet.h"

#define SETTLE_WINDOW WH_R(0.03)
/* share of a turn by which a pulse may be early, except in settling and recording */
#define RAMP_WINDOW WH_R(0.12)
#define RECORD_PART WH_R(0.8) /* share of the record's speed band by which a pulse may be early */
/* The bound for the first pulses from rest is this part of the commanded speed, because the rotor lags behind. */
#define FIRST_PART WH_R(0.8)
/* The last one or two pulses of a braked rotor come at less than this speed. */
#define SLOW_RADPS WH_R(16.0)

void wh_pulse_window_set(const wh_guard_config *guard, const wh_run_config *running, wh_run *run,
                         wh_pulses *pulses, bool open, uint32_t ticks) {
    const wh_rig_phase phase = run->phase;
    const wh_speed *speed = &pulses->speed;
    const wh_setpoint setpoint = wh_run_setpoint(running, run, ticks);
    const bool from_rest = phase == WH_PHASE_SPIN_UP && !speed->known;
    const wh_real part = from_rest && speed->taken < 2U ? FIRST_PART : WH_R(1.0);
    const wh_real falls = from_rest ? WH_R(0.0) : open ? WH_GUARD_LIGHTER : WH_R(1.0);
    pulses->bound_radps = wh_guard_bound_radps(guard, part * setpoint.limit_radps, falls);
    pulses->climb_radps2 =
        setpoint.jumps ? guard->climb_start_radps2
                       : wh_guard_climb_radps2(guard, setpoint.setpoint_radps - speed->turn_radps,
                                               wh_run_is_closed(run));
    /* This bound falls with the rotor's speed and rises only with the commanded speed, so a runaway drive does not
     * raise it. */
    run->left_radps = speed->known && speed->turn_radps < setpoint.limit_radps
                          ? speed->turn_radps
                          : setpoint.limit_radps;
    pulses->window = phase == WH_PHASE_RECORD
                         ? RECORD_PART * running->record_band_radps / run->target_radps
                         : (phase == WH_PHASE_SETTLE ? SETTLE_WINDOW : RAMP_WINDOW);
}

void wh_pulse_window_off(wh_run *run, wh_pulses *pulses, bool brakes, unsigned sensor,
                         uint32_t ticks) {
    static const wh_real moved_rad[] = {WH_R(0.75) * WH_RIG_TWO_PI, WH_R(0.25) * WH_RIG_TWO_PI};
    if (!pulses->speed.running || sensor >= WH_SPEED_SENSORS) {
        return;
    }
    /* This is also true if a suspect came between the last pulse and this one. */
    const bool same = sensor == pulses->last.pulse.sensor;
    const bool again = same && !pulses->suspects;
    const wh_real moved = same ? WH_RIG_TWO_PI : moved_rad[sensor];
    const wh_real passed_s = wh_rig_since_s(pulses->speed.ticks, ticks);
    /* The motor must have been off for the whole interval, because a driven rotor may have gained speed. */
    const bool coasted = (int32_t)(pulses->speed.ticks - run->since_ticks) >= 0;
    if (coasted && moved < run->off_radps * passed_s) {
        run->off_radps = moved / passed_s;
    }
    if (again) {
        wh_pulses_forget(pulses);
    }
    /* `slow` is set only while the motor brakes, because a rotor that swings freely passes the sensors to and fro, and
     * its intervals are no speeds. It is set only at sensor 1: a rotor that does not get over the top falls a quarter
     * turn back to sensor 0, which looks like three quarters forward. */
    pulses->slow =
        run->phase == WH_PHASE_OFF && brakes && sensor == 1U && run->off_radps < SLOW_RADPS;
}
