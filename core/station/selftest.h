/* selftest.h: the console's command `selftest`: checks of the rig at rest. */
#ifndef WH_STATION_SELFTEST_H
#define WH_STATION_SELFTEST_H

#include "core/text.h"
#include "step_inputs.h"

/* Answers "OK selftest=good|bad", then the result of each part, from the values of the last control step. A part is
 * good if:
 *
 *     arithmetic  the observer's scene gives the reference results (core/number/arithmetic.h), or there is none
 *     clock       the clock is not the fallback clock
 *     watchdog    the watchdog has not cut the drive
 *     supply      the supply voltage is within its range
 *     cell        the cell gives good samples, and the last one lies within half of its range
 *     stop        stop is not pressed
 *     rotor       the rotor rests
 *     swing       the last free swing found sensor 1 where the settings have it; or there was none */
void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_step_inputs *seen,
                        wh_text *answer);

#endif
