/* units.c: the unit table, and the parser of unit expressions. */
#include "host/lang/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/base/spelling.h"
#include "host/lang/lexer.h"
#include "host/number/functions.h"

/* === units ==================================================================================== */

#define PI 3.14159265358979323846

typedef struct unit_entry {
    const char *name;
    double scale; /* one unit is scale / divisor in SI */
    double divisor;
    quantity_id of;
} unit_entry;

/* Pound, inch and foot are those of the agreement of 1959. A pound-force is a pound times 9.80665 m/s^2. */
#define POUND_KG 0.45359237
#define POUND_FORCE_N 4.4482216152605

/* Grouped by quantity. The SI unit has the factors 1 and 1. */
static const unit_entry units[] = {
    {"m", 1, 1, QUANTITY_LENGTH},
    {"km", 1e3, 1, QUANTITY_LENGTH},
    {"cm", 1, 1e2, QUANTITY_LENGTH},
    {"mm", 1, 1e3, QUANTITY_LENGTH},
    {"um", 1, 1e6, QUANTITY_LENGTH},
    {"in", 254, 1e4, QUANTITY_LENGTH},
    {"ft", 3048, 1e4, QUANTITY_LENGTH},
    {"kg", 1, 1, QUANTITY_MASS},
    {"g", 1, 1e3, QUANTITY_MASS},
    {"mg", 1, 1e6, QUANTITY_MASS},
    {"lb", POUND_KG, 1, QUANTITY_MASS},
    {"oz", POUND_KG, 16, QUANTITY_MASS},
    {"slug", POUND_FORCE_N * 1e4, 3048, QUANTITY_MASS},
    {"s", 1, 1, QUANTITY_TIME},
    {"ms", 1, 1e3, QUANTITY_TIME},
    {"us", 1, 1e6, QUANTITY_TIME},
    {"ns", 1, 1e9, QUANTITY_TIME},
    {"min", 60, 1, QUANTITY_TIME},
    {"h", 3600, 1, QUANTITY_TIME},
    {"rad", 1, 1, QUANTITY_ANGLE},
    {"deg", PI, 180, QUANTITY_ANGLE},
    {"rev", 2 * PI, 1, QUANTITY_ANGLE},
    {"mrad", 1, 1e3, QUANTITY_NUMBER},
    {"rpm", 2 * PI, 60, QUANTITY_FREQUENCY},
    {"Hz", 1, 1, QUANTITY_FREQUENCY},
    {"kHz", 1e3, 1, QUANTITY_FREQUENCY},
    {"MHz", 1e6, 1, QUANTITY_FREQUENCY},
    {"N", 1, 1, QUANTITY_FORCE},
    {"mN", 1, 1e3, QUANTITY_FORCE},
    {"kN", 1e3, 1, QUANTITY_FORCE},
    {"lbf", POUND_FORCE_N, 1, QUANTITY_FORCE},
    {"ozf", POUND_FORCE_N, 16, QUANTITY_FORCE},
    {"J", 1, 1, QUANTITY_ENERGY},
    {"mJ", 1, 1e3, QUANTITY_ENERGY},
    {"kJ", 1e3, 1, QUANTITY_ENERGY},
    {"MJ", 1e6, 1, QUANTITY_ENERGY},
    {"W", 1, 1, QUANTITY_POWER},
    {"mW", 1, 1e3, QUANTITY_POWER},
    {"kW", 1e3, 1, QUANTITY_POWER},
    {"MW", 1e6, 1, QUANTITY_POWER},
    {"Pa", 1, 1, QUANTITY_PRESSURE},
    {"kPa", 1e3, 1, QUANTITY_PRESSURE},
    {"MPa", 1e6, 1, QUANTITY_PRESSURE},
    {"GPa", 1e9, 1, QUANTITY_PRESSURE},
    {"bar", 1e5, 1, QUANTITY_PRESSURE},
    {"A", 1, 1, QUANTITY_CURRENT},
    {"mA", 1, 1e3, QUANTITY_CURRENT},
    {"uA", 1, 1e6, QUANTITY_CURRENT},
    {"kA", 1e3, 1, QUANTITY_CURRENT},
    {"C", 1, 1, QUANTITY_CHARGE},
    {"V", 1, 1, QUANTITY_VOLTAGE},
    {"mV", 1, 1e3, QUANTITY_VOLTAGE},
    {"uV", 1, 1e6, QUANTITY_VOLTAGE},
    {"kV", 1e3, 1, QUANTITY_VOLTAGE},
    {"ohm", 1, 1, QUANTITY_RESISTANCE},
    {"mohm", 1, 1e3, QUANTITY_RESISTANCE},
    {"kohm", 1e3, 1, QUANTITY_RESISTANCE},
    {"Mohm", 1e6, 1, QUANTITY_RESISTANCE},
    {"F", 1, 1, QUANTITY_CAPACITANCE},
    {"mF", 1, 1e3, QUANTITY_CAPACITANCE},
    {"uF", 1, 1e6, QUANTITY_CAPACITANCE},
    {"nF", 1, 1e9, QUANTITY_CAPACITANCE},
    {"pF", 1, 1e12, QUANTITY_CAPACITANCE},
    {"H", 1, 1, QUANTITY_INDUCTANCE},
    {"mH", 1, 1e3, QUANTITY_INDUCTANCE},
    {"uH", 1, 1e6, QUANTITY_INDUCTANCE},
    {"Wb", 1, 1, QUANTITY_FLUX},
    {"T", 1, 1, QUANTITY_FLUX_DENSITY},
    {"mT", 1, 1e3, QUANTITY_FLUX_DENSITY},
    {"K", 1, 1, QUANTITY_TEMPERATURE},
};
enum { UNIT_COUNT = sizeof units / sizeof units[0] };

