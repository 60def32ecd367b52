/* decimal.h: conversion between doubles and text, with equal results on every host. */
#ifndef NUMBER_DECIMAL_H
#define NUMBER_DECIMAL_H

/* === hexadecimal notation, as in C ============================================================ */

enum { HEX_SIZE = 32 };

/* Writes `value` in C's hexadecimal notation, exactly and without trailing zeros: 0x1.8p+1, -0x1p-3, 0x0p+0. A
 * subnormal number has the exponent -1022, such as 0x0.8p-1022; with printf's %a this would depend on the C library.
 * Infinities and NaN become "inf", "-inf" and "nan", which are not C. Returns `text`. */
char *hex_write(double value, char text[static HEX_SIZE]);

/* Reads the decimal number at the start of `text` as the nearest double. Ties round to even. The number has an
 * optional sign, digits with at most one point, and optionally an e or E with a whole exponent. It may be of any
 * length. Subnormal numbers and signed zeros are supported. From halfway beyond the largest double on, the result is
 * infinite. The host's locale and rounding mode have no effect. *end (may be NULL): the first character after the
 * number. Without a number, *end is `text` and the result is 0. Leading white space, hexadecimal numbers, "inf" and
 * "nan" are not read. */
double decimal_read(const char *text, const char **end);

/* Writes a number with as few digits as are needed to read it back exactly, but at least 15; zeros have no sign. Returns
 * `text`. */
enum { NUMBER_SIZE = 40 };
char *number_shortest(double value, char text[static NUMBER_SIZE]);

/* As decimal_read(). *side: -1, 0 or 1 if the number in the text is below, equal to or above the returned double. */
double decimal_read_side(const char *text, const char **end, int *side);

#endif
