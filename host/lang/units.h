/* units.h: physical dimensions, and the units of .whirl files. Values in the program are SI. */
#ifndef LANG_UNITS_H
#define LANG_UNITS_H

#include <stdbool.h>
#include <stddef.h>

#include "host/number/enclosure.h"

/* === physical quantities: their names in messages, if unambiguous, and their usual units ====== */

/* X(id, exponents of m, kg, s, A and K, name in messages, unit in hints, unit in records and the balance). The
 * name "" means that the quantity has no name; the unit "" means base units. */
#define QUANTITY_ROWS(X) \
    X(NUMBER, 0, 0, 0, 0, 0, "", "", "") \
    X(ANGLE, 0, 0, 0, 0, 0, "", "", "") \
    X(LENGTH, 1, 0, 0, 0, 0, "length", "", "") \
    X(MASS, 0, 1, 0, 0, 0, "mass", "", "") \
    X(TIME, 0, 0, 1, 0, 0, "time", "", "") \
    X(CURRENT, 0, 0, 0, 1, 0, "current", "", "") \
    X(TEMPERATURE, 0, 0, 0, 0, 1, "temperature", "", "") \
    X(AREA, 2, 0, 0, 0, 0, "area", "", "") \
    X(VOLUME, 3, 0, 0, 0, 0, "volume", "", "") \
    X(SPEED, 1, 0, -1, 0, 0, "speed", "", "") \
    X(ACCELERATION, 1, 0, -2, 0, 0, "acceleration", "", "") \
    X(FREQUENCY, 0, 0, -1, 0, 0, "frequency or angular speed", "rad/s", "") \
    X(ANGULAR_ACCELERATION, 0, 0, -2, 0, 0, "angular acceleration", "rad/s^2", "") \
    X(MOMENTUM, 1, 1, -1, 0, 0, "momentum", "", "") \
    X(FORCE, 1, 1, -2, 0, 0, "force", "N", "N") \
    X(ENERGY, 2, 1, -2, 0, 0, "energy or torque", "N*m", "N*m") \
    X(POWER, 2, 1, -3, 0, 0, "power", "W", "W") \
    X(INERTIA, 2, 1, 0, 0, 0, "moment of inertia", "", "") \
    X(ANGULAR_MOMENTUM, 2, 1, -1, 0, 0, "angular momentum", "", "N*m*s") \
    X(PRESSURE, -1, 1, -2, 0, 0, "pressure", "Pa", "") \
    X(STIFFNESS, 0, 1, -2, 0, 0, "", "N/m", "") \
    X(DAMPING, 0, 1, -1, 0, 0, "", "N*s/m", "") \
    X(VOLTAGE, 2, 1, -3, -1, 0, "voltage", "V", "V") \
    X(RESISTANCE, 2, 1, -3, -2, 0, "resistance", "ohm", "") \
    X(CHARGE, 0, 0, 1, 1, 0, "charge", "C", "") \
    X(CAPACITANCE, -2, -1, 4, 2, 0, "capacitance", "F", "") \
    X(INDUCTANCE, 2, 1, -2, -2, 0, "inductance", "H", "") \
    X(FLUX, 2, 1, -2, -1, 0, "", "", "") \
    X(FLUX_DENSITY, 0, 1, -2, -1, 0, "", "", "")

#define QUANTITY(id, ...) QUANTITY_##id,
typedef enum quantity_id { QUANTITY_ROWS(QUANTITY) } quantity_id;
#undef QUANTITY

/* Exponents of m, kg, s, A and K are stored in twelfths, so that square and cube roots stay exact. Angles are
 * dimensionless: rad = 1. `any` marks a literal zero, which fits every dimension. */
enum { DIM_LENGTH, DIM_MASS, DIM_TIME, DIM_CURRENT, DIM_TEMPERATURE, DIM_BASES };
#define DIM_DENOMINATOR 12

typedef struct dimension {
    short twelfths[DIM_BASES];
    bool any;
    bool unknown; /* contains a reported error: fits every dimension, to avoid more reports */
} dimension;

dimension dim_of(int length, int mass, int time, int current, int temperature);
dimension dim_none(void);
dimension dim_of_quantity(quantity_id which);

/* True if the dimensions are equal, or if one of them fits every dimension. */
bool dim_fits(dimension a, dimension b);
bool dim_is_none(dimension dim); /* dimensionless, zero or unknown */

/* Compute a*b, a/b and base^exponent. Return false if an exponent exceeds 99 in size or is not a multiple of 1/12. */
bool dim_multiply(dimension a, dimension b, dimension *product);
bool dim_divide(dimension a, dimension b, dimension *quotient);
bool dim_power(dimension base, double exponent, dimension *power);
/* The dimension of the derivative with `primes` primes: `of` / time^primes. */
bool dim_derivative(dimension of, int primes, dimension *derivative);

/* Writes the dimension for messages: "force [kg*m/s^2]", "[kg/s]" or "dimensionless". Returns `buffer`. */
char *dim_text(dimension dim, char *buffer, size_t size);
/* Writes the dimension in base units, such as "kg*m^2/s^2"; "1" if dimensionless. */
char *dim_symbols(dimension dim, char *buffer, size_t size);
/* Writes the usual unit, such as "N*m" or "rad/s", or base units if there is no usual one. */
char *dim_unit(dimension dim, char *buffer, size_t size);
/* Writes the unit that records and balances show, such as "N" or "N*m*s", or base units if there is no usual one. */
char *dim_recorded_unit(dimension dim, char *buffer, size_t size);
#define DIM_TEXT_SIZE 128

/* SI value = number * scale / divisor: 7 [ms] is 7/1000, rounded once. scale/divisor is from 1e-200 to 1e200. */
typedef struct unit_scale {
    double scale;
    double divisor;
    dimension dim;
    enclosure exact; /* encloses the exact factor to SI; scale / divisor may be rounded */
} unit_scale;

typedef struct unit_error {
    size_t offset; /* position in the text */
    char message[160];
    char hint[160]; /* "" without a hint */
} unit_error;

/* Reads a unit expression such as `N*s/m`, `lbf*s^2/in`, `kg*(m/s)^2`, `1/s` or `m^(1/2)`. Factors associate from left
 * to right. Returns false and fills `error` if the text is no unit. */
bool unit_parse(const char *text, size_t length, unit_scale *result, unit_error *error);

/* True if scale / divisor is 1, apart from rounding. Also true for {0}, which means no unit. */
bool unit_is_si(unit_scale u);

/* Returns the name of unit `index`, counted from 0, or NULL after the last. */
const char *unit_name(int index);

/* Expresses unit `index` in SI: sets *value, and writes the SI unit, cut to `size` bytes. Returns `buffer`. */
char *unit_in_si(int index, double *value, char *buffer, size_t size);

/* True if the text is a unit of angle: rad, deg or rev. */
bool unit_is_angle(const char *text, size_t length);

#endif