/* Other spellings of units, and the unit to write instead. */
static const struct {
    const char *written;
    const char *meant;
} habits[] = {
    {"Nm", "N*m"},     {"Ns", "N*s"},          {"Nms", "N*m*s"}, {"mps", "m/s"},
    {"sec", "s"},      {"second", "s"},        {"seconds", "s"}, {"minute", "min"},
    {"meter", "m"},    {"metre", "m"},         {"inch", "in"},   {"inches", "in"},
    {"degree", "deg"}, {"degrees", "deg"},     {"lbs", "lb"},    {"lbm", "lb"},
    {"foot", "ft"},    {"feet", "ft"},         {"turn", "rev"},  {"radian", "rad"},
    {"newton", "N"},   {"volt", "V"},          {"hr", "h"},      {"radians", "rad"},
    {"rps", "rev/s"},  {"kgf", "9.80665 [N]"}, {"Ah", "A*h"},    {"Wh", "W*h"},
};

typedef struct reader {
    const char *text;
    size_t length;
    size_t at;
    int nesting;
    unit_error *error;
} reader;

static bool fail(reader *in, size_t offset, const char *message, const char *hint) {
    in->error->offset = offset;
    snprintf(in->error->message, sizeof in->error->message, "%s", message);
    snprintf(in->error->hint, sizeof in->error->hint, "%s", hint);
    return false;
}

static bool fail_ascii(reader *in) {
    return fail(in, in->at, "units are written in ASCII",
                ascii_hint(in->text + in->at, in->length - in->at, "write N*m, m^2, ohm, um, deg"));
}

static char peek(reader *in) {
    while (in->at < in->length && strchr(" \t\r\n", in->text[in->at]) != NULL &&
           in->text[in->at] != '\0') {
        in->at++;
    }
    return in->at < in->length ? in->text[in->at] : '\0';
}

static const unit_entry *find_unit(const char *name, size_t length) {
    for (int i = 0; i < UNIT_COUNT; i++) {
        if (strlen(units[i].name) == length && memcmp(units[i].name, name, length) == 0) {
            return &units[i];
        }
    }
    return NULL;
}

/* Encloses a factor of the table. Whole numbers are exact; decimals and multiples of pi have been rounded. */
static enclosure exact_factor(double factor) {
    return number_nearest(factor) == factor ? enclosure_of(factor) : enclosure_about(factor, 1);
}

static enclosure exact(const unit_entry *u) {
    return enclosure_div(exact_factor(u->scale), exact_factor(u->divisor));
}

static bool unknown_unit(reader *in, size_t start, size_t length) {
    const char *name = in->text + start;
    const int shown = length > 40 ? 40 : (int)length;
    char message[80];
    char hint[80] = "";
    snprintf(message, sizeof message, "unknown unit '%.*s'", shown, name);
    for (size_t i = 0; i < sizeof habits / sizeof habits[0]; i++) {
        if (strlen(habits[i].written) == length && memcmp(habits[i].written, name, length) == 0) {
            snprintf(hint, sizeof hint, "write %s", habits[i].meant);
        }
    }
    size_t stem = length;
    while (stem > 0 && is_digit(name[stem - 1])) {
        stem--;
    }
    if (hint[0] == '\0' && stem < length && find_unit(name, stem) != NULL) {
        snprintf(hint, sizeof hint, "write %.*s^%.*s", (int)stem, name, shown - (int)stem,
                 name + stem);
    } else if (hint[0] == '\0') {
        nearest search = nearest_start(name, length);
        for (int i = 0; i < UNIT_COUNT; i++) {
            nearest_offer(&search, units[i].name);
        }
        nearest_hint(&search, hint, sizeof hint);
    }
    return fail(in, start, message,
                hint[0] != '\0' ? hint : "`whirl list --units` lists the units");
}

