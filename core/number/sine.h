/* sine.h: sine and cosine together, and the phase of an angle in radians. Part of angle.h.
 *
 * The turn is divided into 128 sectors. s and c are the sine and cosine of the middle of the angle's sector, and r is
 * the angle from this middle, at most pi/128:
 *
 *      sin = s + (s (cos r - 1) + c sin r)        cos = c + (c (cos r - 1) - s sin r)
 *
 * The terms in parentheses are below 1/40, so their round-off hardly matters. The table and the last sum each
 * contribute an error of half a unit in the last place. Quarter turns are exact, and no value is beyond one.
 *
 * The usual polynomial for an eighth of a turn would save the table (640 bytes of flash in float), but it is slower and
 * less accurate (docs/dev/numerics.md). */
#ifndef WH_SINE_H
#define WH_SINE_H

#include "flash.h"
#include "turn.h"

WH_C_BEGIN

/* Sets *sine and *cosine, each at most 1 in size and exact at quarter turns. Float: the error is at most 6.3e-8 for all
 * 2^32 phases (`make sine-exhaustive` measures it). Double: the error is at most 1.4e-16 for |phase| <= 5e8 rad. If
 * |phase| is larger or NaN, *sine and *cosine are NaN. */
WH_INLINE void wh_sincos(wh_phase phase, wh_real *sine, wh_real *cosine);

/* The sine is sine + sine_rest. If you add a small term, add it to sine_rest, because that sum has less round-off. */
typedef struct wh_sine_parts {
    wh_real sine;
    wh_real cosine;
    wh_real sine_rest; /* below 1/40 */
    wh_real cosine_rest;
} wh_sine_parts;
WH_INLINE void wh_sincos_parts(wh_phase phase, wh_sine_parts *parts);

typedef struct wh_wave {
    wh_real sine;
    wh_real cosine;
} wh_wave;

/* Converts radians to a phase. Float: the error is at most one phase unit (1.5e-9 rad) if |rad| < 1e9. The phase of
 * any other number, and of NaN, is 0. Double: returns rad. */
WH_INLINE wh_phase wh_phase_from_rad(wh_real rad);

/* Float: sets *sine and *cosine to NaN if |rad| >= 1e9 or rad is NaN. A phase cannot be NaN. Double: no effect. */
WH_INLINE void wh_sincos_of_range(wh_real rad, wh_real *sine, wh_real *cosine);

#define WH_SINE_BITS 7                             /* a turn has 2^7 sectors */
#define WH_SINE_QUARTER (1U << (WH_SINE_BITS - 2)) /* sectors of a quarter turn */

/* Entry i is the sine at the middle of sector i. The cosine is WH_SINE_QUARTER entries later. */
#define wh_sine_table WH_NAME(wh_sine_table)
extern const wh_real wh_sine_table[(1U << WH_SINE_BITS) + WH_SINE_QUARTER] WH_FLASH;

/* Sets *parts for the angle r plus the middle of `sector`. */
WH_INLINE void wh_sine_turn_on(uint32_t sector, wh_real sin_r, wh_real cos_r_less_1,
                               wh_sine_parts *parts) {
    const wh_real *middle = &wh_sine_table[sector];
    const wh_real s = wh_flash_real(&middle[0]);
    const wh_real c = wh_flash_real(&middle[WH_SINE_QUARTER]);
    parts->sine = s;
    parts->cosine = c;
    parts->sine_rest = s * cos_r_less_1 + c * sin_r;
    parts->cosine_rest = c * cos_r_less_1 - s * sin_r;
}

#if WH_DOUBLE

