/* test_convert.c: 64-bit integers convert to the nearest float, ties to even, whether the processor, the compiler's
 * support code or a board's own (boards/shared/convert.c) converts them. The reference applies the definition, in
 * integers. */
#include "core/real.h"

#include "tests/suites.h"

#define RANDOM_NUMBERS (WH_TEST_SMALL ? 2000U : 200000U)
#define KEPT_BITS 24U

static uint32_t bits_of(float real) {
    const union {
        float real;
        uint32_t bits;
    } as = {.real = real};
    return as.bits;
}

static float wide_to_float(uint64_t number) {
    volatile uint64_t hidden =
        number; /* hides the number from the compiler, which would convert it at compile time */
    return (float)hidden;
}

static float wide_signed_to_float(int64_t number) {
    volatile int64_t hidden = number;
    return (float)hidden;
}

static unsigned length_of(uint64_t number) {
    unsigned bits = 0;
    for (; number != 0; number >>= 1) {
        bits++;
    }
    return bits;
}

/* Returns the bits of the float nearest to `number`. */
static uint32_t nearest(uint64_t number) {
    const unsigned length = length_of(number);
    if (number == 0) {
        return 0;
    }
    uint64_t kept = number;
    if (length > KEPT_BITS) {
        const unsigned shift = length - KEPT_BITS;
        const uint64_t below = number & ((UINT64_C(1) << shift) - 1U);
        const uint64_t half = UINT64_C(1) << (shift - 1U);
        kept = number >> shift;
        kept += below > half || (below == half && (kept & 1U) != 0) ? 1U : 0U;
    } else {
        kept = number << (KEPT_BITS - length);
    }
    /* A carry out of the mantissa increments the exponent by itself. */
    return (uint32_t)(((uint64_t)(127U + length - 1U) << 23) + (kept - (UINT64_C(1) << 23)));
}

static void check(uint64_t number) {
    TEST_ASSERT_EQUAL_HEX32(nearest(number), bits_of(wide_to_float(number)));
    if (number <= (uint64_t)INT64_MAX) {
        TEST_ASSERT_EQUAL_HEX32(nearest(number), bits_of(wide_signed_to_float((int64_t)number)));
        if (number > 0) {
            TEST_ASSERT_EQUAL_HEX32(nearest(number) | UINT32_C(0x80000000),
                                    bits_of(wide_signed_to_float(-(int64_t)number)));
        }
    }
}

TEST(convert, around_powers_of_two) {
    for (unsigned e = 0; e < 64U; e++) {
        for (uint64_t d = 0; d < 4U; d++) {
            check((UINT64_C(1) << e) + d);
            check((UINT64_C(1) << e) - d);
        }
    }
    check(UINT64_MAX);
    TEST_ASSERT_EQUAL_HEX32(UINT32_C(0xDF000000), bits_of(wide_signed_to_float(INT64_MIN)));
}

/* Numbers in the middle between two floats, and their neighbours. */
TEST(convert, ties) {
    for (unsigned shift = 1; shift <= 40U; shift++) {
        for (uint64_t kept = (UINT64_C(1) << 23) + 5U; kept < (UINT64_C(1) << 23) + 9U; kept++) {
            const uint64_t middle = (kept << shift) + (UINT64_C(1) << (shift - 1U));
            check(middle);
            check(middle - 1U);
            check(middle + 1U);
        }
        const uint64_t last = ((UINT64_C(1) << KEPT_BITS) - 1U)
                              << shift; /* rounds up to a power of two */
        check(last + (UINT64_C(1) << (shift - 1U)));
    }
}

TEST(convert, numbers_of_any_length) {
    uint64_t seed = UINT64_C(0x9E3779B97F4A7C15);
    for (unsigned i = 0; i < RANDOM_NUMBERS; i++) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17; /* Marsaglia, Xorshift RNGs, 2003 */
        check(seed >> (i % 64U));
    }
}
