/* function_sine_double.c: sine, cosine and tangent in double, for angles of any size. The angle's mantissa is
 * multiplied by 192 bits of 2/pi, chosen by the angle's exponent (Payne and Hanek, ACM SIGNUM Newsletter 18 (1983) 1).
 * The product is the angle in quarter turns, modulo 4. No double is nearer to a nonzero multiple of a quarter turn than
 * 2^-62 quarter turns, so at least 70 bits of the remainder are correct. */
#include "function_double.h"

#if WH_DOUBLE

#define QUARTER_OF_PI 0x1.921fb54442d18p-1
#define SMALL 0x1p-28 /* for smaller x, sin x and tan x round to x */

/* 2/pi, in words of 64 bits, after a word of zeros. */
static const uint64_t two_by_pi[20] = {
    /* clang-format off */
    UINT64_C(0x0), UINT64_C(0xa2f9836e4e441529), UINT64_C(0xfc2757d1f534ddc0),
    UINT64_C(0xdb6295993c439041), UINT64_C(0xfe5163abdebbc561), UINT64_C(0xb7246e3a424dd2e0),
    UINT64_C(0x06492eea09d1921c), UINT64_C(0xfe1deb1cb129a73e), UINT64_C(0xe88235f52ebb4484),
    UINT64_C(0xe99c7026b45f7e41), UINT64_C(0x3991d639835339f4), UINT64_C(0x9c845f8bbdf9283b),
    UINT64_C(0x1ff897ffde05980f), UINT64_C(0xef2f118b5a0a6d1f), UINT64_C(0x6d367ecf27cb09b7),
    UINT64_C(0x4f463f669e5fea2d), UINT64_C(0x7527bac7ebe5f17b), UINT64_C(0x3d0739f78a5292ea),
    UINT64_C(0x6bfb5fb11f8d5d08), UINT64_C(0x56033046fc7b6bab),
    /* clang-format on */
};

typedef struct turned {
    wh_pair rest;      /* remaining angle in radians, at most an eighth of a turn */
    unsigned quarters; /* modulo 4 */
} turned;

typedef struct wave {
    wh_pair sine;
    wh_pair cosine;
} wave;

/* Returns the lower 64 bits of a b + *carry; *carry gets the upper 64 bits. */
static uint64_t product_lower(uint64_t a, uint64_t b, uint64_t *carry) {
    const uint64_t low = UINT64_C(0xffffffff);
    const uint64_t ll = (a & low) * (b & low) + (*carry & low);
    const uint64_t lh = (a & low) * (b >> 32) + (ll >> 32) + (*carry >> 32);
    const uint64_t hl = (a >> 32) * (b & low) + (lh & low);
    *carry = (a >> 32) * (b >> 32) + (lh >> 32) + (hl >> 32);
    return (hl << 32) | (ll & low);
}

/* Returns 64 bits of 2/pi, beginning with bit `first` of the table. */
static uint64_t bits_from(unsigned first) {
    const uint64_t *word = &two_by_pi[first / 64U];
    const unsigned shift = first % 64U;
    return shift == 0 ? word[0] : (word[0] << shift) | (word[1] >> (64U - shift));
}

/* Converts a fraction of a quarter turn to radians. It is 0.word[0] word[1] word[2] in binary, and at most 1/2. */
static wh_pair in_radians(uint64_t *word) {
    int exponent = 0;
    while (word[0] >> 63 == 0 && exponent > -128) {
        word[0] = (word[0] << 1) | (word[1] >> 63);
        word[1] = (word[1] << 1) | (word[2] >> 63);
        word[2] <<= 1;
        exponent--;
    }
    const double scale = wh_power_of_two(exponent - 53);
    const double high = (double)(int64_t)(word[0] >> 11) * scale;
    const uint64_t next = (word[0] << 53) | (word[1] >> 11);
    const double low = (double)(int64_t)(next >> 11) * (scale * 0x1p-53);
    const wh_pair half_pi = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54};
    const wh_pair product = wh_product(high, half_pi.high);
    return wh_pair_of(product.high, product.low + (high * half_pi.low + low * half_pi.high));
}