static bool read_whole(reader *in, int *value) {
    if (!is_digit(peek(in))) {
        return fail(in, in->at, "a whole number is missing in this exponent",
                    "write s^2, s^-1, m^1.5 or m^(1/2)");
    }
    *value = 0;
    while (in->at < in->length && is_digit(in->text[in->at])) {
        *value = *value * 10 + (in->text[in->at] - '0');
        if (*value > 99) {
            return fail(in, in->at, "this exponent is above 99", "");
        }
        in->at++;
    }
    return true;
}

/* Reads the exponent after ^, such as 2, -1, 1.5, (1/2) or (-3/2). */
static bool read_exponent(reader *in, double *exponent) {
    const bool open = peek(in) == '(';
    if (open) {
        in->at++;
    }
    const bool negative = peek(in) == '-';
    if (negative) {
        in->at++;
    }
    int above = 0;
    int below = 1;
    if (!read_whole(in, &above)) {
        return false;
    }
    double tenths = 0.0;
    if (in->at < in->length && in->text[in->at] == '.') {
        double scale = 1.0;
        for (in->at++; in->at < in->length && is_digit(in->text[in->at]); in->at++) {
            scale *= 10.0;
            tenths = tenths * 10.0 + (in->text[in->at] - '0');
        }
        tenths /= scale;
    } else if (open && peek(in) == '/') {
        in->at++;
        if (!read_whole(in, &below)) {
            return false;
        }
        if (below == 0) {
            return fail(in, in->at - 1, "division by zero in an exponent", "");
        }
    }
    if (open) {
        if (peek(in) != ')') {
            return fail(in, in->at, "')' is missing in this exponent", "");
        }
        in->at++;
    }
    *exponent = (negative ? -1.0 : 1.0) * (above / (double)below + tenths);
    return true;
}

static bool read_product(reader *in, unit_scale *result);

#define BARE "leave the brackets out: a number without them has no unit"

/* Does the text consist of this sign and blanks only? */
static bool is_all(const reader *in, const char *sign) {
    const size_t blanks = strspn(in->text, " ");
    return strncmp(in->text + blanks, sign, strlen(sign)) == 0 &&
           blanks + strlen(sign) + strspn(in->text + blanks + strlen(sign), " ") >= in->length;
}

static bool read_factor(reader *in, unit_scale *result) {
    const char c = peek(in);
    const size_t start = in->at;
    *result = (unit_scale){1.0, 1.0, dim_none(), enclosure_of(1.0)};
    if (c == '(') {
        if (++in->nesting > 20) {
            return fail(in, start, "too many parentheses in a unit", "");
        }
        in->at++;
        if (!read_product(in, result)) {
            return false;
        }
        if (peek(in) != ')') {
            return fail(in, in->at, "')' is missing in this unit", "");
        }
        in->at++;
        in->nesting--;
    } else if (c == '1' && !(start + 1 < in->length &&
                             (is_digit(in->text[start + 1]) || in->text[start + 1] == '.'))) {
        in->at++;
    } else if (is_digit(c) || c == '.') {
        return fail(in, start, "a unit contains no number except 1",
                    "write numbers before the bracket: 2.5 [m/s]");
    } else if (begins_name(c)) {
        while (in->at < in->length && continues_name(in->text[in->at])) {
            in->at++;
        }
        const unit_entry *found = find_unit(in->text + start, in->at - start);
        if (found == NULL) {
            return unknown_unit(in, start, in->at - start);
        }
        *result =
            (unit_scale){found->scale, found->divisor, dim_of_quantity(found->of), exact(found)};
    } else if (c == '\0' && in->at >= in->length) {
        return fail(in, start, "a unit is missing here", is_all(in, "") ? BARE : "");
    } else if ((unsigned char)c >= 0x80) {
        return fail_ascii(in);
    } else {
        return fail(in, start, "a unit was expected here",
                    is_all(in, "-") ? BARE : "write it like N*s/m or kg*m^2");
    }
    if (peek(in) == '^') {
        const size_t sign_at = in->at++;
        double exponent = 1.0;
        if (!read_exponent(in, &exponent)) {
            return false;
        }
        const unit_scale base = *result;
        const double size = fabs(exponent); /* a negative exponent exchanges scale and divisor */
        result->scale = number_power(exponent < 0.0 ? base.divisor : base.scale, size);
        result->divisor = number_power(exponent < 0.0 ? base.scale : base.divisor, size);
        /* an exponent that is not a multiple of 1/2 may have been rounded */
        const bool is_exact = number_nearest(2.0 * exponent) == 2.0 * exponent;
        result->exact = enclosure_power(base.exact, is_exact ? enclosure_of(exponent)
                                                             : enclosure_about(exponent, 0));
        if (!dim_power(base.dim, exponent, &result->dim)) {
            return fail(in, sign_at, "this exponent gives no valid dimension", "");
        }
    }
    return true;
}

