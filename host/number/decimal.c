/* decimal.c: correctly rounded decimal input by long division of big integers, because the host's floating-point
 * arithmetic may vary. If the quotient's 63 or 64 bits do not decide the rounding, the remainder does. */
#include "host/number/decimal.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "host/number/functions.h"

enum { FRACTION = 52, BIAS = 1023, SPECIAL = 0x7ff };

char *hex_write(double value, char text[static HEX_SIZE]) {
    const uint64_t bits = number_bits(value);
    const int scale = (int)(bits >> FRACTION) & SPECIAL;
    uint64_t fraction = bits & ((UINT64_C(1) << FRACTION) - 1);
    const char *sign = bits >> 63 != 0 ? "-" : "";
    if (scale == SPECIAL) {
        snprintf(text, HEX_SIZE, "%s%s", fraction != 0 ? "" : sign, fraction != 0 ? "nan" : "inf");
        return text;
    }
    char digits[FRACTION / 4 + 2] = ".";
    int count = 1;
    for (; fraction != 0; count++) {
        digits[count] = "0123456789abcdef"[fraction >> (FRACTION - 4)];
        fraction = fraction << 4 & ((UINT64_C(1) << FRACTION) - 1);
    }
    digits[count > 1 ? count : 0] = '\0';
    const int exponent = scale > 0 ? scale - BIAS : count > 1 ? 1 - BIAS : 0; /* zero is 0x0p+0 */
    snprintf(text, HEX_SIZE, "%s0x%d%sp%+d", sign, scale > 0 ? 1 : 0, digits, exponent);
    return text;
}

/* === decimal notation ========================================================================= */

enum {
    /* A midpoint of two doubles has at most 768 significant digits. So the digits after the first DIGITS_MAX matter
     * only if one of them is not zero. A single digit 1 then replaces them. */
    DIGITS_MAX = 780,
    /* Limits of the first digit's decimal exponent. A number with a smaller exponent is below half of 2^-1074 and
     * becomes zero; one with a larger exponent becomes infinity. */
    PLACE_LEAST = -324,
    PLACE_MOST = 308,
    /* The largest number has 781 digits, which are 2595 bits. The division needs one more bit. */
    WORDS = 84,
    FIVES = 13, /* 5^13 is the largest power of 5 in a word */
    QUOTIENT_BITS = 64,
    MANTISSA = 53,
    EXPONENT_LEAST = -1022,
};
#define POWER_OF_FIVE UINT32_C(1220703125) /* 5^FIVES */
#define INFINITY_BITS (UINT64_C(0x7ff) << 52)

/* A whole number: word[0] is the lowest, word[count - 1] is not 0. */
typedef struct big {
    int count;
    uint32_t word[WORDS];
} big;

