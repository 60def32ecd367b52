/* root.h: the square root, correctly rounded, without a library.
 * WH_SQRT(x) is the processor's instruction if the compiler surely emits only that, and wh_sqrt() otherwise, with the same
 * bits. The obstacle is errno: without -fno-math-errno, compilers add a call of libm's sqrtf for negative numbers, or emit
 * only the call (-O0, -Os, -ffreestanding). x86 has an intrinsic that avoids errno; on other processors the flag saves
 * time. */
#ifndef WH_ROOT_H
#define WH_ROOT_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_sqrt WH_NAME(wh_sqrt)

/* The square root rounded to the nearest real, computed in integers. As in IEEE 754, infinity and both zeros are their
 * own roots; the roots of NaN and of negative numbers are NaN. */
wh_real wh_sqrt(wh_real x);

/* WH_ROOT_BUILTIN: the compiler's square root is one instruction, without a call. */
#if defined(__GNUC__) && defined(__NO_MATH_ERRNO__)
#if defined(__aarch64__) || defined(__wasm__)
#define WH_ROOT_BUILTIN 1
#elif defined(__ARM_FP) /* bits 4 and 8 are the supported sizes in bytes */
#define WH_ROOT_BUILTIN (__ARM_FP >> (WH_DOUBLE ? 3 : 2) & 1)
#elif defined(__riscv_flen) && defined(__riscv_fsqrt)
#define WH_ROOT_BUILTIN (__riscv_flen >= (WH_DOUBLE ? 64 : 32))
#endif
#endif
#ifndef WH_ROOT_BUILTIN
#define WH_ROOT_BUILTIN 0
#endif

#if defined(__GNUC__) && defined(__SSE2_MATH__) /* x86, computing with SSE */
WH_INLINE wh_real wh_root_sse(wh_real x) {
    /* the same number in all lanes: cheaper than zeros in the unused ones */
#if WH_DOUBLE
    typedef double reals __attribute__((vector_size(16)));
    const reals all = {x, x};
    return __builtin_ia32_sqrtsd(all)[0];
#else
    typedef float reals __attribute__((vector_size(16)));
    const reals all = {x, x, x, x};
    return __builtin_ia32_sqrtss(all)[0];
#endif
}
#define WH_SQRT(x) wh_root_sse(x)
#elif WH_ROOT_BUILTIN && WH_DOUBLE
#define WH_SQRT(x) __builtin_sqrt(x)
#elif WH_ROOT_BUILTIN
#define WH_SQRT(x) __builtin_sqrtf(x)
#else
#define WH_SQRT(x) wh_sqrt(x)
#endif

#ifdef __cplusplus
}
#endif
#endif
