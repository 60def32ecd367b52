/* selftest.h: the console's command `selftest`: checks of the rig at rest. */
#ifndef WH_STATION_SELFTEST_H
#define WH_STATION_SELFTEST_H

#include "core/text.h"
#include "step_inputs.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_selftest_answer WH_NAME(wh_selftest_answer)

/* Answers "OK selftest=good|bad", then the result of each part, from the values of the last control step:
 *
 *   arithmetic  of the observer's scene, if there is one, gives the reference results (core/number/arithmetic.h)
 *   clock       is not the fallback clock
 *   watchdog    has not cut the drive
 *   supply      within its range
 *   cell        gives good samples, and the last one lies within half of its range
 *   stop        not pressed
 *   rotor       rests
 *   swing       the last free swing found sensor 1 where the settings have it; or `none`, which counts as good
 * */
void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_step_inputs *seen,
                        wh_text *answer);

#ifdef __cplusplus
}
#endif

#endif
