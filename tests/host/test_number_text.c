/* test_number_text.c: decimal numbers must be read as the closest double, hexadecimal numbers exactly. The
 * references are strtod() and printf("%a") of glibc, which round correctly. WHIRL_NUMBERS=N sets the number of texts
 * of each kind. Also UTF-8. */
#include <fenv.h>

#include "bits.h"
#include "command.h"
#include "derived.h"
#include "host/base/spelling.h"
#include "host/number/decimal.h"

enum { TEXT = 2048 };

static uint64_t seed = 20261121;

static int count_of(int least) {
    const char *set = getenv("WHIRL_NUMBERS");
    const int count = set != NULL ? (int)strtol(set, NULL, 10) : 0;
    return count > least ? count : least;
}

static int draw(int bound) { return (int)(random_bits(&seed) % (unsigned)bound); }

/* On which side of the closest double is the number? strtod() gives the number's neighbours if it rounds down and
 * up. */
static int side_of(const char *text, double closest) {
    fesetround(FE_DOWNWARD);
    const double down = strtod(text, NULL);
    fesetround(FE_UPWARD);
    const double up = strtod(text, NULL);
    fesetround(FE_TONEAREST);
    return down == up ? 0 : closest == down ? 1 : -1;
}

static void agrees(const char *text) {
    char *wanted_end;
    const char *end;
    const double wanted = strtod(text, &wanted_end);
    const double got = decimal_read(text, &end);
    if (bits_of(wanted) != bits_of(got) || end != wanted_end) {
        char message[2 * TEXT];
        snprintf(message, sizeof message, "%.300s: %a instead of %a, %d characters instead of %d",
                 text, got, wanted, (int)(end - text), (int)(wanted_end - text));
        TEST_FAIL_MESSAGE(message);
    }
    int side;
    const double again = decimal_read_side(text, NULL, &side);
    TEST_ASSERT_TRUE_MESSAGE(bits_of(again) == bits_of(got), text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(end != text ? side_of(text, wanted) : 0, side, text);
}

static size_t put_digits(char *text, size_t at, int count) {
    for (; count > 0; count--) {
        text[at++] = (char)('0' + draw(10));
    }
    text[at] = '\0';
    return at;
}

TEST(number_text, any_digits) {
    static const int longest[] = {3, 20, 40, 900};
    for (int i = 0; i < count_of((int)few_or_all(20000, 100000)); i++) {
        char text[TEXT] = "";
        const int most = longest[i % 100 == 0 ? 3 : draw(3)];
        size_t at = put_digits(text, (size_t)snprintf(text, TEXT, "%s", draw(4) == 0 ? "-" : ""),
                               1 + draw(most));
        if (draw(3) > 0) {
            at += (size_t)snprintf(text + at, TEXT - at, ".");
            at = put_digits(text, at, draw(most));
        }
        if (draw(3) > 0) {
            snprintf(text + at, TEXT - at, "e%d", draw(700) - 360);
        }
        agrees(text);
    }
}

TEST(number_text, doubles_again) {
    for (int i = 0; i < count_of((int)few_or_all(20000, 100000)); i++) {
        const double value = of_bits(random_bits(&seed));
        char text[64];
        if (isfinite(value)) {
            snprintf(text, sizeof text, "%.*e", draw(20), value);
            agrees(text);
            snprintf(text, sizeof text, "%.17g", value);
            TEST_ASSERT_TRUE_MESSAGE(decimal_read(text, NULL) == value, text);
        }
    }
}

/* Checks the exact middle of two doubles with all its digits, and numbers that differ from it in the last digit or
 * far after it. */
static void around_middle(uint64_t lower_bits) {
    char text[TEXT];
    const long double lower = (long double)of_bits(lower_bits);
    const long double upper = lower_bits + 1 == UINT64_C(0x7ff) << 52
                                  ? ldexpl(1.0L, 1024)
                                  : (long double)of_bits(lower_bits + 1);
    snprintf(text, TEXT, "%.1100Lf", (lower + upper) / 2.0L);
    size_t last = strlen(text) - 1;
    for (; text[last] == '0'; last--) {
        text[last] = '\0';
    }
    agrees(text);
    char beside[2 * TEXT];
    snprintf(beside, sizeof beside, "%s%0*d", text, 1 + draw(600), 1);
    agrees(beside);
    last -= text[last] == '.' ? 1 : 0;
    snprintf(beside, sizeof beside, "%s", text);
    beside[last]++; /* just above the tie */
    agrees(beside);
    beside[last] = (char)(text[last] - 1);
    if (text[last] > '0') {
        agrees(beside);
        if (strchr(beside, '.') != NULL) {
            memset(beside + strlen(text), '9', 30);
            beside[strlen(text) + 30] = '\0';
            agrees(beside);
        }
    }
}

TEST(number_text, halfway) {
    for (int i = 0; i < count_of((int)few_or_all(800, 4000)); i++) {
        around_middle(random_bits(&seed) % (UINT64_C(0x7ff) << 52));
        around_middle(random_bits(&seed) >> (12 + draw(52))); /* for subnormal numbers */
        around_middle((UINT64_C(1) << 52) - 3 + (uint64_t)draw(6));
        around_middle((UINT64_C(0x7ff) << 52) - 1 -
                      (uint64_t)draw(3)); /* near DBL_MAX, and above */
    }
    around_middle(0);
}

TEST(number_text, places_and_ends) {
    char texts[] = "0|-0|0.0|0e5|0e-99999999999999999999|1e-400|-1e-400|1e400|-1e400|"
                   "1e99999999999999999999|1e-99999999999999999999|2.4703282292062327e-324|"
                   "2.4703282292062328e-324|4.9406564584124654e-324|2.2250738585072011e-308|"
                   "2.2250738585072014e-308|1.7976931348623157e308|1.7976931348623158e308|"
                   "1.7976931348623159e308|9007199254740993|9007199254740993.0000000000000000001|"
                   "1.e3|.5|-.5e1|+7|-|.|e5|-.e5|1e|1e+|1e-x|1..2|1.5.5|12abc|3 4|"
                   "00000000000000000000000000000001|0.1|1e23|8.5e22";
    char *rest = NULL;
    for (char *each = strtok_r(texts, "|", &rest); each != NULL;
         each = strtok_r(NULL, "|", &rest)) {
        agrees(each);
    }
    agrees("");
    char text[TEXT];
    snprintf(text, TEXT, "0.%0*d", 400, 1); /* 400 leading zeros */
    agrees(text);
    snprintf(text, TEXT, "1%0*de-1400", 1400, 0);
    agrees(text);
    snprintf(text, TEXT, "0.%0*de1400", 1400, 1);
    agrees(text);
    const char *end;
    TEST_ASSERT_TRUE(decimal_read("inf", &end) == 0.0 && *end == 'i');
    TEST_ASSERT_TRUE(decimal_read("0x10", &end) == 0.0 && *end == 'x');
    TEST_ASSERT_TRUE(decimal_read(" 1", &end) == 0.0 && *end == ' ');
}

static void hex_agrees(uint64_t bits) {
    char text[HEX_SIZE];
    const double value = of_bits(bits);
    char *end;
    const double back = strtod(hex_write(value, text), &end);
    TEST_ASSERT_TRUE_MESSAGE(bits_of(back) == bits && *end == '\0', text);
#ifdef __GLIBC__ /* other libraries normalise subnormal numbers */
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%a", value);
    TEST_ASSERT_EQUAL_STRING(wanted, text);
#endif
}

TEST(number_text, hexadecimal) {
    const uint64_t infinite = UINT64_C(0x7ff) << 52;
    for (int i = 0; i < count_of((int)few_or_all(20000, 100000)); i++) {
        const uint64_t bits = random_bits(&seed);
        hex_agrees((bits & ~(bits >> 63 << 63)) % infinite | bits >> 63 << 63);
        hex_agrees(bits >> (12 + draw(52)));
        hex_agrees((uint64_t)draw(2047) << 52 | random_bits(&seed) >> 12 >> draw(52));
        hex_agrees(bits_of((double)draw(1000) / 8.0));
    }
    hex_agrees(0);
    hex_agrees(UINT64_C(1) << 63);
    hex_agrees(bits_of(DBL_MAX));
    hex_agrees(bits_of(DBL_MIN));
    hex_agrees(infinite);
    char text[HEX_SIZE];
    TEST_ASSERT_EQUAL_STRING("nan", hex_write(of_bits(infinite | 1), text));
    TEST_ASSERT_EQUAL_STRING("nan", hex_write(of_bits(~UINT64_C(0)), text));
}

/* UTF-8: all pairs of first bytes, then bytes at the limits of their ranges, in texts of any length. Compared with
 * arithmetic: the code point, and whether it has its shortest spelling. */

/* Number of bytes of a printable code point; 0 for surrogates, values above the last code point, and controls above
 * ASCII. */
static unsigned shortest(uint32_t point) {
    if (point > 0x10ffffU || (point >= 0xd800U && point <= 0xdfffU) ||
        (point >= 0x80U && point <= 0x9fU)) {
        return 0;
    }
    const unsigned bits[] = {7, 11, 16, 21};
    unsigned bytes = 1;
    while (point >> bits[bytes - 1] != 0) {
        bytes++;
    }
    return bytes;
}

static unsigned expected(const unsigned char *text, unsigned left) {
    unsigned ones = 0;
    while (ones < 8 && (text[0] & (0x80U >> ones)) != 0) {
        ones++;
    }
    if (ones == 0) {
        return 1;
    }
    if (ones == 1 || ones > 4 || ones > left) {
        return 0;
    }
    uint32_t point = text[0] & (0x7fU >> ones);
    for (unsigned i = 1; i < ones; i++) {
        if (text[i] >> 6 != 2) {
            return 0;
        }
        point = point << 6 | (text[i] & 0x3fU);
    }
    return shortest(point) == ones ? ones : 0;
}

TEST(number_text, every_pair_of_bytes) {
    static const unsigned char edges[] = {0x00, 0x7f, 0x80, 0xbf, 0xc0};
    unsigned wrong = 0;
    unsigned characters = 0;
    for (unsigned pair = 0; pair < 0x10000U; pair++) {
        for (unsigned i = 0; i < sizeof edges * sizeof edges; i++) {
            const unsigned char text[] = {(unsigned char)(pair >> 8), (unsigned char)(pair & 0xffU),
                                          edges[i / sizeof edges], edges[i % sizeof edges]};
            for (unsigned left = 1; left <= sizeof text; left++) {
                const unsigned bytes = expected(text, left);
                wrong += utf8_length((const char *)text, left) != bytes;
                characters += bytes > 1;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_GREATER_THAN_UINT(100000, characters);
}

SUITE(number_text) { printf("number_text: seed %" PRIu64 "\n", seed); }
