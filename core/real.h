/* real.h: the core's number type, wh_real, and macros for all core files. wh_real is float, or double in the
 * reference build (WH_DOUBLE=1). Both builds use no library, and only IEEE 754 additions, multiplications, divisions,
 * square roots and conversions. So the same source gives the same bits on every machine, unless the compiler changes
 * the operations. real.h forbids fused multiply-adds. The compilation stops if a macro shows that an option changes the
 * operations. wh_scene_start() detects options without a macro (arithmetic.h). */
#ifndef WH_REAL_H
#define WH_REAL_H

#include <stdbool.h>
#include <stdint.h>

#include "linkage.h"

#ifndef WH_DOUBLE
#define WH_DOUBLE 0
#endif

#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#endif

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error \
    "Whirl computes the same bits everywhere, and fast-math changes them: compile this file without -ffast-math, -Ofast, -funsafe-math-optimizations and the options that these include."
#endif

/* Methods 16 and 32 are allowed: they, too, compute float in the precision of float. */
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && __FLT_EVAL_METHOD__ != 16 && \
    __FLT_EVAL_METHOD__ != 32 && \
    !(WH_DOUBLE && (__FLT_EVAL_METHOD__ == 1 || __FLT_EVAL_METHOD__ == 64))
#error \
    "Whirl computes the same bits everywhere, and this compiler keeps intermediate results in a higher precision: on x86 use -msse2 -mfpmath=sse, on s390x -std=gnu11."
#endif

/* Tools that predefine no macros, such as cppcheck, skip this check. wh_scene_start() checks the arithmetic, too. */
#if defined(__FLT_RADIX__) && \
    (__FLT_RADIX__ != 2 || __FLT_MANT_DIG__ != 24 || (WH_DOUBLE && __DBL_MANT_DIG__ != 53))
#error "Whirl needs IEEE 754 numbers: float of 32 bits and, with WH_DOUBLE=1, double of 64 bits."
#endif

#if WH_DOUBLE
typedef double wh_real;
#define WH_R(x) x
#define WH_ABS(x) __builtin_fabs(x)
#else
typedef float wh_real;
#define WH_R(x) x##f
#define WH_ABS(x) __builtin_fabsf(x)
#endif

/* The host links both builds of the core into one program, so the double one has a suffix. */
#if WH_DOUBLE
#define WH_NAME(name) name##_d
#else
#define WH_NAME(name) name
#endif

/* Converts x to size_t without an old-style cast in C++. */
#ifdef __cplusplus
#define WH_SIZE(x) static_cast<size_t>(x)
#else
#define WH_SIZE(x) ((size_t)(x))
#endif

#if defined(__GNUC__)
#define WH_INLINE static inline __attribute__((always_inline))
#else
#define WH_INLINE static inline
#endif

/* WH_INLINE_WITH_FPU: inlined except on processors without floating-point arithmetic, where a call costs little
 * compared with the arithmetic, and flash is small. */
#if defined(__AVR__) || (defined(__arm__) && !defined(__ARM_FP)) || \
    (defined(__riscv) && !defined(__riscv_flen))
#define WH_SOFT_FLOAT 1
#else
#define WH_SOFT_FLOAT 0
#endif
#if WH_SOFT_FLOAT
#define WH_INLINE_WITH_FPU static __attribute__((noinline, unused))
#else
#define WH_INLINE_WITH_FPU WH_INLINE
#endif

/* 1 if the chip passes floats in registers: rare paths then call functions of scene.c and angle.c, to save flash. */
#if defined(__ARM_PCS_VFP) && !WH_DOUBLE && !(defined(WH_MULTI_STEP) && WH_MULTI_STEP)
#define WH_REALS_IN_REGISTERS 1
#else
#define WH_REALS_IN_REGISTERS 0
#endif

/* -DWH_SMALL=1 saves flash: functions marked WH_CALLED, or WH_SHARED in a header, are then not inlined. */
#ifndef WH_SMALL
#define WH_SMALL 0
#endif
#if WH_SMALL && defined(__GNUC__)
#define WH_CALLED __attribute__((noinline))
#define WH_SHARED static __attribute__((noinline, unused))
#else
#define WH_CALLED
#define WH_SHARED WH_INLINE
#endif

/* WH_COLD: a function that rarely runs. WH_SELDOM: a condition that is rarely true. Compilers keep such code small. */
#if defined(__GNUC__)
#define WH_COLD __attribute__((cold))
#else
#define WH_COLD
#endif
#if (defined(__GNUC__) && __GNUC__ >= 9) || (defined(__clang__) && __clang_major__ >= 11)
#define WH_SELDOM(condition) __builtin_expect_with_probability(condition, false, 1.0)
#elif defined(__GNUC__)
#define WH_SELDOM(condition) __builtin_expect(condition, false)
#else
#define WH_SELDOM(condition) (condition)
#endif

/* Errors are negative; a step with an error keeps the last good state. X(name, value, text of wh_status_text()). */
#define WH_STATUS_ROWS(X) \
    X(WH_OK, 0, "ok") \
    /* A component or the move of an angle exceeded its limit (refuse.h, turn.h), or is NaN. */ \
    X(WH_E_DIVERGED, -1, "the state diverged") \
    X(WH_E_MEMORY, -2, "the memory is too small for this scene") \
    X(WH_E_ARGUMENT, -3, "an argument is out of range") \
    X(WH_E_UNDEFINED, -4, "an expression of a contact is not a finite number") \
    X(WH_E_SINGULAR, -5, "holds allow more than one motion") \
    /* Compiler flags or modes of the processor would change the results (arithmetic.h). */ \
    X(WH_E_ARITHMETIC, -6, "the arithmetic is not that of IEEE 754")

#define WH_STATUS_VALUE(name, value, words) name = (value),
typedef enum wh_status { WH_STATUS_ROWS(WH_STATUS_VALUE) } wh_status;
#undef WH_STATUS_VALUE

#endif
