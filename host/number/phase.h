/* phase.h: angles and multiples of angles as the float build stores them, in whole units of 2^-32 turn. */
#ifndef NUMBER_PHASE_H
#define NUMBER_PHASE_H

#include <stdbool.h>
#include <stdint.h>

/* Converts a start angle to units of 2^-32 turn, rounded to the nearest, and keeps whole turns. Returns 0 if
 * |rad| >= PHASE_START_MOST_RAD: then phase_holds_start() returns false. */
#define PHASE_START_MOST_RAD 6.28e9
int64_t phase_of_start(double rad);
bool phase_holds_start(double rad);

/* Converts an angle in radians to units of 2^-32 turn, modulo one turn, rounded to the nearest. */
uint32_t phase_of_constant(double rad);

/* Splits a factor for wh_phase_times(). *whole: its whole part modulo 2^32. *part: its fraction in units of 2^-64. */
void phase_factor(double multiple, uint32_t *whole, uint64_t *part);

#endif
