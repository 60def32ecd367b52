/* methods.h: the rows of core/method.h as words for users. */
#ifndef ENGINE_METHODS_H
#define ENGINE_METHODS_H

#include <stddef.h>

#include "core/scene.h"

/* Room for the words of all methods in a sentence. */
enum { METHODS_TEXT_SIZE = 96 + 40 * WH_METHODS };

/* The methods that take every system of this form: "euler, heun or rk4". Returns `text`. */
const char *methods_of_form(wh_form form, char text[METHODS_TEXT_SIZE]);

/* All of them, the one that stands for itself first and marked, those that do not take systems of first order, or no
 * rates, behind semicolons. Returns `text`. */
const char *methods_in_help(char text[METHODS_TEXT_SIZE]);

#endif