static bool read_product(reader *in, unit_scale *result) {
    if (!read_factor(in, result)) {
        return false;
    }
    for (char c = peek(in); c == '*' || c == '/'; c = peek(in)) {
        const size_t sign_at = in->at++;
        unit_scale factor;
        if (!read_factor(in, &factor)) {
            return false;
        }
        const dimension before = result->dim;
        bool kept = false;
        if (c == '*') {
            result->scale *= factor.scale;
            result->divisor *= factor.divisor;
            result->exact = enclosure_mul(result->exact, factor.exact);
            kept = dim_multiply(before, factor.dim, &result->dim);
        } else {
            result->scale *= factor.divisor;
            result->divisor *= factor.scale;
            result->exact = enclosure_div(result->exact, factor.exact);
            kept = dim_divide(before, factor.dim, &result->dim);
        }
        if (!kept) {
            return fail(in, sign_at, "the exponents of this unit are out of range", "");
        }
    }
    return true;
}

bool unit_parse(const char *text, size_t length, unit_scale *result, unit_error *error) {
    reader in = {text, length, 0, 0, error};
    error->hint[0] = '\0';
    if (!read_product(&in, result)) {
        return false;
    }
    peek(&in);
    if (in.at < in.length) {
        if (begins_name(in.text[in.at])) {
            return fail(&in, in.at, "an operator is missing between two units", "write N*m, m/s");
        }
        if ((unsigned char)in.text[in.at] >= 0x80) {
            return fail_ascii(&in);
        }
        return fail(&in, in.at, "this cannot stand in a unit", "write it like N*s/m");
    }
    if (!(result->scale > 1e-200 && result->scale < 1e200 && result->divisor > 1e-200 &&
          result->divisor < 1e200 && result->scale / result->divisor > 1e-200 &&
          result->scale / result->divisor < 1e200)) {
        return fail(&in, 0, "this unit is out of range", "");
    }
    return true;
}

bool unit_is_si(unit_scale u) { return fabs(u.scale - u.divisor) <= 1e-14 * u.divisor; }

const char *unit_name(int index) { return index < UNIT_COUNT ? units[index].name : NULL; }

char *unit_in_si(int index, double *value, char *buffer, size_t size) {
    *value = units[index].scale / units[index].divisor;
    if (units[index].of == QUANTITY_FREQUENCY) { /* in rad/s: the table's unit would be Hz */
        return dim_unit(dim_of_quantity(QUANTITY_FREQUENCY), buffer, size);
    }
    for (int i = 0; i < UNIT_COUNT; i++) {
        if (units[i].of == units[index].of && units[i].scale == units[i].divisor) {
            snprintf(buffer, size, "%s", units[i].name);
            return buffer;
        }
    }
    return dim_symbols(dim_of_quantity(units[index].of), buffer, size);
}

bool unit_is_angle(const char *text, size_t length) {
    const unit_entry *found = find_unit(text, length);
    return found != NULL && found->of == QUANTITY_ANGLE;
}

/* === arithmetic with physical dimensions, and how messages name them ========================== */

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

bool dim_derivative(dimension of, int primes, dimension *derivative) {
    dimension per_time;
    return dim_power(dim_of_quantity(QUANTITY_FREQUENCY), primes, &per_time) &&
           dim_multiply(of, per_time, derivative);
}

/* Appends a sign and a factor such as "kg", "m^2" or "s^(1/2)", cut to `size` bytes. */
static void append_factor(char *buffer, size_t size, const char *sign, const char *symbol,
                          int twelfths) {
    const size_t used = strlen(buffer);
    int above = twelfths;
    int below = DIM_DENOMINATOR;
    for (int divisor = 3; divisor > 1; divisor--) {
        while (above % divisor == 0 && below % divisor == 0) {
            above /= divisor;
            below /= divisor;
        }
    }
    snprintf(buffer + used, size - used,
             below > 1   ? "%s%s^(%d/%d)"
             : above > 1 ? "%s%s^%d"
                         : "%s%s",
             sign, symbol, above, below);
}

/* Base units in the order in which products show them. */
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
            append_factor(buffer, size, buffer[0] == '\0' ? "" : "*", base_units[i].symbol,
                          exponent);
        }
    }
    if (buffer[0] == '\0') {
        snprintf(buffer, size, "1");
    }
    for (int i = 0; i < DIM_BASES; i++) {
        const int exponent = dim.twelfths[base_units[i].base];
        if (exponent < 0) {
            append_factor(buffer, size, "/", base_units[i].symbol, -exponent);
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

/* Returns the row of this dimension, or the row of NUMBER if it has no name. */
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
