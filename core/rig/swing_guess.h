/* swing_guess.h: the first guess of a free swing, from the times of its pulses alone: see free_swing.h, whose part it is. */
#ifndef WH_RIG_SWING_GUESS_H
#define WH_RIG_SWING_GUESS_H

#include "swing_state.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_SWING_STARTS 3U /* guesses, one after the other */

#define wh_swing_leave_top WH_NAME(wh_swing_leave_top)
#define wh_swing_guess WH_NAME(wh_swing_guess)

/* Near the top times tell all of the amplitude, and guesses of them nothing: a pass begins behind such swings. */
void wh_swing_leave_top(const wh_swing_config *config, wh_swing *swing);

/* x, what it may be off by, and both as the regression begins with; swing->start counts the guesses. */
void wh_swing_guess(const wh_swing_config *config, wh_swing *swing);

#ifdef __cplusplus
}
#endif

#endif
