/* fixed.c: the tables of fixed.h, and functions too long to inline. */
#include "fixed.h"

/* clang-format off */
/* RISES: sin(2 pi i/128) 2^30 for i = 1 to 31. FALLS: the same values in reverse order. */
#define RISES(X) \
    X(52686014) X(105245103) X(157550647) X(209476638) X(260897982) X(311690799) \
    X(361732726) X(410903207) X(459083786) X(506158392) X(552013618) X(596538995) \
    X(639627258) X(681174602) X(721080937) X(759250125) X(795590213) X(830013654) \
    X(862437520) X(892783698) X(920979082) X(946955747) X(970651112) X(992008094) \
    X(1010975242) X(1027506862) X(1041563127) X(1053110176) X(1062120190) X(1068571464) \
    X(1072448455)
#define FALLS(X) \
    X(1072448455) X(1068571464) X(1062120190) X(1053110176) X(1041563127) X(1027506862) \
    X(1010975242) X(992008094) X(970651112) X(946955747) X(920979082) X(892783698) \
    X(862437520) X(830013654) X(795590213) X(759250125) X(721080937) X(681174602) \
    X(639627258) X(596538995) X(552013618) X(506158392) X(459083786) X(410903207) \
    X(361732726) X(311690799) X(260897982) X(209476638) X(157550647) X(105245103) \
    X(52686014)
#define PLUS(x) (x),
#define MINUS(x) -(x),
const int32_t wh_fixed_sine_table[(1U << WH_FIXED_SECTOR_BITS) + WH_FIXED_QUARTER] WH_FLASH = {
    0, RISES(PLUS) 1073741824, FALLS(PLUS) 0, RISES(MINUS) -1073741824, FALLS(MINUS) 0, RISES(PLUS)
};

const uint16_t wh_fixed_seed_table[128] WH_FLASH = {
    65281, 64777, 64281, 63792, 63310, 62836, 62369, 61909, 61455, 61008, 60568, 60133,
    59705, 59283, 58867, 58457, 58053, 57654, 57260, 56872, 56489, 56111, 55738, 55370,
    55007, 54649, 54295, 53946, 53601, 53261, 52925, 52593, 52265, 51942, 51622, 51306,
    50995, 50686, 50382, 50081, 49784, 49490, 49200, 48913, 48630, 48349, 48072, 47798,
    47528, 47260, 46995, 46733, 46474, 46218, 45965, 45714, 45467, 45222, 44979, 44739,
    44502, 44267, 44035, 43805, 43577, 43352, 43129, 42908, 42690, 42474, 42260, 42048,
    41838, 41631, 41425, 41222, 41020, 40820, 40623, 40427, 40233, 40041, 39851, 39662,
    39476, 39291, 39108, 38926, 38746, 38568, 38392, 38217, 38044, 37872, 37702, 37533,
    37366, 37200, 37036, 36873, 36712, 36552, 36393, 36236, 36080, 35926, 35772, 35620,
    35470, 35320, 35172, 35026, 34880, 34735, 34592, 34450, 34309, 34169, 34031, 33893,
    33757, 33622, 33487, 33354, 33222, 33091, 32961, 32832,
};
/* clang-format on */

#if WH_FIXED_AVR
/* Adds the sixteen products of bytes column by column, then corrects for the signs. */
int32_t wh_fixed_high_called(int32_t a, int32_t b) {
    int32_t high;
    uint8_t one;
    uint8_t two;
    uint8_t three;
    uint8_t none;
    __asm__(
        "clr %4\n\tmul %A5, %A6\n\tmov %1, r1\n\tclr %2\n\tclr %3\n\tclr %A0\n\tclr %B0\n\tclr %C0\n\tclr %D0\n\t"
        "mul %A5, %B6\n\tadd %1, r0\n\tadc %2, r1\n\tadc %3, %4\n\t"
        "mul %B5, %A6\n\tadd %1, r0\n\tadc %2, r1\n\tadc %3, %4\n\t"
        "mul %A5, %C6\n\tadd %2, r0\n\tadc %3, r1\n\tadc %A0, %4\n\t"
        "mul %B5, %B6\n\tadd %2, r0\n\tadc %3, r1\n\tadc %A0, %4\n\t"
        "mul %C5, %A6\n\tadd %2, r0\n\tadc %3, r1\n\tadc %A0, %4\n\t"
        "mul %A5, %D6\n\tadd %3, r0\n\tadc %A0, r1\n\tadc %B0, %4\n\t"
        "mul %B5, %C6\n\tadd %3, r0\n\tadc %A0, r1\n\tadc %B0, %4\n\t"
        "mul %C5, %B6\n\tadd %3, r0\n\tadc %A0, r1\n\tadc %B0, %4\n\t"
        "mul %D5, %A6\n\tadd %3, r0\n\tadc %A0, r1\n\tadc %B0, %4\n\t"
        "mul %B5, %D6\n\tadd %A0, r0\n\tadc %B0, r1\n\tadc %C0, %4\n\t"
        "mul %C5, %C6\n\tadd %A0, r0\n\tadc %B0, r1\n\tadc %C0, %4\n\t"
        "mul %D5, %B6\n\tadd %A0, r0\n\tadc %B0, r1\n\tadc %C0, %4\n\t"
        "mul %C5, %D6\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %4\n\t"
        "mul %D5, %C6\n\tadd %B0, r0\n\tadc %C0, r1\n\tadc %D0, %4\n\t"
        "mul %D5, %D6\n\tadd %C0, r0\n\tadc %D0, r1\n\t"
        "clr r1\n\t"
        "sbrs %D5, 7\n\trjmp 1f\n\tsub %A0, %A6\n\tsbc %B0, %B6\n\tsbc %C0, %C6\n\tsbc %D0, %D6\n\t1:\n\t"
        "sbrs %D6, 7\n\trjmp 2f\n\tsub %A0, %A5\n\tsbc %B0, %B5\n\tsbc %C0, %C5\n\tsbc %D0, %D5\n\t2:"
        : "=&r"(high), "=&r"(one), "=&r"(two), "=&r"(three), "=&r"(none)
        : "r"(a), "r"(b)
        : "r0");
    return high;
}
#else
int32_t wh_fixed_high_called(int32_t a, int32_t b) { return wh_fixed_high_narrow(a, b); }
#endif

void wh_fixed_sincos_called(uint32_t phase, int32_t *sine, int32_t *cosine) {
    wh_fixed_sincos_here(phase, sine, cosine);
}
