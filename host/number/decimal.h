/* decimal.h: decimal numbers as text, read in one way on every host. */
#ifndef NUMBER_DECIMAL_H
#define NUMBER_DECIMAL_H

/* === numbers in C's hexadecimal notation, to the bit and in one way on every host ============= */

enum { HEX_SIZE = 32 };

/* As C reads it: 0x1.8p+1, -0x1p-3, 0x0p+0; no digits that are zeros at the end. Numbers below 2^-1022 keep that
 * exponent, 0x0.8p-1022: printf's %a does so with some C libraries and not with others. "inf", "-inf" and "nan"
 * are no C. Returns `text`. */
char *hex_write(double value, char text[static HEX_SIZE]);

/* The number at the start of `text`, [+-] digits [. digits] [e [+-] digits] with a digit before the e, as the nearest
 * double: of two that are as near the even one, infinity from halfway beyond the largest, subnormal numbers and
 * zeros with their sign below. Of any length, whatever the locale and the rounding of the host's own strtod().
 * *end (may be NULL) is where it ends: `text`, and the value 0, where there is none. No white space, no hexadecimal
 * numbers, no "inf", no "nan". */
double decimal_read(const char *text, const char **end);

/* The same; *side is where the number lies of the double: -1 below it, 0 on it, 1 above it. */
double decimal_read_side(const char *text, const char **end, int *side);

#endif
