/* turn.h: the stored types of angles and phases, and moving a phase. Part of angle.h. */
#ifndef WH_TURN_H
#define WH_TURN_H

#include "../real.h"

WH_C_BEGIN

#if WH_DOUBLE

typedef double wh_angle;  /* radians, unwrapped */
typedef double wh_phase;  /* radians */
typedef double wh_factor; /* factor of wh_phase_times() */
#define WH_PHASE_PER_RAD 1.0
#define WH_PHASE_PER_RAD_REST 0.0
/* Limit on the change of an angle in one step: beyond it the direction is ambiguous. */
#define WH_PHASE_STEP_MAX 3.141592653589793

WH_INLINE wh_phase wh_phase_of(wh_angle angle) { return angle; }

#else

/* 2^32 per turn: whole turns in the high half, the phase in the low half. The count of turns wraps at 2^31
 * (after twelve years at 330 rpm), which does not change the phase. */
typedef int64_t wh_angle;
typedef uint32_t wh_phase; /* 2^32 per turn */
typedef struct wh_factor { /* the number whole + part/2^64, modulo 2^32 */
    uint64_t part;
    uint32_t whole;
} wh_factor;
#define WH_PHASE_PER_RAD 683565275.576431632f /* 2^32 / (2 pi) */
#define WH_PHASE_PER_RAD_REST 27.576431632f   /* 2^32 / (2 pi) minus WH_PHASE_PER_RAD */
#define WH_PHASE_STEP_MAX 2147483520.0f       /* largest float below half a turn */

WH_INLINE wh_phase wh_phase_of(wh_angle angle) { return (wh_phase)(uint64_t)angle; }

#endif

/* Sets the int32_t `result` to the float `steps`, rounded to nearest, ties to even, by one instruction. On x86 and
 * Arm's VFP, this instruction uses the current rounding mode, which arithmetic.h tests. */
#if defined(__GNUC__) && defined(__arm__) && defined(__ARM_FP) && (__ARM_FP & 4)
#define WH_ROUND(result, steps) \
    float whole; /* holds the integer's bits: the result is in a float register */ \
    __asm__("vcvtr.s32.f32 %0, %1" : "=t"(whole) : "t"(steps)); \
    __builtin_memcpy(&(result), &whole, sizeof(result))
#elif defined(__GNUC__) && defined(__SSE2__)
#define WH_ROUND(result, steps) __asm__("cvtss2si %1, %0" : "=r"(result) : "x"(steps))
#elif defined(__GNUC__) && defined(__aarch64__)
#define WH_ROUND(result, steps) __asm__("fcvtns %w0, %s1" : "=r"(result) : "w"(steps))
#elif defined(__GNUC__) && defined(__riscv_flen) && __riscv_flen >= 32
#define WH_ROUND(result, steps) __asm__("fcvt.w.s %0, %1, rne" : "=r"(result) : "f"(steps))
#endif

/* Constants of generated code. WH_TURN() is an angle or a phase: `rad` in the double build, `units` (2^32 per turn) in
 * the float build. WH_FACTOR() is a wh_factor: `real` in the double build, `whole` and `part` in the float build. */
#if WH_DOUBLE
#define WH_TURN(rad, units) (rad)
#else
#define WH_TURN(rad, units) (units)
#endif

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
/* Returns the integer nearest to `steps`, |steps| < 2^31. Ties go to even: ties away from zero make angles drift. */
WH_INLINE int32_t wh_whole(float steps) {
#ifdef WH_ROUND
    int32_t result;
    WH_ROUND(result, steps);
    return result;
#else
    uint32_t bits;
    __builtin_memcpy(&bits, &steps, sizeof bits);
    const uint32_t digits = (bits & 0x7fffffU) | 0x800000U;
    const int below = 150 - (int)((bits >> 23) & 0xffU); /* number of fractional bits in digits */
    uint32_t size = 0;
    if (below <= 0) {
        size = digits << -below;
    } else if (below <= 24) {
        const uint32_t half = UINT32_C(1) << (below - 1);
        size = (digits + (half - 1U) + ((digits >> below) & 1U)) >> below;
    }
    return (bits >> 31) != 0 ? -(int32_t)size : (int32_t)size;
#endif
}

/* Drops the fraction of `steps` and returns half of the rest, rounded to nearest, ties away from zero. */
WH_INLINE int32_t wh_half_whole(float steps) {
    const int32_t whole = (int32_t)steps;
    /* gcc and clang define >> of a negative number: it keeps the sign */
    return (whole - (~whole >> 31)) >> 1;
}
#endif

/* Sets *moved to phase + steps, in phase units (radians * WH_PHASE_PER_RAD). The float build rounds to the nearest
 * unit. If |steps| is half a turn or more, or NaN, returns false without setting *moved: the step must be refused. */
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

/* Like wh_phase_move(), but moves by steps/2. */
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

/* Returns the angle that has this phase and is at most half a turn from `angle`. */
WH_INLINE wh_angle wh_angle_near(wh_angle angle, wh_phase phase) {
#if WH_DOUBLE
    (void)angle;
    return phase;
#else
    const int64_t way = (int32_t)(phase - wh_phase_of(angle));
    return (wh_angle)((uint64_t)angle + (uint64_t)way); /* unsigned, because it may wrap */
#endif
}

WH_C_END

#endif
