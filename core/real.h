/* real.h: the number the core computes with, and the words every core file needs.
 *
 * Boards and `whirl run --number float` use float. Compiling with WH_DOUBLE=1 gives the reference
 * build in double. Both are freestanding and neither calls libm: with contraction switched off
 * (-ffp-contract=off) only IEEE 754 additions, multiplications, divisions, square roots and
 * conversions are left, so the same source gives the same bits on every machine.
 */
#ifndef WH_REAL_H
#define WH_REAL_H

#include <stdbool.h>
#include <stdint.h>

#ifndef WH_DOUBLE
#define WH_DOUBLE 0
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

/* The host links both builds of the core into one program, so the double one carries a suffix. */
#if WH_DOUBLE
#define WH_NAME(name) name##_d
#else
#define WH_NAME(name) name
#endif

#if defined(__GNUC__)
#define WH_INLINE static inline __attribute__((always_inline))
#else
#define WH_INLINE static inline
#endif

/* Errors are negative; zero is success. wh_status_text() says them in words. */
typedef enum wh_status {
    WH_OK = 0,
    WH_E_DIVERGED = -1, /* a step gave a non-finite or absurd state; the last good one is kept */
    WH_E_MEMORY = -2,   /* the caller's memory is too small for this scene */
    WH_E_ARGUMENT = -3, /* an argument is outside its documented range */
    WH_E_UNDEFINED =
        -4, /* a contact's expression is no finite number; the last good state is kept */
    WH_E_SINGULAR =
        -5 /* holds came to where they leave more than one motion; the last good state is kept */
} wh_status;

#include "root.h" /* WH_SQRT */

#endif
