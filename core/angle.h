/* angle.h: angles as 2^32 steps a turn, and their sine and cosine.
 *
 * An angle that only ever appears inside sine and cosine is kept as a 64-bit integer: the low
 * 32 bits are the phase within the turn, the high 32 bits count whole turns. It wraps by itself,
 * is as precise after a million turns as in the first, needs no range reduction, and sums and
 * integer multiples of phases are integer operations. (float32 radians lose a digit every ten
 * turns and freeze at 1 ms steps near 512 rad.)
 *
 * The double reference build keeps radians: it checks the integer arithmetic instead of sharing it.
 */
#ifndef WH_ANGLE_H
#define WH_ANGLE_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

#if WH_DOUBLE

typedef double wh_angle;  /* radians, unwrapped */
typedef double wh_phase;  /* radians */
typedef double wh_factor; /* what wh_phase_times() takes */
#define WH_PHASE_PER_RAD 1.0
/* A step may not turn an angle by more than this: beyond it, direction is lost. */
#define WH_PHASE_STEP_MAX 3.141592653589793

WH_INLINE wh_phase wh_phase_of(wh_angle angle) { return angle; }

#else

/* 2^32 a turn: turns in the high half, phase in the low half. The count of turns wraps at 2^31 of them (50 days
 * of half a turn a millisecond, twelve years at 330 rpm); the phase, and so sine and cosine, stay right. */
typedef int64_t wh_angle;
typedef uint32_t wh_phase; /* 2^32 a turn */
typedef struct wh_factor { /* whole + part/2^64, modulo 2^32 */
    uint64_t part;
    uint32_t whole;
} wh_factor;
#define WH_PHASE_PER_RAD 683565275.576431632f /* 2^32 / (2 pi) */
#define WH_PHASE_STEP_MAX 2147483520.0f       /* largest float below half a turn */

WH_INLINE wh_phase wh_phase_of(wh_angle angle) { return (wh_phase)(uint64_t)angle; }

#endif

/* A constant angle or phase for generated code: radians for the double build, `units` (2^32 a turn)
 * for the float build. */
#if WH_DOUBLE
#define WH_TURN(rad, units) (rad)
#else
#define WH_TURN(rad, units) (units)
#endif

/* A constant factor for generated code: `real` for the double build, the others for the float build. */
#if WH_DOUBLE
#define WH_FACTOR(real, whole, part) (real)
#else
#define WH_FACTOR(real, whole, part) wh_factor_of(whole, part)
WH_INLINE wh_factor wh_factor_of(uint32_t whole, uint64_t part) {
    const wh_factor both = {part, whole};
    return both;
}
#endif

#if !WH_DOUBLE
/* The nearest whole number of |steps| < WH_PHASE_STEP_MAX, halves away from zero. The rest is exact; adding a
 * half before cutting would not be: odd numbers between 2^23 and 2^24 would tie with the next. */
WH_INLINE int32_t wh_whole(float steps) {
    const int32_t whole = (int32_t)steps;
    const float rest = steps - (float)whole;
    return whole + (int32_t)(rest + rest);
}

/* The same of steps/2, from the whole part of steps: 1, -1 and what lies beyond are rounded away from zero. */
WH_INLINE int32_t wh_half_whole(float steps) {
    const int32_t whole = (int32_t)steps;
    return (whole - (~whole >> 31)) >> 1; /* gcc and clang define >> of a negative number */
}
#endif

/* *moved = `phase` moved on by `steps` phase units (radians * WH_PHASE_PER_RAD), in float rounded to the
 * nearest. False, with *moved as it was, for half a turn or more, or NaN: the step is to be refused. */
WH_INLINE bool wh_phase_move(wh_phase phase, wh_real steps, wh_phase *moved) {
    if (!(WH_ABS(steps) < WH_PHASE_STEP_MAX)) {
        return false;
    }
#if WH_DOUBLE
    *moved = phase + steps;
#else
    *moved = phase + (wh_phase)wh_whole(steps);
#endif
    return true;
}

/* The same by half of `steps`: where the middle of a step that moves by all of them stands. */
WH_INLINE bool wh_phase_move_half(wh_phase phase, wh_real steps, wh_phase *moved) {
    if (!(WH_ABS(steps) < WH_PHASE_STEP_MAX)) {
        return false;
    }
#if WH_DOUBLE
    *moved = phase + 0.5 * steps;
#else
    *moved = phase + (wh_phase)wh_half_whole(steps);
#endif
    return true;
}

/* The angle of this phase that is less than half a turn from `angle`: where a stage of a step stands. */
WH_INLINE wh_angle wh_angle_near(wh_angle angle, wh_phase phase) {
#if WH_DOUBLE
    (void)angle;
    return phase;
#else
    const int64_t way = (int32_t)(phase - wh_phase_of(angle));
    return (wh_angle)((uint64_t)angle + (uint64_t)way); /* wraps like the angle itself */
#endif
}

/* Sine and cosine of a phase together; a caller that drops one pays for one. At most 1 in size,
 * and exact at quarter turns. Float: the worst error over all 2^32 phases is 6.3e-8 (`make
 * sine-exhaustive` measures it). Double: 1.4e-16 for |phase| <= 5e8 rad; beyond it, or of NaN, both
 * are NaN. docs/numerics.md says how and what it costs. */
WH_INLINE void wh_sincos(wh_phase phase, wh_real *sine, wh_real *cosine);

/* The same in two parts each, whose sums those are: what is added to them before the parts are is not rounded twice. */
typedef struct wh_sine_parts {
    wh_real sine;
    wh_real cosine;
    wh_real sine_rest; /* below 1/40 */
    wh_real cosine_rest;
} wh_sine_parts;
WH_INLINE void wh_sincos_parts(wh_phase phase, wh_sine_parts *parts);

/* Phase of an angle in radians, for arguments that are not kept as a turn angle. Float: within one
 * phase unit (1.5e-9 rad) for |rad| < 1e9; larger or NaN gives phase 0. Double: rad itself. */
WH_INLINE wh_phase wh_phase_from_rad(wh_real rad);

/* A float phase has no room for "not a number": where rad has none either, or is too large for a phase,
 * make sine and cosine NaN, so that the step is refused as it is in double. */
WH_INLINE void wh_sincos_of_range(wh_real rad, wh_real *sine, wh_real *cosine);

#define wh_angle_from_rad WH_NAME(wh_angle_from_rad)
#define wh_angle_to_rad WH_NAME(wh_angle_to_rad)
#define wh_phase_times WH_NAME(wh_phase_times)

/* The stored angle of unwrapped radians: whole turns are kept. Precision and range as with
 * wh_phase_from_rad(). */
wh_angle wh_angle_from_rad(wh_real rad);

/* The unwrapped radians of a stored angle. Float: rounded to the nearest (by 0.504 of the last
 * place at worst); any angle is in range. */
wh_real wh_angle_to_rad(wh_angle angle);

/* The phase of an angle times a number that need not be whole: half an angle, 1.5 or 0.37 times one. Whole
 * turns count there, which a phase has lost: half of one turn is half a turn. Float: within 0.75 phase
 * units (1.1e-9 rad), however many turns. Double: the product, rounded. For records, never in a step. */
wh_phase wh_phase_times(wh_angle angle, wh_factor factor);

#ifdef __cplusplus
}
#endif

#include "sine.h" /* the inline bodies of wh_sincos and wh_phase_from_rad */

#endif
