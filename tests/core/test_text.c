/* test_text.c: numbers as text: exact characters, rounding, bounds. */
#include "core/text.h"

#include "tests/suites.h"

#if __STDC_HOSTED__
#include <stdio.h>
#include <string.h>
#endif

static char buffer[80];
static wh_text text;

static void start(void) { wh_text_start(&text, buffer, sizeof buffer); }

static void expect(const char *wanted) {
    TEST_ASSERT_EQUAL_STRING(wanted, buffer);
    TEST_ASSERT_FALSE(text.truncated);
}

static void expect_fixed(const char *wanted, wh_real value, unsigned decimals) {
    start();
    wh_text_add_fixed(&text, value, decimals);
    expect(wanted);
}

TEST(text, integers) {
    start();
    wh_text_add_unsigned(&text, 0);
    wh_text_add_char(&text, ' ');
    wh_text_add_unsigned(&text, UINT64_MAX);
    wh_text_add_char(&text, ' ');
    wh_text_add_signed(&text, INT64_MIN);
    wh_text_add_char(&text, ' ');
    for (int i = -1; i <= 1; i++) {
        wh_text_add_signed(&text, i);
        wh_text_add_char(&text, ' ');
    }
    wh_text_add_signed(&text, 1000);
    expect("0 18446744073709551615 -9223372036854775808 -1 0 1 1000");
}

TEST(text, hex) {
    start();
    wh_text_add(&text, "0x");
    wh_text_add_hex(&text, UINT64_C(0x0123456789abcdef), 16);
    wh_text_add_char(&text, ' ');
    wh_text_add_hex(&text, 0x1234, 2);
    wh_text_add_char(&text, ' ');
    wh_text_add_hex(&text, 0xa, 4);
    expect("0x0123456789abcdef 34 000a");
}

TEST(text, fixed) {
    expect_fixed("0.00", WH_R(0.0), 2);
    expect_fixed("0.0", -WH_R(0.0), 1);
    expect_fixed("3.14159", WH_R(3.14159274101257324), 5);
    expect_fixed("-12345.5", WH_R(-12345.5), 1);
    expect_fixed("0.0009765625", WH_R(0.0009765625), 10);
    expect_fixed("16777216", WH_R(16777216.0), 0);
}

TEST(text, fixed_rounding) {
    expect_fixed("0", WH_R(0.5), 0); /* ties go to the even digit */
    expect_fixed("2", WH_R(1.5), 0);
    expect_fixed("2", WH_R(2.5), 0);
    expect_fixed("0.12", WH_R(0.125), 2);
    expect_fixed("0.38", WH_R(0.375), 2);
    expect_fixed("100.0", WH_R(99.96875), 1);
    expect_fixed("0.00", WH_R(-0.001), 2);
}

TEST(text, fixed_extremes) {
#if !WH_DOUBLE
    expect_fixed("340282346638528859811704183484516925440", 3.40282347e+38f, 0);
    expect_fixed("0.000000000000000000", 1.4e-45f, 18);
    expect_fixed("0.100000001490116119", 0.1f, 18);
#else
    expect_fixed("huge", 1e300, 1);
    expect_fixed("-huge", -340282366920938463463374607431768211456.0, 1);
    expect_fixed("0.100000000000000006", 0.1, 18);
#endif
    const volatile wh_real zero = WH_R(0.0);
    expect_fixed("inf", WH_R(1.0) / zero, 3);
    expect_fixed("-inf", WH_R(-1.0) / zero, 3);
    start();
    wh_text_add_fixed(&text, (wh_real)__builtin_nanf(""), 3);
    expect("nan");
}

/* If more decimals are requested than possible, the number has the possible ones. Slightly more than a half is no tie.
 * Values below 2^-160 count as zero. */
