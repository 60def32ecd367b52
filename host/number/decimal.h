/* decimal.h: decimal numbers as text, read in one way on every host. */
#ifndef NUMBER_DECIMAL_H
#define NUMBER_DECIMAL_H

/* The number at the start of `text`, [+-] digits [. digits] [e [+-] digits] with a digit before the e, as the nearest
 * double: of two that are as near the even one, infinity from halfway beyond the largest, subnormal numbers and
 * zeros with their sign below. Of any length, whatever the locale and the rounding of the host's own strtod().
 * *end (may be NULL) is where it ends: `text`, and the value 0, where there is none. No white space, no hexadecimal
 * numbers, no "inf", no "nan". */
double decimal_read(const char *text, const char **end);

/* The same; *side is where the number lies of the double: -1 below it, 0 on it, 1 above it. */
double decimal_read_side(const char *text, const char **end, int *side);

#endif
