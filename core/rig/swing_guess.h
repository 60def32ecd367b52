/* swing_guess.h: the first guess of a free swing, from its pulses' times alone. Part of free_swing.h. */
#ifndef WH_RIG_SWING_GUESS_H
#define WH_RIG_SWING_GUESS_H

#include "swing_state.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_SWING_STARTS 3U /* guesses, one after the other */

#define wh_swing_leave_top WH_NAME(wh_swing_leave_top)
#define wh_swing_guess WH_NAME(wh_swing_guess)

/* Near the top, guesses of the amplitude are useless, because it depends steeply on times: a pass begins after such
 * swings. */
void wh_swing_leave_top(const wh_swing_config *config, wh_swing *swing);

/* x and its uncertainty, with which the regression begins; swing->start counts the guesses. */
void wh_swing_guess(const wh_swing_config *config, wh_swing *swing);

#ifdef __cplusplus
}
#endif

#endif
