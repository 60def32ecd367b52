/* hex.c: see hex.h. */
#include "hex.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { FRACTION = 52, BIAS = 1023, SPECIAL = 0x7ff };

char *hex_write(double value, char text[static HEX_SIZE]) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    const int scale = (int)(bits >> FRACTION) & SPECIAL;
    uint64_t fraction = bits & ((UINT64_C(1) << FRACTION) - 1);
    const char *sign = bits >> 63 != 0 ? "-" : "";
    if (scale == SPECIAL) {
        snprintf(text, HEX_SIZE, "%s%s", fraction != 0 ? "" : sign, fraction != 0 ? "nan" : "inf");
        return text;
    }
    char digits[FRACTION / 4 + 2] = "."; /* the point and what is behind it */
    int count = 1;
    for (; fraction != 0; count++) {
        digits[count] = "0123456789abcdef"[fraction >> (FRACTION - 4)];
        fraction = fraction << 4 & ((UINT64_C(1) << FRACTION) - 1);
    }
    digits[count > 1 ? count : 0] = '\0';
    int exponent = scale > 0 ? scale - BIAS : 1 - BIAS;
    if (scale == 0 && count == 1) {
        exponent = 0; /* zero */
    }
    snprintf(text, HEX_SIZE, "%s0x%d%sp%+d", sign, scale > 0 ? 1 : 0, digits, exponent);
    return text;
}
