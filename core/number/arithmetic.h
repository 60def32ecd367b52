/* arithmetic.h: checks of the arithmetic in the file that includes it, on the machine that runs it. C only.
 *
 * real.h refuses compiler flags that macros reveal. Other faults have no macro: contraction that the pragmas do not
 * reach, clang's -fassociative-math and -freciprocal-math, a start-up file that flushes subnormals to zero, another
 * rounding mode. Such a fault changes results of wh_arithmetic(). The arguments are volatile, so that the compiler
 * cannot compute the results in advance. wh_scene_start() compares the results with references (scene.c). */
#ifndef WH_ARITHMETIC_H
#define WH_ARITHMETIC_H

#ifdef __cplusplus
#error "core/number/arithmetic.h is C only: C++ includes core/scene.h"
#endif

#include "../real.h"

/* The arguments of the checks, in flash (scene.c). */
typedef struct wh_probes {
    wh_real factor; /* 1 + r, with r > 0 so small that factor * factor rounds to 1 + 2 r */
    wh_real square; /* 1 + 2 r */
    wh_real one;
    wh_real quarter_unit; /* a quarter of a unit in the last place of 1 */
    wh_real half_unit;    /* the next number above half of a unit in the last place of 1 */
    wh_real least;        /* the smallest normal number */
    wh_real half;
    wh_real two;
    wh_real three;
    wh_real five;
    wh_real seven;
    wh_real ten;
    wh_real minus_zero;
    wh_real infinity;
} wh_probes;
#define wh_probe WH_NAME(wh_probe)
extern const wh_probes wh_probe;

typedef enum wh_probed {
    WH_PROBED_PRODUCT,   /* not 0 if a product enters a sum unrounded (contraction or x87) */
    WH_PROBED_ORDER,     /* not 0 if a sum is reordered */
    WH_PROBED_ROUNDING,  /* the ulp of 1; 0 if sums are rounded twice or downwards */
    WH_PROBED_SUBNORMAL, /* 0 if subnormal numbers are flushed to zero */
    /* 5/3, 7/3 and 10/3: wrong if the compiler multiplies by 1/3 instead of dividing by 3 */
    WH_PROBED_FIVE,
    WH_PROBED_SEVEN,
    WH_PROBED_TEN,
    WH_PROBED_THIRD,   /* 7/3, with a divisor that the compiler knows */
    WH_PROBED_ZERO,    /* +0; it is -0 if the compiler drops the addition of 0 */
    WH_PROBED_NAN,     /* 0 if the compiler assumes that NaN never occurs */
    WH_PROBED_LITERAL, /* 7/0.1; not 70 if the compiler rounds 0.1 from double to float */
    WH_PROBED_COUNT
} wh_probed;

static inline void wh_arithmetic(wh_real result[WH_PROBED_COUNT]) {
    const volatile wh_probes *probe = &wh_probe;
    const wh_real squared = probe->factor;
    const wh_real one = probe->one;
    const wh_real three = probe->three;
    const wh_real seven = probe->seven;
    result[WH_PROBED_PRODUCT] = squared * squared - probe->square;
    result[WH_PROBED_ORDER] = (one + probe->quarter_unit) - one;
    result[WH_PROBED_ROUNDING] = (one + probe->half_unit) - one;
    result[WH_PROBED_SUBNORMAL] = probe->least * probe->half * probe->two;
    result[WH_PROBED_FIVE] = probe->five / three;
    result[WH_PROBED_SEVEN] = seven / three;
    result[WH_PROBED_TEN] = probe->ten / three;
    result[WH_PROBED_THIRD] = seven / WH_R(3.0);
    result[WH_PROBED_ZERO] = probe->minus_zero + WH_R(0.0);
    const wh_real infinite = probe->infinity;
    const wh_real none = infinite - infinite;
    const bool noticed = !(WH_ABS(none) < one) && !(WH_ABS(infinite) < three);
    result[WH_PROBED_NAN] = noticed ? one : WH_R(0.0);
    result[WH_PROBED_LITERAL] = seven / WH_R(0.1);
}

/* Calls compute(), some file's wh_arithmetic(). Returns the first wrong result's index, or WH_PROBED_COUNT. */
#define wh_arithmetic_wrong WH_NAME(wh_arithmetic_wrong)
wh_probed wh_arithmetic_wrong(void (*compute)(wh_real *result));

#endif
