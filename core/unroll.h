/* unroll.h: loops that generated code has unrolled, and what gcc is to leave undone there. Part of step.h. */
#ifndef WH_UNROLL_H
#define WH_UNROLL_H

#ifdef __cplusplus
#error \
    "core/unroll.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

/* Most coordinates (second order) or components (first order). A generated scene defines its own
 * and has its loops unrolled: by itself no compiler does, and arrays indexed by a counter stay in memory. */
#ifndef WH_COORDS
#define WH_COORDS 64
#define WH_UNROLL
#endif
#ifdef WH_UNROLL /* as it is */
#elif defined(__clang__)
#define WH_UNROLL _Pragma("clang loop unroll(full)")
#define WH_UNROLLS
#pragma clang diagnostic ignored "-Wpass-failed" /* loops whose bound is no constant stay loops */
#elif defined(__GNUC__) && __GNUC__ >= 8         /* which older ones do not know */
#define WH_UNROLL _Pragma("GCC unroll 64")
#define WH_UNROLLS
#else
#define WH_UNROLL
#endif

/* Older ones unroll loops whose bounds are constants by themselves where they are asked to compile for speed: on an ATmega328P
 * a step takes 15 to 30 % fewer cycles. Generated code says which step is small enough: contacts, books, compensated sums
 * and long lists would take two or three times the flash. */
#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ < 8 && defined(WH_SMALL_STEP)
#pragma GCC optimize("O3")
#endif

/* gcc would sink what a stage computes below the checks of the next one, where more of it has to be kept: up to 8 %
 * more instructions a step; and load, beside each check, the number that a refused step is blamed with: up to 3 %; and call
 * memcpy() for a loop over one or two values. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-sink", "no-if-conversion2", "no-tree-loop-distribute-patterns", \
                     "no-tree-slp-vectorize")
#endif

/* A long list is written in an order with few values live at a time. Where there are registers for that, gcc would put
 * its operations where their results come soonest and their operands stand, before it gives them registers: for ten links
 * of a pendulum 14 % more instructions a step on a Cortex-M4F, a third more code on an RV32IMAFC or an AArch64. (Short
 * lists fit into registers and have cycles to gain by it.) */
#if defined(WH_LONG_LIST) && defined(__GNUC__) && !defined(__clang__) && \
    (defined(__ARM_FP) || defined(__aarch64__) || defined(__riscv_flen))
#pragma GCC optimize("no-schedule-insns", "no-tree-ter")
#endif

#endif
