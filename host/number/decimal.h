/* decimal.h: decimal numbers as text, read in one way on every host. */
#ifndef NUMBER_DECIMAL_H
#define NUMBER_DECIMAL_H

/* === numbers in C's hexadecimal notation, to the bit and in one way on every host ============= */

enum { HEX_SIZE = 32 };

/* Writes a number as C reads it, without trailing zeros: 0x1.8p+1, -0x1p-3, 0x0p+0. Numbers below 2^-1022 keep that
 * exponent, 0x0.8p-1022; C libraries differ in this for printf's %a. "inf", "-inf" and "nan" are not C. Returns
 * `text`. */
char *hex_write(double value, char text[static HEX_SIZE]);

/* The number at the start of `text`, [+-] digits [. digits] [e [+-] digits] with a digit before the e, as the nearest
 * double. Ties round to even. The result is infinite from halfway beyond the largest double. Subnormal numbers and
 * signed zeros are supported. The number may be of any length. Locale and rounding mode of the host do not matter.
 * *end (may be NULL) is the end of the number; without a number it is `text`, and the value is 0. White space,
 * hexadecimal numbers, "inf" and "nan" are not numbers. */
double decimal_read(const char *text, const char **end);

/* As decimal_read(); *side: the number in the text is below the double (-1), equal to it (0) or above it (1). */
double decimal_read_side(const char *text, const char **end, int *side);

#endif
