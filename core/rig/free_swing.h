/* free_swing.h: where the sensors stand, from the swing in which a rotor comes to rest.
 *
 * Nothing that a run measures tells a sensor that stands off its place from a force that is out of line with the masses:
 * the phase is off by as much. What tells is where the arms hang. Once the motor's leads are open nothing but gravity
 * and friction moves the rotor (free_rotor.h). With q(t) -q(t) is a motion of it, too: between two passages of q = 0 it
 * takes as long on the right as on the left, friction or not, but for what a swing loses to the next. A sensor at p is
 * passed at p - lead to the right and at p + lead to the left, since pulses come at the slot's leading edge. So the lead
 * cancels, and half a swing on the right is shorter than one on the left by 4 p/v, v the speed at the bottom: a slow rotor
 * shows most.
 *
 * That takes v beside times, thus an amplitude A. By the pendulum's first integral v^2 = 4 g sin^2(A/2), and half a swing
 * takes 2 K(sin(A/2))/sqrt(g), K the complete elliptic integral of the first kind. The last swings are small: their
 * period gives g = S g0/I, the first one's time then its amplitude, and how many there are the friction. This is a guess within
 * some 10 %, from pulses alone. Made exact it is by regression: Gauss's, of the times of all pulses, for q, q' at the
 * first passage of the bottom backwards, g, Coulomb's and viscous friction over I, and both sensors' places, along the
 * equation of motion, forwards to the swings and backwards to the last turns. There, and where the amplitude is above 90 deg,
 * sensor 2 is passed, and two angles are known instead of one. Pulses that are far off end a pass; the first passes count
 * all of them as uncertain by some degrees, less from pass to pass: in one go it would not always get there.
 *
 * The interval is that of the regression, wider by what the pulses are off more than they should be, and the floor.
 *
 * While the rotor swings its pulses are kept. Once it rests each control step does a piece of a pass: three steps of the
 * equation, or one pulse, or a part of the equations' solution; in all that is some seconds. */
#ifndef WH_RIG_FREE_SWING_H
#define WH_RIG_FREE_SWING_H

#include "result.h"
#include "swing_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 0, as a small chip's build may say: no swing is looked at. */
#ifndef WH_RIG_SWINGS
#define WH_RIG_SWINGS 1
#endif

#define wh_swing_pulse WH_NAME(wh_swing_pulse)
#define wh_swing_step WH_NAME(wh_swing_step)
#define wh_swing_doubt WH_NAME(wh_swing_doubt)
#define wh_swing_text WH_NAME(wh_swing_text)

/* A pulse of sensor 0 or 1 as it comes, in order of time. */
void wh_swing_pulse(wh_swing *swing, unsigned sensor, uint32_t ticks);

/* Every control step. `swings`: the rotor turned forwards, or has by now swung out, after a run, and since then the motor's leads
 * are open. Once they are not, it rests if `rests`; else it was stopped, and that was no free swing. A bounded
 * piece of the work is done in each step in which it rests, while wh_swing_works(). */
void wh_swing_step(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing,
                   bool swings, bool rests);

/* There are pulses that are still being looked at. */
WH_INLINE bool wh_swing_works(const wh_swing *swing) { return swing->result.why == WH_SWING_WORKS; }

/* Where sensor 1 was found off its place a good result is doubtful: its phase is off by as much. */
void wh_swing_doubt(const wh_swing_config *config, const wh_swing *swing, wh_measured *measured);

/* In words, for consoles. */
const char *wh_swing_text(wh_swing_why why);

#ifdef __cplusplus
}
#endif

#endif