static void times(big *n, uint32_t factor, uint32_t more) {
    uint64_t carry = more;
    for (int i = 0; i < n->count; i++) {
        carry += (uint64_t)n->word[i] * factor;
        n->word[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0) {
        n->word[n->count++] = (uint32_t)carry;
    }
}

static void times_fives(big *n, int power) {
    for (; power >= FIVES; power -= FIVES) {
        times(n, POWER_OF_FIVE, 0);
    }
    for (; power > 0; power--) {
        times(n, 5, 0);
    }
}

static int length_in_bits(const big *n) {
    int bits = 32 * (n->count - 1);
    for (uint32_t top = n->word[n->count - 1]; top != 0; top >>= 1) {
        bits++;
    }
    return bits;
}

static void shift_left(big *n, int bits) {
    const int words = bits / 32;
    memmove(n->word + words, n->word, (size_t)n->count * sizeof n->word[0]);
    memset(n->word, 0, (size_t)words * sizeof n->word[0]);
    n->count += words;
    times(n, UINT32_C(1) << bits % 32, 0);
}

static bool below(const big *a, const big *b) {
    if (a->count != b->count) {
        return a->count < b->count;
    }
    for (int i = a->count - 1; i >= 0; i--) {
        if (a->word[i] != b->word[i]) {
            return a->word[i] < b->word[i];
        }
    }
    return false;
}

/* Computes a -= b for b <= a. */
static void take_away(big *a, const big *b) {
    uint64_t borrow = 0;
    for (int i = 0; i < a->count; i++) {
        const uint64_t part = (i < b->count ? b->word[i] : 0) + borrow;
        borrow = a->word[i] < part ? 1 : 0;
        a->word[i] = (uint32_t)(a->word[i] - part);
    }
    while (a->count > 0 && a->word[a->count - 1] == 0) {
        a->count--;
    }
}

/* A number: its significant digits as a whole number, times 10^exponent. */
typedef struct digits {
    big whole; /* count 0: zero */
    int held;  /* number of significant digits taken so far */
    bool more; /* a later digit is not zero */
    int64_t exponent;
} digits;

static void take_digit(digits *d, int digit, bool behind_point) {
    if (d->held == DIGITS_MAX) {
        d->more = d->more || digit != 0;
        d->exponent += behind_point ? 0 : 1;
        return;
    }
    if (d->held > 0 || digit != 0) {
        times(&d->whole, 10, (uint32_t)digit);
        d->held++;
    }
    d->exponent -= behind_point ? 1 : 0;
}

/* Adds the exponent at `text`, which begins with an e, to *exponent. If the part read so far is 1e12 or more,
 * further digits are ignored. Returns the end of the exponent, or NULL if it has no digits. */
static const char *read_exponent(const char *text, int64_t *exponent) {
    const bool negative = text[1] == '-';
    const char *at = text + (negative || text[1] == '+' ? 2 : 1);
    if (*at < '0' || *at > '9') {
        return NULL;
    }
    int64_t value = 0;
    for (; *at >= '0' && *at <= '9'; at++) {
        value = value < INT64_C(1000000000000) ? 10 * value + (*at - '0') : value;
    }
    *exponent += negative ? -value : value;
    return at;
}

/* Returns floor(n / m * 2^63) for n / m between 1/2 and 2, and overwrites n. *rest: true if there is a remainder. */
static uint64_t divide(big *n, const big *m, bool *rest) {
    uint64_t quotient = 0;
    for (int i = 0; i < QUOTIENT_BITS; i++) {
        quotient <<= 1;
        if (!below(n, m)) {
            take_away(n, m);
            quotient |= 1U;
        }
        times(n, 2, 0);
    }
    *rest = n->count != 0;
    return quotient;
}

/* Returns the double nearest to quotient * 2^exponent, as its bits. */
static uint64_t rounded(uint64_t quotient, int exponent, bool rest, int *side) {
    const int bits = quotient >> (QUOTIENT_BITS - 1) != 0 ? QUOTIENT_BITS : QUOTIENT_BITS - 1;
    const int power = exponent + bits - 1; /* exponent of the highest bit */
    const int kept = power >= EXPONENT_LEAST ? MANTISSA : MANTISSA - (EXPONENT_LEAST - power);
    *side = 1;
    if (kept < 0) {
        return 0;
    }
    const int dropped = bits - kept;
    const uint64_t whole = dropped < QUOTIENT_BITS ? quotient >> dropped : 0;
    const uint64_t half = UINT64_C(1) << (dropped - 1);
    const uint64_t left = quotient & (half | (half - 1));
    const bool is_exact = left == 0 && !rest;
    const bool up = left > half || (left == half && (rest || (whole & 1U) != 0));
    const uint64_t scale =
        power >= EXPONENT_LEAST ? (uint64_t)(power - EXPONENT_LEAST) << (MANTISSA - 1) : 0;
    /* This is a sum, because bit 52 of `whole` must increase the exponent field. */
    const uint64_t made = scale + whole + (up ? 1U : 0U);
    if (made >= INFINITY_BITS) {
        *side = -1;
        return INFINITY_BITS;
    }
    *side = is_exact ? 0 : up ? -1 : 1;
    return made;
}

static uint64_t nearest(digits *d, int *side) {
    *side = 0;
    if (d->whole.count == 0) {
        return 0;
    }
    const int64_t first = d->exponent + d->held - 1; /* 10^first <= the number */
    if (first > PLACE_MOST) {
        *side = -1;
        return INFINITY_BITS;
    }
    if (first < PLACE_LEAST) {
        *side = 1;
        return 0;
    }
    if (d->more) {
        times(&d->whole, 10, 1);
        d->exponent--;
    }
    const int exponent = (int)d->exponent;
    big under = {1, {1}};
    times_fives(exponent < 0 ? &under : &d->whole, exponent < 0 ? -exponent : exponent);
    const int longer = length_in_bits(&d->whole) - length_in_bits(&under);
    shift_left(longer > 0 ? &under : &d->whole, longer > 0 ? longer : -longer);
    bool rest;
    const uint64_t quotient = divide(&d->whole, &under, &rest);
    return rounded(quotient, longer + exponent - (QUOTIENT_BITS - 1), rest, side);
}

double decimal_read_side(const char *text, const char **end, int *side) {
    const bool negative = *text == '-';
    const char *at = text + (negative || *text == '+' ? 1 : 0);
    digits d = {.held = 0};
    bool found = false;
    bool behind_point = false;
    for (; (*at >= '0' && *at <= '9') || (*at == '.' && !behind_point); at++) {
        if (*at == '.') {
            behind_point = true;
        } else {
            found = true;
            take_digit(&d, *at - '0', behind_point);
        }
    }
    if (found && (*at == 'e' || *at == 'E')) {
        const char *behind = read_exponent(at, &d.exponent);
        at = behind != NULL ? behind : at;
    }
    if (end != NULL) {
        *end = found ? at : text;
    }
    *side = 0;
    if (!found) {
        return 0.0;
    }
    const uint64_t bits = nearest(&d, side) | (negative ? UINT64_C(1) << 63 : 0);
    *side = negative ? -*side : *side;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double decimal_read(const char *text, const char **end) {
    int side;
    return decimal_read_side(text, end, &side);
}

char *number_shortest(double value, char text[static NUMBER_SIZE]) {
    value = number_shown(value);
    for (int places = 15; places <= 17; places++) {
        snprintf(text, NUMBER_SIZE, "%.*g", places, value);
        if (decimal_read(text, NULL) == value) {
            break;
        }
    }
    return text;
}
