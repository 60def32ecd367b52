/* dimension.c: arithmetic with physical dimensions, and how messages name them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/number/functions.h"
#include "units.h"

enum { EXPONENT_MAX = 99 * DIM_DENOMINATOR };

dimension dim_none(void) { return (dimension){{0}, false, false}; }

dimension dim_of(int length, int mass, int time, int current, int temperature) {
    const int exponents[DIM_BASES] = {length, mass, time, current, temperature};
    dimension dim = dim_none();
    for (int i = 0; i < DIM_BASES; i++) {
        dim.twelfths[i] = (short)(exponents[i] * DIM_DENOMINATOR);
    }
    return dim;
}

dimension dim_energy(void) { return dim_of(2, 1, -2, 0, 0); }

static bool same_exponents(dimension a, dimension b) {
    for (int i = 0; i < DIM_BASES; i++) {
        if (a.twelfths[i] != b.twelfths[i]) {
            return false;
        }
    }
    return true;
}

bool dim_fits(dimension a, dimension b) {
    return a.any || b.any || a.unknown || b.unknown || same_exponents(a, b);
}

bool dim_is_none(dimension dim) { return dim_fits(dim, dim_none()); }

/* a * b^sign */
static bool combine(dimension a, dimension b, int sign, dimension *result) {
    dimension made = dim_none();
    made.any = a.any || b.any;
    made.unknown = a.unknown || b.unknown;
    for (int i = 0; i < DIM_BASES && !made.any && !made.unknown; i++) {
        const int exponent = a.twelfths[i] + sign * b.twelfths[i];
        if (exponent > EXPONENT_MAX || exponent < -EXPONENT_MAX) {
            return false;
        }
        made.twelfths[i] = (short)exponent;
    }
    *result = made;
    return true;
}

bool dim_multiply(dimension a, dimension b, dimension *product) {
    return combine(a, b, 1, product);
}

bool dim_divide(dimension a, dimension b, dimension *quotient) {
    return combine(a, b, -1, quotient);
}

bool dim_power(dimension base, double exponent, dimension *power) {
    dimension made = dim_none();
    made.unknown = base.unknown;
    made.any = base.any && exponent != 0.0;
    for (int i = 0; i < DIM_BASES && !base.any; i++) {
        const double wanted = base.twelfths[i] * exponent;
        if (!(fabs(wanted) <= EXPONENT_MAX)) {
            return false;
        }
        const double whole = number_even(wanted);
        if (fabs(wanted - whole) > 1e-9) {
            return false;
        }
        made.twelfths[i] = (short)whole;
    }
    *power = made;
    return true;
}

static void append(char *buffer, size_t size, const char *text) {
    const size_t used = strlen(buffer);
    if (used + 1 < size) {
        snprintf(buffer + used, size - used, "%s", text);
    }
}

static void append_factor(char *buffer, size_t size, const char *symbol, int twelfths) {
    char factor[32];
    if (twelfths == DIM_DENOMINATOR) {
        snprintf(factor, sizeof factor, "%s", symbol);
    } else if (twelfths % DIM_DENOMINATOR == 0) {
        snprintf(factor, sizeof factor, "%s^%d", symbol, twelfths / DIM_DENOMINATOR);
    } else {
        int above = twelfths;
        int below = DIM_DENOMINATOR;
        for (int divisor = 6; divisor > 1; divisor--) {
            while (above % divisor == 0 && below % divisor == 0) {
                above /= divisor;
                below /= divisor;
            }
        }
        snprintf(factor, sizeof factor, "%s^(%d/%d)", symbol, above, below);
    }
    append(buffer, size, factor);
}

/* The order in which SI writes its base units in products. */
static const struct {
    int base;
    const char *symbol;
} base_units[DIM_BASES] = {{DIM_MASS, "kg"},
                           {DIM_LENGTH, "m"},
                           {DIM_TIME, "s"},
                           {DIM_CURRENT, "A"},
                           {DIM_TEMPERATURE, "K"}};

