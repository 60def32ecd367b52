/* turn_function.h: functions of one angle, at any part of its turn, with their slopes. */
#ifndef DERIVE_TURN_FUNCTION_H
#define DERIVE_TURN_FUNCTION_H

#include "host/image/tape.h"

/* What an operation of the list gives at some angle. */
typedef struct turn_value {
    double value;
    double slope; /* a turn */
    double size;  /* what it would be if nothing cancelled: rounding leaves 1e-16 of this */
} turn_value;

/* All of the list's operations, value[t->count], `turns` being the way round of an angle of which phase i takes
 * multiple[i] (of operations that are no phases, nothing). All are functions of that angle: no rates or reals. */
void turn_evaluate(const tape *t, const int *multiple, double turns, turn_value *value);

#endif
