/* fixed.h: fixed-point arithmetic, for processors without floating-point arithmetic.
 *
 * A 32-bit integer x stands for the number x 2^-bits. The generator knows each number's `bits`; the program does not
 * store them. Results have the same bits on every machine. Generated code keeps numbers within 2^30 in size
 * (host/fixed), so nothing here overflows.
 *
 * The only costly operation is the upper half of a product, rounded down. It takes one 32-bit product with a 64-bit
 * result, or four 16-bit products if the processor lacks the former (Cortex-M0, AVR). The result is the same. */
#ifndef WH_FIXED_H
#define WH_FIXED_H

#include "number/flash.h"

WH_C_BEGIN

#if defined(WH_FIXED_NARROW)
#elif defined(__AVR__) || defined(__ARM_ARCH_6M__) || defined(__ARM_ARCH_8M_BASE__) || \
    (defined(__riscv) && !defined(__riscv_mul))
#define WH_FIXED_NARROW 1
#else
#define WH_FIXED_NARROW 0
#endif

#if defined(__AVR__) && defined(__AVR_HAVE_MUL__) && defined(__AVR_HAVE_MOVW__) && \
    defined(__GNUC__) && !defined(__clang__)
#define WH_FIXED_AVR 1
#else
#define WH_FIXED_AVR 0
#endif

/* Attributes of generated functions: WH_FIXED_CALLED forbids inlining, WH_FIXED_LIST asks for it (not on an AVR). */
#if defined(__GNUC__)
#define WH_FIXED_CALLED __attribute__((noinline, unused))
#else
#define WH_FIXED_CALLED
#endif
#if defined(__AVR__)
#define WH_FIXED_LIST static WH_FIXED_CALLED
#else
#define WH_FIXED_LIST WH_INLINE
#endif

WH_INLINE int32_t wh_fixed_high_wide(int32_t a, int32_t b) {
    return (int32_t)(((int64_t)a * b) >> 32);
}

/* 16 x 16 = 32 bit products of unsigned (u) and signed (s) numbers. On an AVR they are in assembly, because avr-gcc
 * computes a C expression as a 32 x 32 bit product if one of its operands is also used elsewhere. */
#if WH_FIXED_AVR
WH_INLINE uint32_t wh_fixed_uu(uint16_t a, uint16_t b) {
    uint32_t product;
    uint8_t none;
    __asm__("clr %1\n\tmul %A2, %A3\n\tmovw %A0, r0\n\tmul %B2, %B3\n\tmovw %C0, r0\n\t"
            "mul %B2, %A3\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %1\n\t"
            "mul %A2, %B3\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %1\n\tclr r1"
            : "=&r"(product), "=&r"(none)
            : "r"(a), "r"(b)
            : "r0");
    return product;
}

WH_INLINE int32_t wh_fixed_su(int16_t a, uint16_t b) {
    int32_t product;
    uint8_t none;
    __asm__("clr %1\n\tmul %A2, %A3\n\tmovw %A0, r0\n\tmulsu %B2, %B3\n\tmovw %C0, r0\n\t"
            "mulsu %B2, %A3\n\tsbc %D0, %1\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %1\n\t"
            "mul %A2, %B3\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %1\n\tclr r1"
            : "=&r"(product), "=&r"(none)
            : "a"(a), "a"(b)
            : "r0");
    return product;
}

WH_INLINE int32_t wh_fixed_ss(int16_t a, int16_t b) {
    int32_t product;
    uint8_t none;
    __asm__("clr %1\n\tmul %A2, %A3\n\tmovw %A0, r0\n\tmuls %B2, %B3\n\tmovw %C0, r0\n\t"
            "mulsu %B2, %A3\n\tsbc %D0, %1\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %1\n\t"
            "mulsu %B3, %A2\n\tsbc %D0, %1\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %1\n\tclr r1"
            : "=&r"(product), "=&r"(none)
            : "a"(a), "a"(b)
            : "r0");
    return product;
}
#else
WH_INLINE uint32_t wh_fixed_uu(uint16_t a, uint16_t b) { return (uint32_t)a * b; }
WH_INLINE int32_t wh_fixed_su(int16_t a, uint16_t b) { return (int32_t)a * (int32_t)b; }
WH_INLINE int32_t wh_fixed_ss(int16_t a, int16_t b) { return (int32_t)a * b; }
#endif

