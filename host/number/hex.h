/* hex.h: numbers in C's hexadecimal notation, to the bit and in one way on every host. */
#ifndef NUMBER_HEX_H
#define NUMBER_HEX_H

enum { HEX_SIZE = 32 };

/* As C reads it: 0x1.8p+1, -0x1p-3, 0x0p+0; no digits that are zeros at the end. Numbers below 2^-1022 keep that
 * exponent, 0x0.8p-1022: printf's %a does so with some C libraries and not with others. "inf", "-inf" and "nan"
 * are no C. Returns `text`. */
char *hex_write(double value, char text[static HEX_SIZE]);

#endif
