/* angle.h: angles as integers with 2^32 units per turn, and their sine and cosine.
 *
 * An angle that appears only inside sine and cosine is stored as a 64-bit integer: the low 32 bits are the phase within the
 * turn, the high 32 bits count whole turns. It wraps by itself, is as precise after a million turns as in the first, and
 * needs no range reduction. Sums and integer multiples of phases are integer operations. (float32 radians lose a digit
 * every ten turns and freeze at 1 ms steps near 512 rad.)
 *
 * The double reference build uses radians: it checks the integer arithmetic instead of sharing it. */
#ifndef WH_ANGLE_H
#define WH_ANGLE_H

#include "number/sine.h"
#include "number/turn.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_angle_from_rad WH_NAME(wh_angle_from_rad)
#define wh_angle_to_rad WH_NAME(wh_angle_to_rad)
#define wh_phase_times WH_NAME(wh_phase_times)

/* The stored angle of unwrapped radians, whole turns included. Precision and range as with wh_phase_from_rad(). */
wh_angle wh_angle_from_rad(wh_real rad);

/* Converts a stored angle to unwrapped radians. Every angle is in range. Float: rounded to the nearest (within 0.504
 * of the last place). */
wh_real wh_angle_to_rad(wh_angle angle);

/* The phase of `factor` times an angle; the factor need not be whole (0.5, 1.5, 0.37). Whole turns count: half of
 * one turn is half a turn. (A phase alone has lost its turns.) Float: within 0.75 phase units (1.1e-9 rad), for any
 * number of turns. Double: the product, rounded. Used for records, never in a step. */
wh_phase wh_phase_times(wh_angle angle, wh_factor factor);

#ifdef __cplusplus
}
#endif

#endif
