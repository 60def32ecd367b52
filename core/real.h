/* real.h: the core's number type, wh_real, and the macros of every core file. Boards and `whirl run --number float` use
 * float. Compiling with WH_DOUBLE=1 gives the reference build in double. Both are freestanding and neither calls libm.
 * They use only IEEE 754 additions, multiplications, divisions, square roots and conversions. So the same source gives
 * the same bits on every machine, unless the compiler changes the operations. This file forbids the contraction to
 * fused multiply-adds in every function after its #include, for any flags. Compiler options that change operations and
 * define a macro stop the compilation here; wh_scene_start() detects the others (arithmetic.h). */
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

/* The values 16 and 32 are allowed: types smaller than float are then computed in their own precision. */
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && __FLT_EVAL_METHOD__ != 16 && \
    __FLT_EVAL_METHOD__ != 32 && \
    !(WH_DOUBLE && (__FLT_EVAL_METHOD__ == 1 || __FLT_EVAL_METHOD__ == 64))
#error \
    "Whirl computes the same bits everywhere, and this compiler keeps intermediate results in a higher precision: on x86 use -msse2 -mfpmath=sse, on s390x -std=gnu11."
#endif

/* Tools that predefine no macros, such as cppcheck, skip this check. For compilers without these macros,
 * wh_scene_start() checks the arithmetic. */
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

/* A size for macros in C and C++, without an old-style cast in C++. */
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

/* Generated code inlines these functions, except on processors without floating-point arithmetic: a call costs little
 * there compared with the arithmetic, and their flash is small. */
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

/* 1 on a chip that passes reals in floating-point registers and has small flash. There, all scenes share one function
 * for a rare path. */
#if defined(__ARM_PCS_VFP) && !WH_DOUBLE && !(defined(WH_MULTI_STEP) && WH_MULTI_STEP)
#define WH_REALS_IN_REGISTERS 1
#else
#define WH_REALS_IN_REGISTERS 0
#endif

/* WH_CALLED marks a function that is not inlined if flash is scarcer than time (-DWH_SMALL=1). The compiler
 * underestimates the flash that an inlined copy takes. WH_SHARED marks such a function in a header; it is inlined if
 * flash is not scarce. */
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

/* WH_COLD marks a function that rarely runs, WH_SELDOM a condition that is rarely true. Compilers optimize such code
 * for size and place it away from the rest. */
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

/* Errors are negative; zero is success. X(name, value, the text that wh_status_text() returns). */
#define WH_STATUS_ROWS(X) \
    X(WH_OK, 0, "ok") \
    /* A step gave a state that is not finite or absurdly large; the last good state is kept. */ \
    X(WH_E_DIVERGED, -1, "the state diverged") \
    /* The caller gave too little memory. */ \
    X(WH_E_MEMORY, -2, "the memory is too small for this scene") \
    /* An argument is outside its documented range. */ \
    X(WH_E_ARGUMENT, -3, "an argument is out of range") \
    /* The last good state is kept. */ \
    X(WH_E_UNDEFINED, -4, "an expression of a contact is not a finite number") \
    /* At this state the holds allow more than one motion; the last good state is kept. */ \
    X(WH_E_SINGULAR, -5, "holds allow more than one motion") \
    /* The program is compiled or set up so that its bits would differ from those of all other builds: see arithmetic.h. */ \
    X(WH_E_ARITHMETIC, -6, "the arithmetic is not that of IEEE 754")

#define WH_STATUS_VALUE(name, value, words) name = (value),
typedef enum wh_status { WH_STATUS_ROWS(WH_STATUS_VALUE) } wh_status;
#undef WH_STATUS_VALUE

#endif
