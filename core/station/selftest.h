/* selftest.h: checks of the rig at rest, for the console's command `selftest`. */
#ifndef WH_STATION_SELFTEST_H
#define WH_STATION_SELFTEST_H

#include "core/text.h"
#include "step_inputs.h"

/* Adds " selftest=good|bad", then the result of each part, from the values of the last control step. A part is good if:
 *
 *     arithmetic  the observer's scene, if any, gives the reference results (core/number/arithmetic.h)
 *     clock       the clock is not the fallback clock
 *     watchdog    the watchdog has not cut the drive
 *     supply      the supply voltage is within its range
 *     cell        the cell gives good samples, and the last one is below half of full scale
 *     stop        stop is not pressed
 *     rotor       the rotor rests
 *     swing       the last free swing, if any, agrees with the setting of sensor 1's angle */
void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_step_inputs *seen,
                        wh_text *answer);

#endif
