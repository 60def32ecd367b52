/* limits.h: what a step of a method makes of one linear motion: its stability region, and how much amplitude it takes or
 * gives within it. From the rows of core/method.h. */
#ifndef RUN_LIMITS_H
#define RUN_LIMITS_H

#include "core/scene.h"
#include "modes.h"

/* How much longer a step makes the amplitude of a motion exp(value t) of size one: |mu|. In second-order form the motion
 * is the oscillator's, or the damper's q'' = value q', which has the eigenvalue: for a method with positions of its own
 * there is more to a step than the eigenvalue. A method that knows no rates (WH_NO_RATES) takes it undamped. */
double limits_growth(wh_method method, wh_form form, complex_number value, double step_s);

/* The exact one: exp(re(value) step_s). */
double limits_exact(complex_number value, double step_s);

/* By which part of it the energy of an oscillation goes up and down from step to step, without being lost: that of a method
 * with weights of its own for positions. Of one that hardly decays; 0 of others. */
double limits_ripple(wh_method method, wh_form form, complex_number value, double step_s);

/* The part of its amplitude that a motion of size one has lost or won to the method when it has gone on for `span_s`, or
 * has decayed: about half of what that is of its energy. At most 1 when lost. */
double limits_off(wh_method method, wh_form form, complex_number value, double step_s,
                  double span_s);

/* Up to which h |value| a motion in the direction of `value` does not grow, by bisection; 0: nowhere. */
double limits_interval(wh_method method, wh_form form, complex_number direction);

#endif