WH_INLINE void wh_sincos_parts(wh_phase phase, wh_sine_parts *parts) {
    /* Above 5e8 the products below are not exact. NaN fails the comparison, too. */
    const double angle = WH_ABS(phase) <= 5e8 ? phase : __builtin_nan("");

    /* Adding 1.5 * 2^52 rounds to an integer and leaves it in the low bits of the sum. */
    const double to_integer = 6755399441055744.0;
    const double sum = angle * 20.371832715762604 + to_integer; /* 64/pi */
    const double sectors = sum - to_integer;
    uint64_t bits;
    __builtin_memcpy(&bits, &sum, sizeof bits);

    /* pi/64 in three parts (Cody & Waite, Software Manual for the Elementary Functions, chapter 8). The first two have
     * 18 and 16 bits, so the first two lines are exact for up to 2^34 sectors. The parts are 0x1.921f8p-5, 0x1.aa22p-24
     * and 0x1.68c234c4c6629p-44; C++11 has no such literals, and 17 decimal digits give the same numbers. */
    double r = angle - sectors * 0.049087285995483398;
    r = r - sectors * 9.9216777016408741e-08;
    r = r - sectors * 8.0104504737328716e-14;

    /* Minimax for |r| <= pi/128. The error of sin r is at most 2.8e-17, that of cos r 3e-20. */
    const double z = r * r;
    const double sin_r = r + r * z * (-0.1666666666295987 + z * 0.0083331554016490665);
    const double cos_r_less_1 =
        z * (-0.499999999999999 + z * (0.041666666656645597 + z * -0.0013888601908200115));
    const uint32_t sector = (uint32_t)bits & ((1U << WH_SINE_BITS) - 1U);
    wh_sine_turn_on(sector, sin_r, cos_r_less_1, parts);
}

WH_INLINE wh_phase wh_phase_from_rad(wh_real rad) { return rad; }

WH_INLINE void wh_sincos_of_range(wh_real rad, wh_real *sine, wh_real *cosine) {
    (void)rad;
    (void)sine;
    (void)cosine;
}

#else

WH_INLINE void wh_sincos_parts(wh_phase phase, wh_sine_parts *parts) {
    const unsigned rest_bits = 32U - WH_SINE_BITS;
    const uint32_t sector = (phase + (UINT32_C(1) << (rest_bits - 1U))) >> rest_bits;

    /* y is the angle from the sector's middle, in units of 2^-39 turns. The shift drops the sector number. */
    const float y = (float)(int32_t)(phase << WH_SINE_BITS);

    /* Minimax for |r| <= pi/128, with y instead of r. The error of sin r is at most 5e-12, that of cos r 2.6e-9. The
     * coefficients are 0x1.921fb6p-37, -0x1.4ab89ep-112 and -0x1.3bd07p-74; C++11 has no such literals. */
    const float z = y * y;
    const float sin_r = y * (1.14290478e-11f + z * -2.48806948e-34f);
    const float cos_r_less_1 = z * -6.53088477e-23f;
    wh_sine_turn_on(sector, sin_r, cos_r_less_1, parts);
}

/* Converts radians to a stored angle. A float would round the factor 2^32/(2 pi), so integers are used. The factor of
 * `whole` is 683565276 - 1819212470/2^32. The factor of `fraction` (units of 2^-31 rad) is 1367130551/2^32. */
#define WH_RAD_MOST 1e9f
WH_INLINE int64_t wh_angle_of_rad(float rad) {
    const float in_range = WH_ABS(rad) < WH_RAD_MOST ? rad : 0.0f; /* NaN is not in range */
    const int32_t whole = (int32_t)in_range;
    const int32_t fraction = (int32_t)((in_range - (float)whole) * 2147483648.0f);
    const int64_t small = whole * -INT64_C(1819212470) + fraction * INT64_C(1367130551);
    return whole * INT64_C(683565276) + ((small + (INT64_C(1) << 31)) >> 32);
}

WH_INLINE wh_phase wh_phase_from_rad(wh_real rad) { return wh_phase_of(wh_angle_of_rad(rad)); }

WH_INLINE void wh_sincos_of_range(wh_real rad, wh_real *sine, wh_real *cosine) {
    if (!(WH_ABS(rad) < WH_RAD_MOST)) {
        const float nothing = rad - rad;
        *sine = nothing / nothing;
        *cosine = *sine;
    }
}

#endif

WH_INLINE void wh_sincos(wh_phase phase, wh_real *sine, wh_real *cosine) {
    wh_sine_parts parts;
    wh_sincos_parts(phase, &parts);
    *sine = parts.sine + parts.sine_rest;
    *cosine = parts.cosine + parts.cosine_rest;
}

WH_C_END

#endif
