/* decimal.h: conversion between doubles and text, with equal results on every host. */
#ifndef NUMBER_DECIMAL_H
#define NUMBER_DECIMAL_H

/* === hexadecimal notation, as in C ============================================================ */

enum { HEX_SIZE = 32 };

/* Writes `value` exactly in C's hexadecimal notation without trailing zeros: 0x1.8p+1, -0x1p-3, 0x0p+0; or "inf",
 * "-inf", "nan". Subnormal numbers have the exponent -1022 on every host: 0x0.8p-1022. Returns `text`. */
char *hex_write(double value, char text[static HEX_SIZE]);

/* Returns the double nearest to the decimal number at the start of `text`: an optional sign, digits with at most one
 * point, and optionally an e or E with a whole exponent. Any number of digits is correct, and ties round to even. A
 * number half an ulp or more beyond the largest double becomes infinite. The host's locale and rounding mode have no
 * effect. *end (may be NULL): the first character after the number. White space, hexadecimal numbers, "inf" and "nan"
 * are no number: *end is then `text` and the result 0. */
double decimal_read(const char *text, const char **end);

/* Writes a number rounded to 15, 16 or 17 digits, the fewest that are read back exactly. Zeros have no sign. Returns
 * `text`. */
enum { NUMBER_SIZE = 40 };
char *number_shortest(double value, char text[static NUMBER_SIZE]);

/* As decimal_read(). *side: -1, 0 or 1 if the number in the text is below, equal to or above the returned double. */
double decimal_read_side(const char *text, const char **end, int *side);

#endif
