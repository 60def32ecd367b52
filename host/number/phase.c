#include "phase.h"

#include <math.h>

#include "host/number/functions.h"

uint32_t phase_of_constant(double rad) { return (uint32_t)(uint64_t)phase_of_start(rad); }

void phase_factor(double multiple, uint32_t *whole, uint64_t *part) {
    const double size = fabs(multiple);
    const double units = number_floor(size);
    const double rest = (size - units) * 0x1p64; /* exact, and below 2^64 */
    *whole = (uint32_t)number_remainder(units, 0x1p32);
    *part = (uint64_t)(rest < 0x1p52 ? number_floor(rest + 0.5) : rest);
    if (multiple < 0.0) { /* negates *whole and *part as one number of 96 bits */
        *whole = 0U - *whole - (*part != 0 ? 1U : 0U);
        *part = 0U - *part;
    }
}

int64_t phase_of_start(double rad) {
    const double turns = rad / 6.283185307179586477;
    return phase_holds_start(rad) ? (int64_t)number_nearest(turns * 4294967296.0) : 0;
}

bool phase_holds_start(double rad) { return fabs(rad) < PHASE_START_MOST_RAD; }
