/* override.h: the parser of the command line's changes. */
#ifndef LANG_OVERRIDE_H
#define LANG_OVERRIDE_H

#include "host/base/alloc.h"
#include "model.h"

typedef enum override_kind { OVERRIDE_SET, OVERRIDE_START, OVERRIDE_EITHER } override_kind;

/* Reads "NAME=EXPR" or "NAME'=EXPR". EXPR needs a unit if NAME is not declared in SI. The unit needs no brackets.
 * If `around` is not NULL, the hint about a missing unit shows the value between around[0] and around[1]. Returns false
 * after an error, reported in a source called "<command line>". */
bool override_parse(const mechanism *of, override_kind kind, const char *text,
                    const char *const around[2], struct arena *arena, diags *diags,
                    assignment *made);

/* Reads "1ms", "1 [ms]" or "0.001", in seconds. `what` is "step" or "until". Returns NULL after an error. */
const expr *override_duration(const mechanism *of, const char *what, const char *text,
                              struct arena *arena, diags *diags);

/* Reads a quantity of the wanted dimension, such as "500 Hz" or "1e-6" (SI). Returns NULL after an error. */
const expr *override_quantity(const mechanism *of, const char *what, const char *text,
                              dimension wanted, struct arena *arena, diags *diags);

/* Reads VALUE from "VALUE" or "NAME=VALUE". If `name` is a coordinate, a rate ("theta'") or an output, VALUE must have
 * the dimension of `name`, and needs a unit if `name` is not declared in SI. Returns NULL after an error. */
const expr *override_size(const mechanism *of, const char *name, const char *what, const char *text,
                          struct arena *arena, diags *diags);

/* Writes the hint for an unknown effect: a similar name, or all names. Returns `hint`. */
enum { EFFECT_HINT = 300 };
const char *effect_hint(const mechanism *of, const char *text, size_t length,
                        char hint[EFFECT_HINT]);
/* Returns the index of the effect called `text`, or -1 (reported). */
int override_effect(const mechanism *of, const char *text, struct arena *arena, diags *diags);

#endif
