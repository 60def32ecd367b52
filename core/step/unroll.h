/* unroll.h: pragmas for generated code that unroll loops and switch off gcc optimizations. Part of step.h. */
#ifndef WH_UNROLL_H
#define WH_UNROLL_H

#ifdef __cplusplus
#error \
    "core/step/unroll.h is C only, for generated .c files: in C++ include core/scene.h and the generated headers"
#endif

/* Maximum number of coordinates (second order) or components (first order). If generated code defines WH_COORDS,
 * WH_UNROLL unrolls the next loop, so that arrays can be in registers. */
#ifndef WH_COORDS
#define WH_COORDS 64
#define WH_UNROLL
#endif
#ifdef WH_UNROLL
#elif defined(__clang__)
#define WH_UNROLL _Pragma("clang loop unroll(full)")
#define WH_UNROLLS
/* clang shall not warn that a loop without a constant bound is not unrolled */
#pragma clang diagnostic ignored "-Wpass-failed"
#elif defined(__GNUC__) && __GNUC__ >= 8 /* older versions do not know the pragma */
#define WH_UNROLL _Pragma("GCC unroll 64")
#define WH_UNROLLS
#else
#define WH_UNROLL
#endif

/* Older gcc unrolls loops only with -O3, which saves 15 to 30 % of a step's cycles on an ATmega328P. Without
 * WH_SMALL_STEP, -O3 would make a step two or three times as large. */
#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ < 8 && defined(WH_SMALL_STEP)
#pragma GCC optimize("O3")
#endif

/* These optimizations are off, because with them gcc
 * - moves a stage's computation below the checks of the next stage, where more values are live (up to 8 % more
 * instructions per step),
 * - loads, before each check, the index of the component that may fail (up to 3 %),
 * - packs pairs of values into vectors, and calls memcpy() for a loop over one or two values. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-sink", "no-if-conversion2", "no-tree-loop-distribute-patterns", \
                     "no-tree-slp-vectorize")
#endif

/* The operations of a long list are ordered so that few values are live at a time. On processors with many registers,
 * gcc reorders them for latency before it allocates registers; these options prevent that. For a pendulum of ten links
 * the reordering costs 14 % more instructions per step on a Cortex-M4F, and a third more code on an RV32IMAFC or an
 * AArch64. (Short lists fit into registers, and the reordering saves cycles.) */
#if defined(WH_LONG_LIST) && defined(__GNUC__) && !defined(__clang__) && \
    (defined(__ARM_FP) || defined(__aarch64__) || defined(__riscv_flen))
#pragma GCC optimize("no-schedule-insns", "no-tree-ter")
#endif

#endif
