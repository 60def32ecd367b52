/* start.h: checks that a run can start at its scene's state and by the requested method. */
#ifndef ENGINE_START_H
#define ENGINE_START_H

#include "core/scene.h"
#include "host/engine/engine.h"

/* === methods in words ========================================================================= */

enum { METHODS_TEXT_SIZE = 96 + 40 * WH_METHODS }; /* room for all methods in a sentence */

/* Writes the methods that support all systems of this form, such as "euler, heun or rk4". Returns `text`. */
const char *methods_of_form(wh_form form, char text[METHODS_TEXT_SIZE]);

/* Writes the names of all methods, with their restrictions. Returns `text`. */
const char *methods_in_help(char text[METHODS_TEXT_SIZE]);

/* Returns false, and reports each error, if the start is beyond a stop, a stop's distance is not finite, or a start
 * angle is outside the range of this number type. */
bool start_is_possible(const image *im, const engine_kind *kind, diags *errors);

/* Returns false if float cannot represent a start angle. Reports each such angle. */
bool start_angles_are_held(const image *im, diags *errors);

/* Returns false, and reports the reason, if the method (core/method.h) does not support the image. */
bool start_has_method(const image *im, wh_method method, diags *errors);

#endif
