/* root.c: the square root in integers. The number is x * 4^k with 1 <= x < 4, and its root is sqrt(x) * 2^k. No root
 * lies halfway between two numbers (its square would have more bits than x can have), so there are no ties. */
#include "root.h"

#if WH_DOUBLE
typedef uint64_t word;
#define FRACTION_BITS 52
#define BIAS 1023
#else
typedef uint32_t word;
#define FRACTION_BITS 23
#define BIAS 127
#endif

#define ONE ((word)1 << FRACTION_BITS) /* 1.0 with FRACTION_BITS after the point */
#define INFINITE (((word)2 * BIAS + 1) << FRACTION_BITS)
#define SIGN ((word)1 << (sizeof(word) * 8U - 1U))

typedef union real_bits {
    wh_real real;
    word bits;
} real_bits;

/* 1: a float's root is computed bit by bit, for processors on which a 64-bit product is slower than 25 comparisons. */
#ifndef WH_ROOT_BY_BITS
#define WH_ROOT_BY_BITS 0
#endif

#if WH_DOUBLE || WH_ROOT_BY_BITS

/* Returns sqrt(x), rounded to nearest, bit by bit. x and the root have FRACTION_BITS after the point. */
static word root_of(word x) {
    word rest = x << 1;
    word twice = 0;
    word root = 0;
    for (word bit = ONE << 1; bit != 0; bit >>= 1) {
        if (twice + bit <= rest) {
            rest -= twice + bit;
            twice += bit << 1;
            root += bit;
        }
        rest <<= 1;
    }
    return (root + 1U) >> 1; /* round, because root has one bit too many */
}

#else

/* 2^8/sqrt(x): 16 values for x from 1 to 2, then 16 values for x from 2 to 4. */
static const uint8_t reciprocal_root[32] = {
    252, 245, 238, 232, 226, 221, 216, 211, 207, 203, 199, 195, 192, 189, 185, 182,
    178, 173, 168, 164, 160, 156, 153, 149, 146, 143, 141, 138, 136, 133, 131, 129,
};

static uint32_t high_half(uint32_t a, uint32_t b) { return (uint32_t)((uint64_t)a * b >> 32); }

/* Returns sqrt(x), rounded to nearest, by two Newton steps for 1/sqrt(x) and one for sqrt(x). */
static word root_of(word x) {
    const bool two = x >= ONE << 1; /* 2 <= x < 4 */
    const unsigned stretch = (unsigned)(two ? 16U + (x >> 20 & 15U) : x >> 19 & 15U);
    const uint32_t scaled = x << 7;                                /* x * 2^30 */
    uint32_t r = (uint32_t)reciprocal_root[stretch] << 23;         /* 2^31/sqrt(x) */
    for (unsigned i = 0; i < 2; i++) {                             /* r' = r (3 - x r^2) / 2 */
        const uint32_t x_r_r = high_half(scaled, high_half(r, r)); /* x r^2 * 2^28 */
        r = high_half(r, ((UINT32_C(3) << 28) - x_r_r) << 2) << 1;
    }
    uint32_t root = high_half(scaled, r) >> 6;
    /* x * 2^46 minus the root's square. The difference is small, so 32 bits can hold it. */
    const int32_t rest = (int32_t)((x << 23) - root * root);
    root += (uint32_t)(((int64_t)rest * r + (INT64_C(1) << 54)) >> 55);
    return root;
}

#endif

wh_real wh_sqrt(wh_real x) {
    real_bits as = {.real = x};
    if (as.bits - ONE >= INFINITE - ONE) { /* x is not a normal positive number */
        if ((as.bits & ~SIGN) == 0 || as.bits == INFINITE) {
            return x;
        }
        if (as.bits > INFINITE) {
            as.bits |= INFINITE | ONE >> 1; /* NaN */
            return as.real;
        }
    }
    int exponent = (int)(as.bits >> FRACTION_BITS);
    word fraction = as.bits & (ONE - 1U);
    if (exponent == 0) { /* subnormal */
        for (exponent = 1; fraction < ONE; exponent--) {
            fraction <<= 1;
        }
    }
    fraction |= ONE;
    if (exponent % 2 == 0) { /* exponent - BIAS is odd, because BIAS is odd */
        fraction <<= 1;
    }
    /* the root's leading bit increments the exponent */
    as.bits = ((word)((exponent + BIAS) / 2 - 1) << FRACTION_BITS) + root_of(fraction);
    return as.real;
}
