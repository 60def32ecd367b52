/* limits.h: what a step of a method makes of one linear motion: its stability region, and how much amplitude it takes or
 * gives within it. From the rows of core/method.h. */
#ifndef RUN_LIMITS_H
#define RUN_LIMITS_H

#include "core/scene.h"
#include "modes.h"

/* One motion exp(value t). In second-order form its accelerations come from places and from rates, and methods with
 * positions of their own take the two in another way: q'' = rates q' + (value - rates) value q. An oscillator's rates are
 * its damping, 2 re(value); a damper's all, value; what turns in a magnetic field or a rotating frame has imaginary ones. */
typedef struct limits_motion {
    complex_number value; /* 1/s */
    complex_number rates; /* 1/s; of the first order without meaning */
} limits_motion;

/* The oscillator's, or the damper's. */
limits_motion limits_plain(complex_number value);

/* In a step of 1/by. */
limits_motion limits_scaled(limits_motion m, double by);

/* How much longer a step makes the amplitude of such a motion, of size one: |mu|. A method that knows no rates
 * (WH_NO_RATES) takes it undamped. */
double limits_growth(wh_method method, wh_form form, limits_motion m, double step_s);

/* The exact one: exp(re(value) step_s). */
double limits_exact(complex_number value, double step_s);

/* By which part of it the energy of an oscillation goes up and down from step to step, without being lost: that of a method
 * with weights of its own for positions. Of one that hardly decays; 0 of others, and less where rates make it turn. */
double limits_ripple(wh_method method, wh_form form, limits_motion m, double step_s);

/* The part of its amplitude that a motion of size one has lost or won to the method when it has gone on for `span_s`, or
 * has decayed: about half of what that is of its energy. At most 1 when lost. */
double limits_off(wh_method method, wh_form form, limits_motion m, double step_s, double span_s);

/* Up to which h |value| a motion in the direction of `m` does not grow, by bisection; 0: nowhere. */
double limits_interval(wh_method method, wh_form form, limits_motion m);

#endif
