/* text.c: numbers as text, exactly and without the C library. */
#include "text.h"

/* A number is an array of bytes, low byte first, with the point between two of them. Adding, multiplying by ten and
 * dividing by ten then need only 16 bits at a time, which is cheap on every machine. */
#define FRACTION_BYTES 20U /* 2^-160: below every float's last bit (2^-149) */
#define WHOLE_BYTES 16U    /* 2^128: above every float */
#define BYTES (FRACTION_BYTES + WHOLE_BYTES + 8U) /* 8 bytes are room for a factor of 10^18 */
#define DIGITS (39U + WH_TEXT_DECIMALS_MAX)       /* digits of 2^128, and decimals */

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

/* Divides byte[count] by 10 in place. Returns the remainder. */
static unsigned divide_by_ten(uint8_t *byte, unsigned count) {
    unsigned rest = 0;
    while (count-- > 0) {
        const unsigned value = rest << 8 | byte[count];
        byte[count] = (uint8_t)(value / 10U);
        rest = value % 10U;
    }
    return rest;
}

/* Adds the whole number in byte[count], divided by 10^decimals, to the text. Destroys byte[]. */
static void add_digits(wh_text *text, uint8_t *byte, unsigned count, unsigned decimals,
                       bool negative) {
    char digit[DIGITS]; /* the lowest digit comes first */
    unsigned digits = 0;
    bool any = false;
    for (;;) {
        while (count > 0 && byte[count - 1U] == 0) {
            count--;
        }
        if (count == 0 && digits > decimals) {
            break;
        }
        const unsigned next = divide_by_ten(byte, count);
        digit[digits++] = (char)('0' + next);
        any = any || next > 0;
    }
    if (negative && any) {
        wh_text_add_char(text, '-');
    }
    while (digits-- > 0) {
        wh_text_add_char(text, digit[digits]);
        if (digits == decimals && digits > 0) {
            wh_text_add_char(text, '.');
        }
    }
}

const char *wh_words_item(const char *list, unsigned number) {
    const char *item = list;
    for (; number > 0 && wh_word_at(list) != '\0'; number--) {
        item = list;
        while (wh_word_at(list++) != '\0') {
        }
    }
    return wh_word_at(list) != '\0' ? list : item;
}

void wh_text_add_unsigned(wh_text *text, uint64_t value) {
    uint8_t byte[sizeof value];
    for (unsigned i = 0; i < sizeof value; i++) {
        byte[i] = (uint8_t)value;
        value >>= 8;
    }
    add_digits(text, byte, sizeof byte, 0, false);
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

/* The magnitude is mantissa * 2^exponent. */
typedef struct parts {
    real_bits mantissa;
    int exponent;
    bool negative;
    bool special; /* infinity (mantissa 0) or NaN */
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

static void multiply_by_ten(uint8_t *byte) {
    unsigned carry = 0;
    for (unsigned i = 0; i < BYTES; i++) {
        carry += byte[i] * 10U;
        byte[i] = (uint8_t)carry;
        carry >>= 8;
    }
}

/* Rounds to a whole number, ties to even: adds 1/2 if the whole part is odd, otherwise 1/2 - 2^-160. */
static void round_to_whole(uint8_t *byte) {
    unsigned carry = byte[FRACTION_BYTES] & 1U;
    for (unsigned i = 0; i < BYTES; i++) {
        carry += byte[i] + (i < FRACTION_BYTES - 1U ? 0xFFU : i < FRACTION_BYTES ? 0x7FU : 0U);
        byte[i] = (uint8_t)carry;
        carry >>= 8;
    }
}

/* Copies the mantissa's bits into byte[BYTES], initially zero. Returns false if the number is 2^128 or more. Drops
 * bits below 2^-160: only doubles below 2^-107 have them, and 18 decimals of such doubles are 0. */
static bool lay(const parts *number, uint8_t *byte) {
    const int place = number->exponent + 8 * (int)FRACTION_BYTES;
    const int odd = place & 7;
    int at = (place - odd) / 8;
    for (real_bits bits = number->mantissa << odd; bits != 0; bits >>= 8, at++) {
        if (WH_DOUBLE && at >= (int)(FRACTION_BYTES + WHOLE_BYTES)) {
            return false;
        }
        if (!WH_DOUBLE || at >= 0) {
            byte[at] = (uint8_t)bits;
        }
    }
    return true;
}

void wh_text_add_fixed(wh_text *text, wh_real value, unsigned decimals) {
    const parts number = parts_of(value);
    uint8_t byte[BYTES] = {0};
    if (number.special) {
        wh_text_add(text, number.mantissa != 0 ? "nan" : number.negative ? "-inf" : "inf");
        return;
    }
    if (!lay(&number, byte)) {
        wh_text_add(text, number.negative ? "-huge" : "huge");
        return;
    }
    if (decimals > WH_TEXT_DECIMALS_MAX) {
        decimals = WH_TEXT_DECIMALS_MAX;
    }
    for (unsigned i = 0; i < decimals; i++) {
        multiply_by_ten(byte);
    }
    round_to_whole(byte);
    add_digits(text, byte + FRACTION_BYTES, BYTES - FRACTION_BYTES, decimals, number.negative);
}
