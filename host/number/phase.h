/* phase.h: angles and multiples of angles as the float build stores them: in whole units of 2^-32 turn. */
#ifndef NUMBER_PHASE_H
#define NUMBER_PHASE_H

#include <stdbool.h>
#include <stdint.h>

/* The stored start of a float angle: radians converted to units of 2^-32 turn, with whole turns, rounded to the nearest. It is 0 for
 * angles of PHASE_START_MOST_RAD or more. */
#define PHASE_START_MOST_RAD 6.28e9
int64_t phase_of_start(double rad);
bool phase_holds_start(double rad);

/* The phase of an angle in radians: units of 2^-32 turn, modulo one turn, rounded to the nearest. */
uint32_t phase_of_constant(double rad);

/* A multiple as wh_phase_times() takes it: modulo 2^32, rounded to 2^-64. */
void phase_factor(double multiple, uint32_t *whole, uint64_t *part);

#endif