static turned reduced(double rad) {
    if (rad <= QUARTER_OF_PI) {
        return (turned){{rad, 0.0}, 0};
    }
    /* rad = mantissa 2^(field - 1075). Bits of 2/pi that contribute only whole turns are skipped. */
    const uint64_t bits = wh_bits(rad);
    const uint64_t mantissa = (bits & (UINT64_MAX >> 12)) | (UINT64_C(1) << 52);
    const unsigned field = (unsigned)(bits >> 52) & 2047U;
    const unsigned first = field > 1013U ? field - 1013U : 0U;
    uint64_t word[3];
    uint64_t carry = 0;
    for (unsigned i = 3; i-- > 0;) {
        word[i] = product_lower(mantissa, bits_from(first + 64U * i), &carry);
    }
    /* The top two bits are the number of whole quarter turns, modulo 4. The other bits are the fraction. */
    unsigned quarters = (unsigned)(word[0] >> 62);
    word[0] = (word[0] << 2) | (word[1] >> 62);
    word[1] = (word[1] << 2) | (word[2] >> 62);
    word[2] <<= 2;
    const bool over = word[0] >> 63 != 0;
    if (over) { /* the next quarter turn is nearer */
        quarters++;
        word[0] = ~word[0];
        word[1] = ~word[1];
        word[2] = ~word[2];
    }
    const wh_pair rest = in_radians(word);
    return (turned){{wh_signed(rest.high, over), wh_signed(rest.low, over)}, quarters & 3U};
}

/* Return (sin x - x + x^3/6)/x^5 and (cos x - 1 + x^2/2)/x^4, with z = x^2. */
static double sine_series(double z) {
    const double upper =
        -1.0 / 39916800.0 +
        z * (1.0 / 6227020800.0 + z * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)));
    return 1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0 + z * upper));
}

static double cosine_series(double z) {
    const double upper =
        -1.0 / 3628800.0 +
        z * (1.0 / 479001600.0 + z * (-1.0 / 87178291200.0 + z * (1.0 / 20922789888000.0 -
                                                                  z * (1.0 / 6402373705728000.0))));
    return 1.0 / 24.0 + z * (-1.0 / 720.0 + z * (1.0 / 40320.0 + z * upper));
}

static wave wave_of(wh_pair rest) {
    const wh_pair sixth = {-0x1.5555555555555p-3, -0x1.5555555555555p-57};
    const double x = rest.high;
    const wh_pair square = wh_product(x, x);
    const double z = square.high;
    const wh_pair cube = wh_product(z, x);
    const wh_pair third = wh_product(cube.high, sixth.high); /* -x^3/6 */
    const double third_low =
        third.low + (cube.high * sixth.low + (cube.low + square.low * x) * sixth.high);
    const double slope = 1.0 - 0.5 * z;
    const wh_pair sine = wh_pair_of(x, third.high);
    const double sine_low =
        sine.low + (third_low + rest.low * slope + cube.high * z * sine_series(z));
    const wh_pair cosine = wh_pair_of(1.0, -0.5 * z);
    const double cosine_low =
        cosine.low + (z * z * cosine_series(z) - 0.5 * square.low - rest.low * sine.high);
    return (wave){wh_pair_of(sine.high, sine_low), wh_pair_of(cosine.high, cosine_low)};
}

/* Returns the sine of the angle plus `quarters` quarter turns. */
static double sine_after(double rad, unsigned quarters) {
    const turned at = reduced(rad);
    const wave w = wave_of(at.rest);
    const unsigned turn = at.quarters + quarters;
    return wh_signed(turn % 2U != 0 ? w.cosine.high : w.sine.high, (turn & 2U) != 0);
}

double wh_sine(double rad) {
    const double size = WH_ABS(rad);
    if (!(size < WH_INFINITY)) {
        return WH_NAN;
    }
    return size < SMALL ? rad : wh_signed(sine_after(size, 0), rad < 0.0);
}

double wh_cosine(double rad) {
    const double size = WH_ABS(rad);
    if (!(size < WH_INFINITY)) {
        return WH_NAN;
    }
    return size < SMALL ? 1.0 : sine_after(size, 1);
}

double wh_tan(double rad) {
    const double size = WH_ABS(rad);
    if (!(size < WH_INFINITY)) {
        return WH_NAN;
    }
    if (size < SMALL) {
        return rad;
    }
    const turned at = reduced(size);
    const wave w = wave_of(at.rest);
    const bool turns = at.quarters % 2U != 0;
    const wh_pair tangent = turns ? wh_quotient(w.cosine, w.sine) : wh_quotient(w.sine, w.cosine);
    return wh_signed(tangent.high, turns != (rad < 0.0));
}

#endif
