/* text.c: numbers as text, exactly and without the C library. */
#include "text.h"

#include "flash.h"

/* Sixteen bits a limb, low limb first: quotient and remainder by ten then need no more than a
 * 32-bit division, which every machine has or gets cheaply. */
#define WHOLE_LIMBS 8U     /* 2^128: above every float */
#define FRACTION_LIMBS 10U /* 2^-160: below every float's last bit (2^-149) */
#define LIMBS (FRACTION_LIMBS + WHOLE_LIMBS)
#define WHOLE_DIGITS 39U /* of 2^128 */

void wh_text_start(wh_text *text, char *bytes, unsigned size) {
    text->bytes = bytes;
    text->size = size;
    text->length = 0;
    text->truncated = false;
    bytes[0] = '\0';
}

void wh_text_add_char(wh_text *text, char character) {
    if (text->length + 1U >= text->size) {
        text->truncated = true;
        return;
    }
    text->bytes[text->length++] = character;
    text->bytes[text->length] = '\0';
}

void wh_text_add(wh_text *text, const char *string) {
    for (char next = wh_word_at(string); next != '\0'; next = wh_word_at(++string)) {
        wh_text_add_char(text, next);
    }
}

static bool all_zero(const uint16_t *limb, unsigned limbs) {
    uint16_t any = 0;
    for (unsigned i = 0; i < limbs; i++) {
        any |= limb[i];
    }
    return any == 0;
}

/* limb[] / 10 in place; returns the remainder. */
static unsigned divide_by_ten(uint16_t *limb, unsigned limbs) {
    uint32_t rest = 0;
    if (limbs ==
        1U) { /* as most numbers are at last; a processor of 8 bits divides 16 in a third of the time */
        const uint16_t value = limb[0];
        limb[0] = (uint16_t)(value / 10U);
        return value % 10U;
    }
    for (unsigned i = limbs; i-- > 0;) {
        const uint32_t value = (rest << 16) | limb[i];
        limb[i] = (uint16_t)(value / 10U);
        rest = value % 10U;
    }
    return (unsigned)rest;
}

/* limb[] * 10 in place; returns what overflows at the top, 0 to 9. */
static unsigned multiply_by_ten(uint16_t *limb, unsigned limbs) {
    uint32_t carry = 0;
    for (unsigned i = 0; i < limbs; i++) {
        const uint32_t value = limb[i] * UINT32_C(10) + carry;
        limb[i] = (uint16_t)value;
        carry = value >> 16;
    }
    return (unsigned)carry;
}

/* Digits of limb[] into digit[WHOLE_DIGITS], lowest first, destroying limb[]; at least one. */
static unsigned digits_of(uint16_t *limb, unsigned limbs, uint8_t *digit) {
    unsigned count = 0;
    do {
        while (limbs > 1U && limb[limbs - 1U] == 0) {
            limbs--;
        }
        digit[count++] = (uint8_t)divide_by_ten(limb, limbs);
    } while (limbs > 1U || limb[0] != 0);
    return count;
}

static void add_digits(wh_text *text, const uint8_t *digit, unsigned count) {
    while (count > 0) {
        wh_text_add_char(text, (char)('0' + digit[--count]));
    }
}

void wh_text_add_unsigned(wh_text *text, uint64_t value) {
    uint16_t limb[4];
    uint8_t digit[WHOLE_DIGITS] = {0};
    for (unsigned i = 0; i < 4; i++) {
        limb[i] = (uint16_t)value;
        value >>= 16;
    }
    add_digits(text, digit, digits_of(limb, 4, digit));
}

void wh_text_add_signed(wh_text *text, int64_t value) {
    if (value < 0) {
        wh_text_add_char(text, '-');
        wh_text_add_unsigned(text, UINT64_C(0) - (uint64_t)value);
    } else {
        wh_text_add_unsigned(text, (uint64_t)value);
    }
}

void wh_text_add_hex(wh_text *text, uint64_t value, unsigned digits) {
    while (digits > 0) {
        digits--;
        wh_text_add_char(text, wh_word_at(&"0123456789abcdef"[(value >> (4U * digits)) & 0xfU]));
    }
}

#if WH_DOUBLE
enum { MANTISSA_BITS = 52, EXPONENT_MAX = 0x7ff, BIAS = 1023 + MANTISSA_BITS };
typedef uint64_t real_bits;
#else
enum { MANTISSA_BITS = 23, EXPONENT_MAX = 0xff, BIAS = 127 + MANTISSA_BITS };
typedef uint32_t real_bits;
#endif

