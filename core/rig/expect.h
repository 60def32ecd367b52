/* expect.h: how fast, and how early, may the next slot pulse come? By where the rotor is led. */
#ifndef WH_RIG_EXPECT_H
#define WH_RIG_EXPECT_H

#include "guard.h"
#include "phases.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_expect_pulses WH_NAME(wh_expect_pulses)
#define wh_expect_slower WH_NAME(wh_expect_slower)

/* Before a pulse captured at `ticks` is taken: bounds and window for it, and what is left of the rotor's speed by then.
 * `open`: the enable is off, and a light rotor falls faster than one that a motor holds back. */
void wh_expect_pulses(const wh_guard_config *guard, const wh_run_config *running, wh_run *run,
                      wh_pulses *pulses, bool open, uint32_t ticks);

/* Before that, with the motor off: nothing makes the rotor faster again than it was between its last two pulses, but
 * gravity. A sensor that fires again is one in whose slot it swings, or has missed a pulse: what was known of its speed is
 * nothing now. `brakes`: a rotor that all but rests stays so. */
void wh_expect_slower(wh_run *run, wh_pulses *pulses, bool brakes, unsigned sensor, uint32_t ticks);

#ifdef __cplusplus
}
#endif

#endif
