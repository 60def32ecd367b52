/* pulse_window.h: bounds on the speed and time of the next slot pulse, from the drive's set-point. */
#ifndef WH_RIG_PULSE_WINDOW_H
#define WH_RIG_PULSE_WINDOW_H

#include "guard.h"
#include "phases.h"

WH_C_BEGIN

/* Call this, with the motor on or off, before wh_pulses_take() for the pulse captured at `ticks`. It sets the pulse's
 * bounds and window, and the upper bound on the speed that remains from an earlier set-point. `open` is true if the
 * motor neither drives nor brakes: the bound then allows for a lighter rotor, whose speed gravity changes more. */
void wh_pulse_window_set(const wh_guard_config *guard, const wh_run_config *running, wh_run *run,
                         wh_pulses *pulses, bool open, uint32_t ticks);

/* Call this, with the motor off, before wh_pulses_take(). Since the last two pulses, only gravity can have made the
 * rotor faster. If a sensor fires twice in succession, the rotor swings in the slot or a pulse was missed: the speed is
 * then unknown. `brakes` is true if the motor brakes: only then pulses->slow is set. */
void wh_pulse_window_off(wh_run *run, wh_pulses *pulses, bool brakes, unsigned sensor,
                         uint32_t ticks);

WH_C_END

#endif
