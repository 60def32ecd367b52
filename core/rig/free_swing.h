/* free_swing.h: the sensors' positions, from the free swing of a rotor that comes to rest.
 *
 * No quantity of a run distinguishes a misplaced sensor from a force out of line with the masses: both shift the phase
 * equally. The hanging position of the arms does. With the motor's leads open, only gravity and friction move the rotor
 * (free_rotor.h). If q(t) is a motion, -q(t) is one, too. So between two passages of q = 0 it takes as long on the right as
 * on the left, with or without friction, except for the loss from swing to swing. Pulses come at the slot's leading edge: a
 * sensor at p is passed at p - lead to the right and at p + lead to the left. So the lead cancels, and half a swing on the
 * right is shorter than one on the left by 4 p/v, with v the speed at the bottom. A slow rotor shows most.
 *
 * This needs v, and thus an amplitude A. By the pendulum's first integral v^2 = 4 g sin^2(A/2). Half a swing takes 2
 * K(sin(A/2))/sqrt(g), with K the complete elliptic integral of the first kind. The last swings are small: their period
 * gives g = S g0/I. The first swing's time then gives its amplitude, and the number of swings the friction. This first
 * guess, from pulses alone, is within some 10 %.
 *
 * Gauss's regression refines it. The unknowns are q and q' at the first backward passage of the bottom, g, Coulomb and
 * viscous friction over I, and both sensors' positions. The data are the times of all pulses. The equation of motion is
 * integrated forwards over the swings and backwards over the last turns. There, and at amplitudes above 90 deg, the rotor
 * passes sensor 2, which gives a second known angle. Pulses with a large residual end a pass. The first passes give all
 * pulses an uncertainty of some degrees, less from pass to pass: a single pass would not always converge.
 *
 * The interval is that of the regression, widened by excess residuals of the pulses and by the floor.
 *
 * Pulses are stored while the rotor swings. Once it rests, each control step does a piece of a pass: three steps of the
 * equation, or one pulse, or part of the solution of the normal equations. The whole takes some seconds. */
#ifndef WH_RIG_FREE_SWING_H
#define WH_RIG_FREE_SWING_H

#include "result.h"
#include "swing_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 0, possible in a small chip's build: swings are not evaluated. */
#ifndef WH_RIG_SWINGS
#define WH_RIG_SWINGS 1
#endif

#define wh_swing_pulse WH_NAME(wh_swing_pulse)
#define wh_swing_step WH_NAME(wh_swing_step)
#define wh_swing_doubt WH_NAME(wh_swing_doubt)
#define wh_swing_text WH_NAME(wh_swing_text)

/* A pulse of sensor 0 or 1 as it comes, in order of time. */
void wh_swing_pulse(wh_swing *swing, unsigned sensor, uint32_t ticks);

/* Every control step. `swings`: the rotor turned forwards, or has swung out by now, after a run, and the motor's leads
 * have been open since then. When they are closed, the rotor rests if `rests`; otherwise it was stopped, and the swing
 * was not free. While wh_swing_works(), each step at rest does a bounded piece of the work. */
void wh_swing_step(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing,
                   bool swings, bool rests);

/* Are there pulses left to evaluate? */
WH_INLINE bool wh_swing_works(const wh_swing *swing) { return swing->result.why == WH_SWING_WORKS; }

/* If sensor 1 was found off its position, a good result becomes doubtful: its phase has the same error. */
void wh_swing_doubt(const wh_swing_config *config, const wh_swing *swing, wh_measured *measured);

/* In words, for consoles. */
const char *wh_swing_text(wh_swing_why why);

#ifdef __cplusplus
}
#endif

#endif
