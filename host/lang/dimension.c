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

typedef struct quantity_row {
    signed char exponents[DIM_BASES];
    const char *name;
    const char *hinted;
    const char *recorded;
} quantity_row;

static const quantity_row quantities[] = {
#define ROW(id, m, kg, s, A, K, name, hinted, recorded) \
    [QUANTITY_##id] = {{[DIM_LENGTH] = (m), \
                        [DIM_MASS] = (kg), \
                        [DIM_TIME] = (s), \
                        [DIM_CURRENT] = (A), \
                        [DIM_TEMPERATURE] = (K)}, \
                       name, \
                       hinted, \
                       recorded},
    QUANTITY_ROWS(ROW)
#undef ROW
};
enum { QUANTITIES = sizeof quantities / sizeof quantities[0] };

dimension dim_of_quantity(quantity_id which) {
    const signed char *e = quantities[which].exponents;
    return dim_of(e[DIM_LENGTH], e[DIM_MASS], e[DIM_TIME], e[DIM_CURRENT], e[DIM_TEMPERATURE]);
}

/* What has no name of its own is a number of some unit. */
static const quantity_row *find_quantity(dimension dim) {
    for (int i = 0; i < QUANTITIES; i++) {
        if (same_exponents(dim, dim_of_quantity((quantity_id)i))) {
            return &quantities[i];
        }
    }
    return &quantities[QUANTITY_NUMBER];
}

static char *unit_or_symbols(dimension dim, const char *usual, char *buffer, size_t size) {
    if (usual[0] == '\0') {
        return dim_symbols(dim, buffer, size);
    }
    snprintf(buffer, size, "%s", usual);
    return buffer;
}

char *dim_unit(dimension dim, char *buffer, size_t size) {
    return unit_or_symbols(dim, find_quantity(dim)->hinted, buffer, size);
}

char *dim_recorded_unit(dimension dim, char *buffer, size_t size) {
    return unit_or_symbols(dim, find_quantity(dim)->recorded, buffer, size);
}

char *dim_text(dimension dim, char *buffer, size_t size) {
    if (dim_is_none(dim)) {
        snprintf(buffer, size, "dimensionless");
        return buffer;
    }
    char symbols[DIM_TEXT_SIZE];
    dim_symbols(dim, symbols, sizeof symbols);
    const char *name = find_quantity(dim)->name;
    snprintf(buffer, size, "%s%s[%s]", name, name[0] == '\0' ? "" : " ", symbols);
    return buffer;
}
