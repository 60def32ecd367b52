/* pulse_window.h: bounds on the speed and time of the next slot pulse, from the drive's set-point. */
#ifndef WH_RIG_PULSE_WINDOW_H
#define WH_RIG_PULSE_WINDOW_H

#include "guard.h"
#include "phases.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_pulse_window_set WH_NAME(wh_pulse_window_set)
#define wh_pulse_window_off WH_NAME(wh_pulse_window_off)

/* With the motor on: call it before wh_pulses_take() for the pulse captured at `ticks`. Sets the pulse's bounds and
 * window, and the upper bound on the speed that remains from an earlier set-point. `open`: the enable is off; a light
 * rotor then slows faster than one that a motor brakes. */
void wh_pulse_window_set(const wh_guard_config *guard, const wh_run_config *running, wh_run *run,
                         wh_pulses *pulses, bool open, uint32_t ticks);

/* With the motor off: call it before wh_pulses_take(). Only gravity can make the rotor faster than between its last two
 * pulses. If a sensor fires twice in succession, the rotor swings in the slot or a pulse was missed: the speed is then
 * unknown. `brakes`: the motor brakes, so a rotor that is almost at rest stays slow. */
void wh_pulse_window_off(wh_run *run, wh_pulses *pulses, bool brakes, unsigned sensor,
                         uint32_t ticks);

#ifdef __cplusplus
}
#endif

#endif
