/* override.h: the command line's changes, from text to checked expressions. */
#ifndef LANG_OVERRIDE_H
#define LANG_OVERRIDE_H

#include "host/base/arena.h"
#include "model.h"

typedef enum override_kind { OVERRIDE_SET, OVERRIDE_START, OVERRIDE_EITHER } override_kind;

/* "NAME=EXPR" or "NAME'=EXPR". Returns false when it was wrong (reported, in a source called
 * "<command line>"). A bare number is SI, and refused where the declared unit is not; "2 N*m" may stand without
 * brackets. */
bool override_parse(const mechanism *of, override_kind kind, const char *text, struct arena *arena,
                    diags *diags, assignment *made);

/* "1ms", "1 [ms]", "0.001": seconds; NULL when it was wrong. `what` is "step" or "until". */
const expr *override_duration(const mechanism *of, const char *what, const char *text,
                              struct arena *arena, diags *diags);

/* "500 Hz", "0.1mm", "1e-6": a quantity of this dimension, in SI; a bare number is SI. NULL when it was wrong. */
const expr *override_quantity(const mechanism *of, const char *what, const char *text,
                              dimension wanted, struct arena *arena, diags *diags);

/* The dimension of what "X", "theta'" or an output's name stands for. False when it stands for nothing that moves: not
 * reported. */
bool override_dimension(const mechanism *of, const char *name, dimension *found);

/* The index of the effect called `text`, or -1 (reported). */
int override_effect(const mechanism *of, const char *text, struct arena *arena, diags *diags);

#endif