/* A float or double taken apart: magnitude = mantissa * 2^exponent. */
typedef struct parts {
    real_bits mantissa;
    int exponent;
    bool negative;
    bool special; /* infinity (mantissa 0) or not-a-number */
} parts;

static parts parts_of(wh_real value) {
    const union {
        wh_real value;
        real_bits bits;
    } as = {.value = value};
    const real_bits hidden = (real_bits)1 << MANTISSA_BITS;
    const int exponent = (int)((as.bits >> MANTISSA_BITS) & EXPONENT_MAX);
    parts result = {
        .mantissa = as.bits & (hidden - 1U),
        .exponent = (exponent == 0 ? 1 : exponent) - BIAS,
        .negative = (as.bits >> (sizeof as.bits * 8U - 1U)) != 0,
        .special = exponent == EXPONENT_MAX,
    };
    if (exponent != 0 && !result.special) {
        result.mantissa |= hidden;
    }
    return result;
}

/* Digits after the point into digit[0..decimals), lowest first, destroying fraction[]. Returns
 * whether the magnitude must be rounded up; `odd_whole` settles a tie when decimals is 0. */
static bool fraction_digits(uint16_t *fraction, unsigned decimals, bool odd_whole, uint8_t *digit) {
    bool odd = odd_whole;
    unsigned zeros = 0; /* at the low end they stay */
    for (unsigned i = decimals; i-- > 0;) {
        while (zeros < FRACTION_LIMBS && fraction[zeros] == 0) {
            zeros++;
        }
        digit[i] = (uint8_t)multiply_by_ten(fraction + zeros, FRACTION_LIMBS - zeros);
        odd = (digit[i] & 1U) != 0;
    }
    const uint16_t top = fraction[FRACTION_LIMBS - 1U];
    if (top != 0x8000U) {
        return top > 0x8000U;
    }
    return odd || !all_zero(fraction, FRACTION_LIMBS - 1U);
}

#if WH_DOUBLE
typedef uint64_t mantissa_bits;
#else
typedef uint32_t mantissa_bits;
#endif

/* The mantissa's bits into one long fixed-point number, zero so far: fraction limbs, then whole limbs. False: it is longer.
 * Bits below 2^-160 belong to doubles below 2^-107: far from any tie at 18 decimals. */
static bool lay(const parts *number, uint16_t *limb) {
    int place = number->exponent + 16 * (int)FRACTION_LIMBS;
    for (mantissa_bits bits = (mantissa_bits)number->mantissa; bits != 0; bits >>= 1, place++) {
        if ((bits & 1U) == 0 || place < 0) {
            continue;
        }
        if (place >= 16 * (int)LIMBS) {
            return false;
        }
        limb[place / 16] = (uint16_t)(limb[place / 16] | (1U << (place % 16)));
    }
    return true;
}

void wh_text_add_fixed(wh_text *text, wh_real value, unsigned decimals) {
    const parts number = parts_of(value);
    if (number.special && number.mantissa != 0) {
        wh_text_add(text, "nan");
        return;
    }
    if (number.special) {
        wh_text_add(text, number.negative ? "-inf" : "inf");
        return;
    }
    if (decimals > WH_TEXT_DECIMALS_MAX) {
        decimals = WH_TEXT_DECIMALS_MAX;
    }

    uint16_t limb[LIMBS] = {0};
    if (!lay(&number, limb)) {
        wh_text_add(text, number.negative ? "-huge" : "huge");
        return;
    }

    uint8_t digit[WH_TEXT_DECIMALS_MAX + WHOLE_DIGITS] = {0};
    uint16_t *whole = limb + FRACTION_LIMBS;
    const bool up = fraction_digits(limb, decimals, (whole[0] & 1U) != 0, digit);
    unsigned count = decimals + digits_of(whole, WHOLE_LIMBS, digit + decimals);
    if (up) {
        unsigned i = 0;
        while (i < count && digit[i] == 9) {
            digit[i++] = 0;
        }
        if (i == count) {
            digit[count++] = 1; /* 99.9 became 100.0: the digits had room, 2^128 begins with a 3 */
        } else {
            digit[i]++;
        }
    }
    unsigned zeros = 0;
    while (zeros < count && digit[zeros] == 0) {
        zeros++;
    }
    if (number.negative && zeros < count) {
        wh_text_add_char(text, '-');
    }
    add_digits(text, digit + decimals, count - decimals);
    if (decimals > 0) {
        wh_text_add_char(text, '.');
        add_digits(text, digit, decimals);
    }
}