/* floor(a b / 2^32). If b is a constant with a zero lower half, two of the four products drop out. */
WH_INLINE int32_t wh_fixed_high_narrow(int32_t a, int32_t b) {
    const int16_t a_high = (int16_t)(a >> 16);
    const int16_t b_high = (int16_t)(b >> 16);
    const uint16_t a_low = (uint16_t)a;
    const uint16_t b_low = (uint16_t)b;
    const int32_t one = wh_fixed_su(a_high, b_low) + (int32_t)(wh_fixed_uu(a_low, b_low) >> 16);
    const int32_t other = wh_fixed_su(b_high, a_low) + (int32_t)((uint32_t)one & 0xffffU);
    return wh_fixed_ss(a_high, b_high) + (one >> 16) + (other >> 16);
}

#define wh_fixed_high_called WH_NAME(wh_fixed_high_called)
#define wh_fixed_sincos_called WH_NAME(wh_fixed_sincos_called)
#define wh_fixed_sine_table WH_NAME(wh_fixed_sine_table)
#define wh_fixed_seed_table WH_NAME(wh_fixed_seed_table)

/* Returns the same as wh_fixed_high_narrow(), but is not inlined. */
int32_t wh_fixed_high_called(int32_t a, int32_t b);

WH_INLINE int32_t wh_fixed_high(int32_t a, int32_t b) {
#if defined(__AVR__)
    return wh_fixed_high_called(a, b);
#elif WH_FIXED_NARROW
    return wh_fixed_high_narrow(a, b);
#else
    return wh_fixed_high_wide(a, b);
#endif
}

/* Returns x 2^-by, rounded to nearest, ties upwards, for |x| <= 2^30. A negative `by` shifts left, modulo 2^32. */
WH_INLINE int32_t wh_fixed_round(int32_t x, int by) {
    return by >= 31   ? 0
           : by > 0   ? (x + (int32_t)(UINT32_C(1) << (by - 1))) >> by
           : by < -31 ? 0
                      : (int32_t)((uint32_t)x << -by);
}

/* Returns a b 2^-(32 + by), rounded to nearest, ties upwards, for by >= 1 and |a b| <= 2^62. */
WH_INLINE int32_t wh_fixed_mul(int32_t a, int32_t b, int by) {
    return wh_fixed_round(wh_fixed_high(a, b), by);
}

/* Returns (x >> 14) * number * 2^-by, rounded, for |x| <= 2^28 and a 15-bit number: a short product for small terms. */
WH_INLINE int32_t wh_fixed_mul_short(int32_t x, int16_t number, int by) {
    return wh_fixed_round(wh_fixed_ss((int16_t)(x >> 14), number), by);
}

