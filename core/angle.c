/* angle.c: conversion of angles between radians and the stored form; the sine table. */
#include "angle.h"

#include "number/sincos_small.h"

/* RISES: sin(2 pi i/128) to 17 digits, for i = 1 to 31. FALLS: the same values in reverse order. */
/* clang-format off */
#define RISES(X) \
    X(0.049067674327418015) X(0.098017140329560604) X(0.14673047445536175) X(0.19509032201612828) \
    X(0.2429801799032639) X(0.29028467725446239) X(0.33688985339222005) X(0.38268343236508978) \
    X(0.42755509343028208) X(0.47139673682599764) X(0.51410274419322177) X(0.55557023301960218) \
    X(0.59569930449243336) X(0.63439328416364549) X(0.67155895484701844) X(0.70710678118654757) \
    X(0.74095112535495911) X(0.77301045336273699) X(0.80320753148064494) X(0.83146961230254524) \
    X(0.85772861000027212) X(0.88192126434835505) X(0.90398929312344334) X(0.92387953251128674) \
    X(0.94154406518302081) X(0.95694033573220882) X(0.97003125319454397) X(0.98078528040323043) \
    X(0.98917650996478101) X(0.99518472667219693) X(0.99879545620517241)
#define FALLS(X) \
    X(0.99879545620517241) X(0.99518472667219693) X(0.98917650996478101) X(0.98078528040323043) \
    X(0.97003125319454397) X(0.95694033573220882) X(0.94154406518302081) X(0.92387953251128674) \
    X(0.90398929312344334) X(0.88192126434835505) X(0.85772861000027212) X(0.83146961230254524) \
    X(0.80320753148064494) X(0.77301045336273699) X(0.74095112535495911) X(0.70710678118654757) \
    X(0.67155895484701844) X(0.63439328416364549) X(0.59569930449243336) X(0.55557023301960218) \
    X(0.51410274419322177) X(0.47139673682599764) X(0.42755509343028208) X(0.38268343236508978) \
    X(0.33688985339222005) X(0.29028467725446239) X(0.2429801799032639) X(0.19509032201612828) \
    X(0.14673047445536175) X(0.098017140329560604) X(0.049067674327418015)

#define PLUS(x) WH_R(x),
#define MINUS(x) -WH_R(x),
const wh_real wh_sine_table[(1U << WH_SINE_BITS) + WH_SINE_QUARTER] WH_FLASH = {
    WH_R(0.0), RISES(PLUS) WH_R(1.0), FALLS(PLUS) WH_R(0.0), RISES(MINUS) -WH_R(1.0), FALLS(MINUS)
    WH_R(0.0), RISES(PLUS)
};
/* clang-format on */

#if WH_DOUBLE

wh_angle wh_angle_from_rad(wh_real rad) { return rad; }

wh_real wh_angle_to_rad(wh_angle angle) { return angle; }

wh_phase wh_phase_times(wh_angle angle, wh_factor factor) { return angle * factor; }

#else

wh_angle wh_angle_from_rad(wh_real rad) { return wh_angle_of_rad(rad); }

/* Uses integers up to the final rounding, because a product of two rounded floats would have an error above one ulp. */
wh_real wh_angle_to_rad(wh_angle angle) {
    if (angle == 0) {
        return 0.0f;
    }
    uint64_t size = angle < 0 ? 0U - (uint64_t)angle : (uint64_t)angle;
    float scale = 8.0f; /* radians per unit of `bits`, halved for each shift of `size` */
    while (size >> 63 == 0) {
        size <<= 1;
        scale *= 0.5f;
    }
    const uint64_t two_pi = UINT64_C(3373259426); /* 2^29 * 2 pi */
    const uint64_t product = (size >> 32) * two_pi + (((size & UINT32_MAX) * two_pi) >> 32);
    /* Sticky bit: without it, the rounding below would treat a value just above a tie as the tie. */
    const uint32_t bits = (uint32_t)(product >> 32) | ((uint32_t)product != 0 ? 1U : 0U);
    const float magnitude = (float)bits * scale;
    return angle < 0 ? -magnitude : magnitude;
}

/* Returns the rounded product modulo 2^32. factor.part has 64 bits after the point. If angle < 0, `size` is 2^64 too
 * large, and `too_much` corrects the product. */
wh_phase wh_phase_times(wh_angle angle, wh_factor factor) {
    const uint64_t size = (uint64_t)angle;
    const uint64_t size_low = size & UINT32_MAX;
    const uint64_t part_low = factor.part & UINT32_MAX;
    const uint64_t size_high = size >> 32;
    const uint64_t part_high = factor.part >> 32;
    const uint64_t low = size_low * part_low;
    const uint64_t cross = size_high * part_low;
    const uint64_t mixed = size_low * part_high;
    const uint64_t carried =
        (low >> 32) + (cross & UINT32_MAX) + (mixed & UINT32_MAX) + (UINT64_C(1) << 31);
    const uint64_t high = size_high * part_high + (cross >> 32) + (mixed >> 32) + (carried >> 32);
    const uint64_t too_much = angle < 0 ? factor.part : 0U;
    return (uint32_t)(high - too_much) + factor.whole * (uint32_t)size;
}

#endif

WH_COLD wh_wave wh_sincos_far_called(wh_real d) { return wh_sincos_far(d, false); }