char *dim_symbols(dimension dim, char *buffer, size_t size) {
    buffer[0] = '\0';
    for (int i = 0; i < DIM_BASES; i++) {
        const int exponent = dim.twelfths[base_units[i].base];
        if (exponent > 0) {
            append(buffer, size, buffer[0] == '\0' ? "" : "*");
            append_factor(buffer, size, base_units[i].symbol, exponent);
        }
    }
    if (buffer[0] == '\0') {
        append(buffer, size, "1");
    }
    for (int i = 0; i < DIM_BASES; i++) {
        const int exponent = dim.twelfths[base_units[i].base];
        if (exponent < 0) {
            append(buffer, size, "/");
            append_factor(buffer, size, base_units[i].symbol, -exponent);
        }
    }
    return buffer;
}

/* What a dimension is called, where the name is beyond doubt, and the unit people write for it. */
static const struct {
    signed char exponents[DIM_BASES];
    const char *name;
    const char *unit; /* NULL: as in base units */
} named[] = {
    {{1, 0, 0, 0, 0}, "length", NULL},
    {{0, 1, 0, 0, 0}, "mass", NULL},
    {{0, 0, 1, 0, 0}, "time", NULL},
    {{0, 0, 0, 1, 0}, "current", NULL},
    {{0, 0, 0, 0, 1}, "temperature", NULL},
    {{2, 0, 0, 0, 0}, "area", NULL},
    {{3, 0, 0, 0, 0}, "volume", NULL},
    {{1, 0, -1, 0, 0}, "speed", NULL},
    {{1, 0, -2, 0, 0}, "acceleration", NULL},
    {{0, 0, -1, 0, 0}, "frequency or angular speed", "rad/s"},
    {{0, 0, -2, 0, 0}, "angular acceleration", "rad/s^2"},
    {{1, 1, -1, 0, 0}, "momentum", NULL},
    {{1, 1, -2, 0, 0}, "force", "N"},
    {{2, 1, -2, 0, 0}, "energy or torque", "N*m"},
    {{2, 1, -3, 0, 0}, "power", "W"},
    {{2, 1, 0, 0, 0}, "moment of inertia", NULL},
    {{2, 1, -1, 0, 0}, "angular momentum", NULL},
    {{-1, 1, -2, 0, 0}, "pressure", "Pa"},
    {{0, 1, -2, 0, 0}, "", "N/m"},
    {{0, 1, -1, 0, 0}, "", "N*s/m"},
    {{2, 1, -3, -1, 0}, "voltage", "V"},
    {{2, 1, -3, -2, 0}, "resistance", "ohm"},
    {{0, 0, 1, 1, 0}, "charge", "C"},
    {{-2, -1, 4, 2, 0}, "capacitance", "F"},
    {{2, 1, -2, -2, 0}, "inductance", "H"},
};

/* Index into the table, or -1. */
static int find_named(dimension dim) {
    for (int i = 0; i < (int)(sizeof named / sizeof named[0]); i++) {
        const signed char *e = named[i].exponents;
        if (same_exponents(dim, dim_of(e[0], e[1], e[2], e[3], e[4]))) {
            return i;
        }
    }
    return -1;
}

char *dim_unit(dimension dim, char *buffer, size_t size) {
    const int found = find_named(dim);
    if (found < 0 || named[found].unit == NULL) {
        return dim_symbols(dim, buffer, size);
    }
    snprintf(buffer, size, "%s", named[found].unit);
    return buffer;
}

char *dim_text(dimension dim, char *buffer, size_t size) {
    if (dim_is_none(dim)) {
        snprintf(buffer, size, "dimensionless");
        return buffer;
    }
    char symbols[DIM_TEXT_SIZE];
    dim_symbols(dim, symbols, sizeof symbols);
    const int found = find_named(dim);
    const char *name = found < 0 ? "" : named[found].name;
    snprintf(buffer, size, "%s%s[%s]", name, name[0] == '\0' ? "" : " ", symbols);
    return buffer;
}
