/* units.h: physical dimensions and the units a .whirl file may write. SI inside. */
#ifndef LANG_UNITS_H
#define LANG_UNITS_H

#include <stdbool.h>
#include <stddef.h>

#include "host/lang/quantities.h"
#include "host/number/enclosure.h"

/* Exponents of m, kg, s, A, K in twelfths, so that square and cube roots stay exact. Angles are
 * dimensionless: rad = 1. `any` marks a literal zero, which fits every dimension. */
enum { DIM_LENGTH, DIM_MASS, DIM_TIME, DIM_CURRENT, DIM_TEMPERATURE, DIM_BASES };
#define DIM_DENOMINATOR 12

typedef struct dimension {
    short twelfths[DIM_BASES];
    bool any;
    bool unknown; /* something in it was already reported: fits everything, to keep quiet */
} dimension;

/* A dimension with whole exponents. */
dimension dim_of(int length, int mass, int time, int current, int temperature);
dimension dim_of_quantity(quantity_id which);
dimension dim_none(void);
dimension dim_energy(void); /* also torque */

/* Alike, or one of them fits everything. */
bool dim_fits(dimension a, dimension b);
bool dim_is_none(dimension dim); /* dimensionless, zero or unknown */

/* a*b, a/b, base^exponent. False when an exponent leaves the range +-99 or is no twelfth. */
bool dim_multiply(dimension a, dimension b, dimension *product);
bool dim_divide(dimension a, dimension b, dimension *quotient);
bool dim_power(dimension base, double exponent, dimension *power);

/* "force [kg*m/s^2]", "[kg/s]" or "dimensionless", cut to `size` bytes; returns `buffer`. */
char *dim_text(dimension dim, char *buffer, size_t size);
/* "kg*m^2/s^2"; "1" when dimensionless. */
char *dim_symbols(dimension dim, char *buffer, size_t size);
/* The unit people write for it: "N*m", "rad/s"; base units when there is no usual one. */
char *dim_unit(dimension dim, char *buffer, size_t size);
/* The unit of records and books: "N", "N*m*s"; base units when there is no usual one. */
char *dim_recorded_unit(dimension dim, char *buffer, size_t size);
#define DIM_TEXT_SIZE 128

/* SI value = number * scale / divisor. Two factors, so that 7 [ms] is 7/1000, correctly rounded.
 * scale/divisor lies between 1e-200 and 1e200. */
typedef struct unit_scale {
    double scale;
    double divisor;
    dimension dim;
    enclosure exact; /* what one of it is in SI, which two doubles may not be */
} unit_scale;

typedef struct unit_error {
    size_t offset; /* where in the text */
    char message[160];
    char hint[160]; /* "" when there is none */
} unit_error;

/* Read a unit expression such as `N*s/m`, `lbf*s^2/in`, `kg*(m/s)^2`, `1/s`, `m^(1/2)`: factors are
 * taken from left to right. Returns false and fills `error` when it is none. */
bool unit_parse(const char *text, size_t length, unit_scale *result, unit_error *error);

/* Is one of this unit one of SI, but for the rounding of its factors: no need to say which? Also true of {0},
 * no unit. */
bool unit_is_si(unit_scale u);

/* The name of unit `index`, counted from 0, or NULL beyond the last. */
const char *unit_name(int index);

/* What unit `index`, one of them, is in SI: the unit's name, or base units where it has none, cut to `size` bytes;
 * returns `buffer`. One of it is *value of those. */
char *unit_in_si(int index, double *value, char *buffer, size_t size);

/* True when the text names an angle by itself: rad, deg or rev. */
bool unit_is_angle(const char *text, size_t length);

#endif
