/* units.h: physical dimensions, and the units of .whirl files. Values inside are SI. */
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
    bool unknown; /* contains a reported error: fits everything, to avoid more reports */
} dimension;

/* A dimension with whole exponents. */
dimension dim_of(int length, int mass, int time, int current, int temperature);
dimension dim_of_quantity(quantity_id which);
dimension dim_none(void);
dimension dim_energy(void); /* also torque */

/* Equal, or one of them fits everything. */
bool dim_fits(dimension a, dimension b);
bool dim_is_none(dimension dim); /* dimensionless, zero or unknown */

/* a*b, a/b, base^exponent. False if an exponent leaves the range +-99 or is not a multiple of 1/12. */
bool dim_multiply(dimension a, dimension b, dimension *product);
bool dim_divide(dimension a, dimension b, dimension *quotient);
bool dim_power(dimension base, double exponent, dimension *power);

/* "force [kg*m/s^2]", "[kg/s]" or "dimensionless", cut to `size` bytes; returns `buffer`. */
char *dim_text(dimension dim, char *buffer, size_t size);
/* "kg*m^2/s^2"; "1" when dimensionless. */
char *dim_symbols(dimension dim, char *buffer, size_t size);
/* The usual unit: "N*m", "rad/s"; base units if there is no usual one. */
char *dim_unit(dimension dim, char *buffer, size_t size);
/* The unit of records and the balance: "N", "N*m*s"; base units if there is no usual one. */
char *dim_recorded_unit(dimension dim, char *buffer, size_t size);
#define DIM_TEXT_SIZE 128

/* SI value = number * scale / divisor. Two factors make 7 [ms] exactly 7/1000, correctly rounded. scale/divisor lies
 * between 1e-200 and 1e200. */
typedef struct unit_scale {
    double scale;
    double divisor;
    dimension dim;
    enclosure exact; /* enclosure of the unit in SI, which two doubles may not represent exactly */
} unit_scale;

typedef struct unit_error {
    size_t offset; /* position in the text */
    char message[160];
    char hint[160]; /* "" without a hint */
} unit_error;

/* Read a unit expression such as `N*s/m`, `lbf*s^2/in`, `kg*(m/s)^2`, `1/s`, `m^(1/2)`. Factors associate from left to
 * right. Returns false and fills `error` if the text is no unit. */
bool unit_parse(const char *text, size_t length, unit_scale *result, unit_error *error);

/* Is the unit an SI unit, up to the rounding of its factors? Then messages need not name it. True also for {0}, no
 * unit. */
bool unit_is_si(unit_scale u);

/* The name of unit `index`, counted from 0, or NULL beyond the last. */
const char *unit_name(int index);

/* The SI unit of unit `index`, by name or in base units, cut to `size` bytes; returns `buffer`. One unit `index` is
 * *value SI units. */
char *unit_in_si(int index, double *value, char *buffer, size_t size);

/* True if the text itself names an angle: rad, deg or rev. */
bool unit_is_angle(const char *text, size_t length);

#endif
