/* angle.h: angles as integers with 2^32 units per turn, and their sine and cosine.
 *
 * An angle that appears only inside sine and cosine is a 64-bit integer: the low 32 bits are the phase within the turn,
 * the high 32 bits count whole turns. It needs no range reduction, and its precision does not depend on the number of
 * turns. (Radians in float lose a decimal digit with each factor of ten in the number of turns. Near 512 rad, a slow
 * motion in steps of 1 ms no longer changes them.) Sums and integer multiples of phases are integer operations.
 *
 * The double build uses radians, so that it can check the integer arithmetic. */
#ifndef WH_ANGLE_H
#define WH_ANGLE_H

#include "number/sine.h"
#include "number/turn.h"

WH_C_BEGIN

#define wh_angle_from_rad WH_NAME(wh_angle_from_rad)
#define wh_angle_to_rad WH_NAME(wh_angle_to_rad)
#define wh_phase_times WH_NAME(wh_phase_times)

/* Converts unwrapped radians (whole turns included) to a stored angle. Precision and range: wh_phase_from_rad(). */
wh_angle wh_angle_from_rad(wh_real rad);

/* Converts any stored angle to unwrapped radians. Float: the error is at most 0.504 units in the last place. */
wh_real wh_angle_to_rad(wh_angle angle);

/* Returns the phase of factor * angle. The factor may be a fraction such as 0.37, because `angle` includes whole turns.
 * Float: the error is at most 0.75 phase units (1.1e-9 rad). Double: the rounded product. */
wh_phase wh_phase_times(wh_angle angle, wh_factor factor);

WH_C_END

#endif
