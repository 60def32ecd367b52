/* unroll.h: loops that generated code unrolls, and gcc optimizations that are switched off there. Part of step.h. */
#ifndef WH_UNROLL_H
#define WH_UNROLL_H

#ifdef __cplusplus
#error \
    "core/step/unroll.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

/* Most coordinates (second order) or components (first order). A generated scene defines its own number and unrolls its
 * loops. Compilers do not unroll them by themselves, and arrays indexed by a counter stay in memory. */
#ifndef WH_COORDS
#define WH_COORDS 64
#define WH_UNROLL
#endif
#ifdef WH_UNROLL /* as it is */
#elif defined(__clang__)
#define WH_UNROLL _Pragma("clang loop unroll(full)")
#define WH_UNROLLS
#pragma clang diagnostic ignored "-Wpass-failed" /* loops whose bound is no constant stay loops */
#elif defined(__GNUC__) && __GNUC__ >= 8         /* older ones do not know the pragma */
#define WH_UNROLL _Pragma("GCC unroll 64")
#define WH_UNROLLS
#else
#define WH_UNROLL
#endif

/* Older gcc unrolls loops with constant bounds only if it optimizes for speed: on an ATmega328P a step then takes 15 to
 * 30 % fewer cycles. Generated code marks steps that are small enough: contacts, ledgers, compensated sums and long
 * lists would need two or three times the flash. */
#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ < 8 && defined(WH_SMALL_STEP)
#pragma GCC optimize("O3")
#endif

/* gcc would sink a stage's computation below the checks of the next stage, where more values are live: up to 8 % more
 * instructions a step. It would also load, beside each check, the number of the component at fault: up to 3 %. And it
 * would call memcpy() for a loop over one or two values. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-sink", "no-if-conversion2", "no-tree-loop-distribute-patterns", \
                     "no-tree-slp-vectorize")
#endif

/* A long list is ordered for few live values. If the processor seems to have the registers, gcc reorders the operations
 * for latency before it allocates registers. For a pendulum of ten links this costs 14 % more instructions a step on a
 * Cortex-M4F, and a third more code on an RV32IMAFC or an AArch64. (Short lists fit into registers and gain cycles by it.) */
#if defined(WH_LONG_LIST) && defined(__GNUC__) && !defined(__clang__) && \
    (defined(__ARM_FP) || defined(__aarch64__) || defined(__riscv_flen))
#pragma GCC optimize("no-schedule-insns", "no-tree-ter")
#endif

#endif
