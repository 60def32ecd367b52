/* start.h: whether a run can start where its scene says, and by the method that is asked for. */
#ifndef ENGINE_START_H
#define ENGINE_START_H

#include "engine.h"

/* False, reported at each stop that the run would start beyond, by more than rounding, or where
 * it has no value, and at each angle that a run of this kind cannot hold. */
bool start_is_possible(const image *im, const engine_kind *kind, diags *errors);

/* The angles' part of it: false, reported, where float, as in generated C, cannot hold one. */
bool start_angles_are_held(const image *im, diags *errors);

/* False, reported, when the method's row (core/method.h) does not take systems of the form that the image runs in, or not
 * accelerations like these. */
bool start_has_method(const image *im, wh_method method, diags *errors);

#endif