/* a + b modulo 2^32, without the undefined behaviour of a signed overflow. */
WH_INLINE int32_t wh_fixed_add(int32_t a, int32_t b) {
    return (int32_t)((uint32_t)a + (uint32_t)b);
}
WH_INLINE int32_t wh_fixed_sub(int32_t a, int32_t b) {
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

WH_INLINE int32_t wh_fixed_left(int32_t x, int by) { return (int32_t)((uint32_t)x << by); }

WH_INLINE int32_t wh_fixed_least(int32_t a, int32_t b) { return b < a ? b : a; }
WH_INLINE int32_t wh_fixed_most(int32_t a, int32_t b) { return b > a ? b : a; }
WH_INLINE int32_t wh_fixed_size(int32_t x) { return x < 0 ? -x : x; }

/* The sign of x (-1, 0 or 1) with `bits` binary digits after the point. */
WH_INLINE int32_t wh_fixed_sign(int32_t x, int bits) {
    return (int32_t)((uint32_t)(int32_t)((x > 0) - (x < 0)) << bits);
}

/* Returns x limited to low..high. Increments *saturated if x was outside. */
WH_INLINE int32_t wh_fixed_limit(int32_t x, int32_t low, int32_t high, uint32_t *saturated) {
    if (WH_SELDOM((uint32_t)x - (uint32_t)low > (uint32_t)high - (uint32_t)low)) {
        ++*saturated;
        return x < low ? low : high;
    }
    return x;
}

/* Returns x >> by. If `by` is 7 or 15, |x| must be below 2^30. Shifts by whole bytes cost an AVR nothing. */
WH_INLINE int32_t wh_fixed_down(int32_t x, int by) {
#if WH_FIXED_AVR
    return by == 7    ? (x + x) >> 8
           : by == 15 ? (x + x) >> 16
           : by == 22 ? (int32_t)((int16_t)(x >> 16) >> 6)
                      : x >> by;
#else
    return x >> by;
#endif
}

/* --- sine and cosine -----------------------------------------------------------------------------------------*/

#define WH_FIXED_SECTOR_BITS 7
#define WH_FIXED_QUARTER (1U << (WH_FIXED_SECTOR_BITS - 2))

/* Entry i is sin(2 pi i/128) 2^30, for a turn and a quarter. */
extern const int32_t wh_fixed_sine_table[(1U << WH_FIXED_SECTOR_BITS) + WH_FIXED_QUARTER] WH_FLASH;
/* Entry i is 2^23/(128.5 + i), rounded: a reciprocal with 9 correct bits. */
extern const uint16_t wh_fixed_seed_table[128] WH_FLASH;

#if !defined(__AVR__) || defined(__AVR_TINY__) || WH_DOUBLE
WH_INLINE int32_t wh_flash_int32(const int32_t *from) { return *from; }
WH_INLINE uint16_t wh_flash_uint16(const uint16_t *from) { return *from; }
#elif defined(__clang__)
WH_INLINE int32_t wh_flash_int32(const int32_t *from) {
    return *(const __attribute__((__address_space__(1))) int32_t *)(uintptr_t)from;
}
WH_INLINE uint16_t wh_flash_uint16(const uint16_t *from) {
    return *(const __attribute__((__address_space__(1))) uint16_t *)(uintptr_t)from;
}
#else
WH_INLINE int32_t wh_flash_int32(const int32_t *from) {
    const float read = wh_flash_real((const float *)(const void *)from);
    int32_t value;
    __builtin_memcpy(&value, &read, sizeof value);
    return value;
}
WH_INLINE uint16_t wh_flash_uint16(const uint16_t *from) {
    const uint8_t *at = (const uint8_t *)from;
    uint8_t low;
    uint8_t high;
    __asm__("lpm %0, Z" : "=r"(low) : "z"(at));
    __asm__("lpm %0, Z" : "=r"(high) : "z"(at + 1));
    return (uint16_t)(low | (uint16_t)high << 8);
}
#endif

/* Sine and cosine of a phase (2^32 per turn), times 2^30: the method of sine.h in integers. s and c are the sine and
 * cosine of the nearest angle in the table. r is the phase minus this angle: sine = s + (c sin r + s (cos r - 1)).
 * y is r in units of 2^-31 pi/128. */
WH_INLINE void wh_fixed_sincos_here(uint32_t phase, int32_t *sine, int32_t *cosine) {
    const unsigned rest_bits = 32U - WH_FIXED_SECTOR_BITS;
    const uint8_t sector = (uint8_t)((uint8_t)((phase + (UINT32_C(1) << (rest_bits - 1U))) >> 24) >>
                                     (rest_bits - 24U));
    const int32_t *middle = &wh_fixed_sine_table[sector];
    const int32_t s = wh_flash_int32(&middle[0]);
    const int32_t c = wh_flash_int32(&middle[WH_FIXED_QUARTER]);
#if WH_FIXED_AVR /* phase << 7: one byte to the left, then one bit to the right */
    const int32_t y = (int32_t)((phase << 8) >> 1 |
                                ((phase & UINT32_C(0x01000000)) != 0 ? UINT32_C(0x80000000) : 0U));
#else
    const int32_t y = (int32_t)(phase << WH_FIXED_SECTOR_BITS);
#endif
    const int16_t upper = (int16_t)(y >> 16);
    const int16_t square = (int16_t)wh_fixed_down(wh_fixed_ss(upper, (int16_t)~upper), 15);
    const int16_t cos_less_1 =
        (int16_t)wh_fixed_down(wh_fixed_ss(square, 20211) + 16384, 15); /* units of 2^-26 */
    /* sin_r is in units of 2^-35. 25735/2^16 is nearly pi/8; `rest` has the remainder and the third-order term. */
    const int16_t rest = (int16_t)((wh_fixed_ss(square, 1323) >> 11) + 7594);
    const int32_t sin_r =
        wh_fixed_high(y, INT32_C(25735) * 65536) + (wh_fixed_ss(upper, rest) >> 13);
    const int16_t s_short = (int16_t)((s + 32768) >> 16);
    const int16_t c_short = (int16_t)((c + 32768) >> 16);
    const int32_t sine_rest =
        wh_fixed_high(c, sin_r) + wh_fixed_down(wh_fixed_ss(s_short, cos_less_1), 7);
    const int32_t cosine_rest =
        wh_fixed_down(wh_fixed_ss(c_short, cos_less_1), 7) - wh_fixed_high(s, sin_r);
    *sine = s + ((sine_rest + 4) >> 3);
    *cosine = c + ((cosine_rest + 4) >> 3);
}

void wh_fixed_sincos_called(uint32_t phase, int32_t *sine, int32_t *cosine);

WH_INLINE void wh_fixed_sincos(uint32_t phase, int32_t *sine, int32_t *cosine) {
#if defined(__AVR__)
    wh_fixed_sincos_called(phase, sine, cosine);
#else
    wh_fixed_sincos_here(phase, sine, cosine);
#endif
}

/* Sine and cosine for scenes with several waves (stage_turn.h): called if WH_FIXED_NARROW, otherwise inlined. */
WH_INLINE void wh_fixed_sincos_shared(uint32_t phase, int32_t *sine, int32_t *cosine) {
#if WH_FIXED_NARROW
    wh_fixed_sincos_called(phase, sine, cosine);
#else
    wh_fixed_sincos_here(phase, sine, cosine);
#endif
}

/* --- quotients -----------------------------------------------------------------------------------------------*/

/* Leading zeros of x > 0. */
WH_INLINE int wh_fixed_zeros(uint32_t x) {
#if defined(__GNUC__)
    return sizeof(int) >= sizeof(uint32_t) ? __builtin_clz((unsigned)x)
                                           : __builtin_clzl((unsigned long)x);
#else
    int zeros = 0;
    for (; (x & UINT32_C(0x80000000)) == 0; x <<= 1) {
        zeros++;
    }
    return zeros;
#endif
}

/* Returns 2^61/d for d >= 2^31, with a relative error below 2^-28. A table and a Newton step give the upper 16 bits. A
 * second Newton step adds the lower bits. */
WH_INLINE int32_t wh_fixed_reciprocal(uint32_t d) {
    const uint16_t d_high = (uint16_t)(d >> 16);
    const uint16_t d_low = (uint16_t)d;
    const uint16_t x0 = wh_flash_uint16(&wh_fixed_seed_table[(d >> 24) & 127U]);
    const int32_t off0 = (int32_t)(UINT32_C(0x80000000) - wh_fixed_uu(d_high, x0));
    const uint16_t x1 =
        (uint16_t)((int32_t)x0 + wh_fixed_down(wh_fixed_su((int16_t)(off0 >> 9), x0), 22));
    const uint32_t product = wh_fixed_uu(d_high, x1) + (wh_fixed_uu(d_low, x1) >> 16);
    const int32_t off1 = (int32_t)(UINT32_C(0x80000000) - product);
    const int32_t more = wh_fixed_su((int16_t)(off1 >> 2), x1) >> 16;
    return (int32_t)((uint32_t)x1 << 14) + more + more;
}

WH_C_END

#endif
