/* convert.c: 64-bit integers to float, rounded to nearest, ties to even. The compiler calls the functions by name. The
 * support library of RISC-V and Cortex-M0 would use double-precision arithmetic, which this firmware does not link. */
#include <stdint.h>

#if defined(__ARM_EABI__)
#define FROM_UNSIGNED __aeabi_ul2f
#define FROM_SIGNED __aeabi_l2f
#else
#define FROM_UNSIGNED __floatundisf
#define FROM_SIGNED __floatdisf
#endif

float FROM_UNSIGNED(uint64_t number);
float FROM_SIGNED(int64_t number);

static float power_of_two(unsigned exponent) {
    const union {
        uint32_t bits;
        float value;
    } power = {(127U + exponent) << 23};
    return power.value;
}

float FROM_UNSIGNED(uint64_t number) {
    const uint32_t high = (uint32_t)(number >> 32);
    if (high == 0) {
        return (float)(uint32_t)number;
    }
    /* The bits below the highest 32 only decide ties, so one bit replaces them. */
    const unsigned shift = 32U - (unsigned)__builtin_clz(high);
    const uint64_t below = number & ((UINT64_C(1) << shift) - 1U);
    const uint32_t lost = below != 0 ? 1U : 0U;
    return (float)((uint32_t)(number >> shift) | lost) * power_of_two(shift);
}

float FROM_SIGNED(int64_t number) {
    return number < 0 ? -FROM_UNSIGNED(0U - (uint64_t)number) : FROM_UNSIGNED((uint64_t)number);
}
