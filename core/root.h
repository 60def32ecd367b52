/* root.h: the square root, correctly rounded, without a library.
 *
 * WH_SQRT(x) is the processor's instruction if possible, otherwise wh_sqrt(). Both give the same bits. Outside x86, use
 * -fno-math-errno. Without it, WH_SQRT(x) is wh_sqrt(), because __builtin_sqrtf() would call libm's sqrtf to set errno
 * for negative numbers. */
#ifndef WH_ROOT_H
#define WH_ROOT_H

#include "real.h"

WH_C_BEGIN

#define wh_sqrt WH_NAME(wh_sqrt)

/* Rounded to nearest. Infinity and both zeros are their own roots; negative numbers and NaN give NaN (IEEE 754). */
wh_real wh_sqrt(wh_real x);

/* 1 if the compiler's square root is one instruction without a call. */
#if defined(__GNUC__) && defined(__NO_MATH_ERRNO__)
#if defined(__aarch64__) || defined(__wasm__)
#define WH_ROOT_BUILTIN 1
#elif defined(__ARM_FP) /* mask 4: float, mask 8: double */
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
    /* All lanes of the register get x, which is cheaper than zeros in the unused lanes. */
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

WH_C_END

#endif
