/* selftest.h: the console's command `selftest`: what can be known of the rig while it rests. */
#ifndef WH_STATION_SELFTEST_H
#define WH_STATION_SELFTEST_H

#include "core/text.h"
#include "seen.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_selftest_answer WH_NAME(wh_selftest_answer)

/* "OK selftest=good|bad", then each part, with what was seen in the last control step:
 *
 *   arithmetic  of the observer's scene, where there is one, is that of the tests (core/arithmetic.h)
 *   clock       not its fallback
 *   watchdog    has not cut the drive
 *   supply      within its range
 *   cell        gives good samples, and the last one lies within half of its range
 *   stop        not pressed
 *   rotor       rests
 *   swing       where sensor 1 stands, as the last free swing told, is where the settings have it; or `none`, which
 *               speaks neither for nor against it */
void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_seen *seen,
                        wh_text *answer);

#ifdef __cplusplus
}
#endif

#endif
