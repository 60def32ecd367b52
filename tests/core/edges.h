/* edges.h: shared by the suites of the core's functions: limits of numbers, arguments with known results, random numbers. */
#ifndef TESTS_CORE_EDGES_H
#define TESTS_CORE_EDGES_H

#include "core/function.h"
#include "core/hash.h"
#include "tests/scattered.h"
#include "unity.h"

#if WH_DOUBLE
#define INFINITE __builtin_inf()
#define NO_NUMBER __builtin_nan("")
#define LARGEST 1.7976931348623157e308
#define SMALLEST 4.9406564584124654e-324 /* subnormal */
#define NORMAL 2.2250738585072014e-308   /* the smallest of all digits */
#define LEAST_POWER (-1074)
#define MOST_POWER 1023
#define DIGITS 53
#else
#define INFINITE __builtin_inff()
#define NO_NUMBER __builtin_nanf("")
#define LARGEST 3.40282347e38f
#define SMALLEST 1.40129846e-45f
#define NORMAL 1.17549435e-38f
#define LEAST_POWER (-149)
#define MOST_POWER 127
#define DIGITS 24
#endif
#define ZERO WH_R(0.0)
#define ONE WH_R(1.0)
#define TWO WH_R(2.0)
#define HALF WH_R(0.5)
#define THREE WH_R(3.0)

static inline uint64_t bits_of(wh_real x) { return wh_hash_real(0, x); }

/* Equal bits, or both NaN. */
static inline bool same(wh_real a, wh_real b) {
    return bits_of(a) == bits_of(b) || (a != a && b != b);
}

typedef wh_real function_of_one(wh_real x);

typedef struct edge {
    wh_real x;
    wh_real wanted;
} edge;

static inline void expect_edges(function_of_one *f, const edge *edges, unsigned count,
                                bool is_odd) {
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(same(f(edges[i].x), edges[i].wanted));
        TEST_ASSERT_TRUE(!is_odd || same(f(-edges[i].x), -edges[i].wanted));
    }
}
#define EXPECT_EDGES(f, edges, is_odd) \
    expect_edges(f, edges, sizeof(edges) / sizeof((edges)[0]), is_odd)

static inline wh_real part(void) { return (wh_real)(int32_t)(scattered() >> 32) * WH_R(0x1p-31); }

static inline wh_real any(void) {
    const uint64_t word = scattered();
#if WH_DOUBLE
    const union {
        uint64_t bits;
        double value;
    } as = {.bits = word};
#else
    const union {
        uint32_t bits;
        float value;
    } as = {.bits = (uint32_t)(word >> 32)};
#endif
    return as.value;
}

/* NaNs count as equal: their bits depend on their origin. */
static inline uint64_t mixed(uint64_t hash, wh_real x) {
    return wh_hash_real(hash, x != x ? ONE : x);
}

#endif
