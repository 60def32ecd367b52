/* override.h: the parser of the command line's changes. */
#ifndef LANG_OVERRIDE_H
#define LANG_OVERRIDE_H

#include "host/base/alloc.h"
#include "model.h"

typedef enum override_kind { OVERRIDE_SET, OVERRIDE_START, OVERRIDE_EITHER } override_kind;

/* "NAME=EXPR" or "NAME'=EXPR". Returns false after an error (reported, in a source called "<command line>"). A bare
 * number is SI, and refused if the declared unit is not. "2 N*m" needs no brackets. */
bool override_parse(const mechanism *of, override_kind kind, const char *text, struct arena *arena,
                    diags *diags, assignment *made);

/* "1ms", "1 [ms]", "0.001": seconds; NULL after an error. `what` is "step" or "until". */
const expr *override_duration(const mechanism *of, const char *what, const char *text,
                              struct arena *arena, diags *diags);

/* "500 Hz", "0.1mm", "1e-6": a quantity of this dimension, in SI; a bare number is SI. NULL after an error. */
const expr *override_quantity(const mechanism *of, const char *what, const char *text,
                              dimension wanted, struct arena *arena, diags *diags);

/* A change of "X", "theta'" or an output, in SI. It needs the quantity's dimension, and a unit unless SI is declared.
 * An unknown name is not reported. NULL after an error. */
const expr *override_size(const mechanism *of, const char *name, const char *what, const char *text,
                          struct arena *arena, diags *diags);

/* The hint for an unknown effect: a similar name, or all names; returns `hint`. */
enum { EFFECT_HINT = 300 };
const char *effect_hint(const mechanism *of, const char *text, size_t length,
                        char hint[EFFECT_HINT]);
/* The index of the effect called `text`, or -1 (reported). */
int override_effect(const mechanism *of, const char *text, struct arena *arena, diags *diags);

#endif