TEST(text, fixed_beyond_its_room) {
    expect_fixed("0.500000000000000000", WH_R(0.5), WH_TEXT_DECIMALS_MAX + 1U);
    expect_fixed("-3.250000000000000000", WH_R(-3.25), 1000);
    expect_fixed("0", WH_R(0.5), 0);
    expect_fixed("1", WH_R(0.5) + WH_R(0x1p-20), 0);
    expect_fixed("0.2", WH_R(0.25), 1);
    expect_fixed("0.3", WH_R(0.25) + WH_R(0x1p-20), 1);
#if WH_DOUBLE
    expect_fixed("0.000000000000000000", 1e-300, 18);
    expect_fixed("0.0", -0x1.8p-161, 1);
#endif
}

/* A minus sign appears only if a digit is not zero. The values are half of the last digit times 2^-30 to 2^4, and the
 * neighbours of the tie. */
TEST(text, fixed_sign) {
    uint32_t random = 1;
    unsigned bare = 0;
    unsigned signs = 0;
    wh_real half = WH_R(0.5);
    for (unsigned decimals = 0; decimals <= WH_TEXT_DECIMALS_MAX; decimals++) {
        for (unsigned i = 0; i < 100; i++) {
            random = random * UINT32_C(1664525) + UINT32_C(1013904223);
            wh_real value = half * (WH_R(1.0) + (wh_real)(random >> 8) * WH_R(0x1p-24));
            for (unsigned k = (unsigned)((random >> 4) % 20U); k < 10U; k++) {
                value *= WH_R(0.5);
            }
            for (unsigned k = 10; k < (random >> 4) % 20U; k++) {
                value *= WH_R(2.0);
            }
            value = i == 0   ? half
                    : i == 1 ? half * (WH_R(1.0) - WH_R(0x1p-20))
                    : i == 2 ? half * (WH_R(1.0) + WH_R(0x1p-20))
                             : value;
            start();
            wh_text_add_fixed(&text, -value, decimals);
            bool any = false;
            for (const char *c = buffer; *c != '\0'; c++) {
                any = any || (*c >= '1' && *c <= '9');
            }
            TEST_ASSERT_EQUAL_INT(any ? '-' : '0', buffer[0]);
            bare += !any;
            signs += any;
        }
        half /= WH_R(10.0);
    }
    TEST_ASSERT_TRUE(bare > 300 && signs > 300);
}

TEST(text, full_buffer_truncates_text) {
    for (unsigned i = 0; i < sizeof buffer; i++) {
        buffer[i] = '#';
    }
    wh_text_start(&text, buffer, 6);
    wh_text_add(&text, "ab");
    wh_text_add_unsigned(&text, 12345);
    TEST_ASSERT_EQUAL_STRING("ab123", buffer);
    TEST_ASSERT_TRUE(text.truncated);
    TEST_ASSERT_EQUAL_UINT(5, text.length);
    TEST_ASSERT_EQUAL_INT('#', buffer[6]);
}

#if __STDC_HOSTED__
/* Compares 200,000 numbers of all sizes with the C library's conversion. */
static void test_fixed_agrees_with_printf(void) {
    uint64_t random = UINT64_C(0x9e3779b97f4a7c15);
    unsigned compared = 0;
    for (unsigned i = 0; i < 200000; i++) {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        union {
            float value;
            uint32_t bits;
        } pattern = {.bits = (uint32_t)random};
        const float value = i % 2 == 0 ? pattern.value : (float)(int64_t)random / 1.8446744e16f;
        if (!(value < 1e30f && value > -1e30f)) {
            continue;
        }
        const unsigned decimals = (unsigned)(random >> 40) % 13U;
        char wanted[80];
        snprintf(wanted, sizeof wanted, "%.*f", (int)decimals, (double)value);
        if (strpbrk(wanted, "123456789") == NULL && wanted[0] == '-') {
            /* the C library prints "-0"; the text has no sign then */
            memmove(wanted, wanted + 1, strlen(wanted));
        }
        start();
        wh_text_add_fixed(&text, (wh_real)value, decimals);
        if (strcmp(wanted, buffer) != 0) {
            TEST_FAIL_MESSAGE(wanted);
        }
        compared++;
    }
    TEST_ASSERT_TRUE(compared > 150000);
}
#endif

SUITE(text) {
#if __STDC_HOSTED__
    RUN_TEST(test_fixed_agrees_with_printf);
#endif
}
