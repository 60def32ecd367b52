/* units.c: the unit table and the reader of unit expressions. */
#include "units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/base/nearest.h"
#include "host/number/functions.h"

#define PI 3.14159265358979323846

typedef struct unit_entry {
    const char *name;
    double scale;
    double divisor;
    signed char exponents[DIM_BASES]; /* m, kg, s, A, K */
} unit_entry;

/* Pound, inch and foot: the international agreement of 1959; standard gravity 9.80665 m/s^2. */
#define POUND_KG 0.45359237
#define POUND_FORCE_N 4.4482216152605

#define LENGTH \
    { 1, 0, 0, 0, 0 }
#define MASS \
    { 0, 1, 0, 0, 0 }
#define TIME \
    { 0, 0, 1, 0, 0 }
#define CURRENT \
    { 0, 0, 0, 1, 0 }
#define NUMBER \
    { 0, 0, 0, 0, 0 }
#define FREQUENCY \
    { 0, 0, -1, 0, 0 }
#define FORCE \
    { 1, 1, -2, 0, 0 }
#define ENERGY \
    { 2, 1, -2, 0, 0 }
#define POWER \
    { 2, 1, -3, 0, 0 }
#define PRESSURE \
    { -1, 1, -2, 0, 0 }
#define CHARGE \
    { 0, 0, 1, 1, 0 }
#define VOLTAGE \
    { 2, 1, -3, -1, 0 }
#define RESISTANCE \
    { 2, 1, -3, -2, 0 }
#define CAPACITANCE \
    { -2, -1, 4, 2, 0 }
#define INDUCTANCE \
    { 2, 1, -2, -2, 0 }
#define FLUX \
    { 2, 1, -2, -1, 0 }
#define FLUX_DENSITY \
    { 0, 1, -2, -1, 0 }

static const unit_entry units[] = {
    {"m", 1, 1, LENGTH},
    {"km", 1e3, 1, LENGTH},
    {"cm", 1, 1e2, LENGTH},
    {"mm", 1, 1e3, LENGTH},
    {"um", 1, 1e6, LENGTH},
    {"in", 254, 1e4, LENGTH},
    {"ft", 3048, 1e4, LENGTH},
    {"kg", 1, 1, MASS},
    {"g", 1, 1e3, MASS},
    {"mg", 1, 1e6, MASS},
    {"lb", POUND_KG, 1, MASS},
    {"oz", POUND_KG, 16, MASS},
    {"slug", POUND_FORCE_N * 1e4, 3048, MASS},
    {"s", 1, 1, TIME},
    {"ms", 1, 1e3, TIME},
    {"us", 1, 1e6, TIME},
    {"ns", 1, 1e9, TIME},
    {"min", 60, 1, TIME},
    {"h", 3600, 1, TIME},
    {"rad", 1, 1, NUMBER},
    {"deg", PI, 180, NUMBER},
    {"rev", 2 * PI, 1, NUMBER},
    {"mrad", 1, 1e3, NUMBER},
    {"rpm", 2 * PI, 60, FREQUENCY},
    {"Hz", 1, 1, FREQUENCY},
    {"kHz", 1e3, 1, FREQUENCY},
    {"MHz", 1e6, 1, FREQUENCY},
    {"N", 1, 1, FORCE},
    {"mN", 1, 1e3, FORCE},
    {"kN", 1e3, 1, FORCE},
    {"lbf", POUND_FORCE_N, 1, FORCE},
    {"ozf", POUND_FORCE_N, 16, FORCE},
    {"J", 1, 1, ENERGY},
    {"mJ", 1, 1e3, ENERGY},
    {"kJ", 1e3, 1, ENERGY},
    {"MJ", 1e6, 1, ENERGY},
    {"W", 1, 1, POWER},
    {"mW", 1, 1e3, POWER},
    {"kW", 1e3, 1, POWER},
    {"MW", 1e6, 1, POWER},
    {"Pa", 1, 1, PRESSURE},
    {"kPa", 1e3, 1, PRESSURE},
    {"MPa", 1e6, 1, PRESSURE},
    {"GPa", 1e9, 1, PRESSURE},
    {"bar", 1e5, 1, PRESSURE},
    {"A", 1, 1, CURRENT},
    {"mA", 1, 1e3, CURRENT},
    {"uA", 1, 1e6, CURRENT},
    {"kA", 1e3, 1, CURRENT},
    {"C", 1, 1, CHARGE},
    {"V", 1, 1, VOLTAGE},
    {"mV", 1, 1e3, VOLTAGE},
    {"uV", 1, 1e6, VOLTAGE},
    {"kV", 1e3, 1, VOLTAGE},
    {"ohm", 1, 1, RESISTANCE},
    {"mohm", 1, 1e3, RESISTANCE},
    {"kohm", 1e3, 1, RESISTANCE},
    {"Mohm", 1e6, 1, RESISTANCE},
    {"F", 1, 1, CAPACITANCE},
    {"mF", 1, 1e3, CAPACITANCE},
    {"uF", 1, 1e6, CAPACITANCE},
    {"nF", 1, 1e9, CAPACITANCE},
    {"pF", 1, 1e12, CAPACITANCE},
    {"H", 1, 1, INDUCTANCE},
    {"mH", 1, 1e3, INDUCTANCE},
    {"uH", 1, 1e6, INDUCTANCE},
    {"Wb", 1, 1, FLUX},
    {"T", 1, 1, FLUX_DENSITY},
    {"mT", 1, 1e3, FLUX_DENSITY},
    {"K", 1, 1, {0, 0, 0, 0, 1}},
};
enum { UNIT_COUNT = sizeof units / sizeof units[0] };

/* What people write, and what it is called here. */
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

static char peek(reader *in) {
    while (in->at < in->length && strchr(" \t\r\n", in->text[in->at]) != NULL &&
           in->text[in->at] != '\0') {
        in->at++;
    }
    return in->at < in->length ? in->text[in->at] : '\0';
}

static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static const unit_entry *find_unit(const char *name, size_t length) {
    for (int i = 0; i < UNIT_COUNT; i++) {
        if (strlen(units[i].name) == length && memcmp(units[i].name, name, length) == 0) {
            return &units[i];
        }
    }
    return NULL;
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
    if (hint[0] == '\0') {
        nearest search = nearest_start(name, length);
        for (int i = 0; i < UNIT_COUNT; i++) {
            nearest_offer(&search, units[i].name);
        }
        if (search.best != NULL) {
            snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
        }
    }
    return fail(in, start, message, hint);
}

static bool read_whole(reader *in, int *value) {
    if (!is_digit(peek(in))) {
        return fail(in, in->at, "a whole number is missing in this exponent",
                    "write s^2, s^-1 or m^(1/2)");
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

/* ^2, ^-1, ^(1/2), ^(-3/2) */
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
    if (open && peek(in) == '/') {
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
    *exponent = (negative ? -above : above) / (double)below;
    return true;
}

static bool read_product(reader *in, unit *result);

static bool read_factor(reader *in, unit *result) {
    const char c = peek(in);
    const size_t start = in->at;
    *result = (unit){1.0, 1.0, dim_none()};
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
        return fail(in, start, "a unit holds no numbers but 1",
                    "numbers stand before the bracket: 2.5 [m/s]");
    } else if (is_letter(c)) {
        while (in->at < in->length && (is_letter(in->text[in->at]) || is_digit(in->text[in->at]))) {
            in->at++;
        }
        const unit_entry *found = find_unit(in->text + start, in->at - start);
        if (found == NULL) {
            return unknown_unit(in, start, in->at - start);
        }
        const signed char *e = found->exponents;
        *result = (unit){found->scale, found->divisor, dim_of(e[0], e[1], e[2], e[3], e[4])};
    } else if (c == '\0' && in->at >= in->length) {
        return fail(in, start, "a unit is missing here", "");
    } else if ((unsigned char)c >= 0x80) {
        return fail(in, start, "units are written in ASCII", "write N*m, m^2, ohm, um, deg");
    } else {
        return fail(in, start, "a unit was expected here", "write it like N*s/m or kg*m^2");
    }
    if (peek(in) == '^') {
        const size_t sign_at = in->at++;
        double exponent = 1.0;
        if (!read_exponent(in, &exponent)) {
            return false;
        }
        const unit base = *result;
        const double size = fabs(exponent); /* 1/ms is 1000/s: its factors change places */
        result->scale = number_power(exponent < 0.0 ? base.divisor : base.scale, size);
        result->divisor = number_power(exponent < 0.0 ? base.scale : base.divisor, size);
        if (!dim_power(base.dim, exponent, &result->dim)) {
            return fail(in, sign_at, "this exponent gives no dimension we can keep", "");
        }
    }
    return true;
}

static bool read_product(reader *in, unit *result) {
    if (!read_factor(in, result)) {
        return false;
    }
    for (char c = peek(in); c == '*' || c == '/'; c = peek(in)) {
        const size_t sign_at = in->at++;
        unit factor;
        if (!read_factor(in, &factor)) {
            return false;
        }
        const dimension before = result->dim;
        bool kept = false;
        if (c == '*') {
            result->scale *= factor.scale;
            result->divisor *= factor.divisor;
            kept = dim_multiply(before, factor.dim, &result->dim);
        } else {
            result->scale *= factor.divisor;
            result->divisor *= factor.scale;
            kept = dim_divide(before, factor.dim, &result->dim);
        }
        if (!kept) {
            return fail(in, sign_at, "the exponents of this unit are out of range", "");
        }
    }
    return true;
}

bool unit_parse(const char *text, size_t length, unit *result, unit_error *error) {
    reader in = {text, length, 0, 0, error};
    error->hint[0] = '\0';
    if (!read_product(&in, result)) {
        return false;
    }
    peek(&in);
    if (in.at < in.length) {
        if (is_letter(in.text[in.at])) {
            return fail(&in, in.at, "an operator is missing between two units", "write N*m, m/s");
        }
        if ((unsigned char)in.text[in.at] >= 0x80) {
            return fail(&in, in.at, "units are written in ASCII", "write N*m, m^2, ohm, um, deg");
        }
        return fail(&in, in.at, "this does not belong into a unit", "write it like N*s/m");
    }
    if (!(result->scale > 1e-200 && result->scale < 1e200 && result->divisor > 1e-200 &&
          result->divisor < 1e200 && result->scale / result->divisor > 1e-200 &&
          result->scale / result->divisor < 1e200)) {
        return fail(&in, 0, "this unit is out of range", "");
    }
    return true;
}

bool unit_is_si(unit u) { return fabs(u.scale - u.divisor) <= 1e-14 * u.divisor; }

double unit_number(unit u, double si) { return unit_is_si(u) ? si : si * u.divisor / u.scale; }

bool unit_is_angle(const char *text, size_t length) {
    return length == 3 && (memcmp(text, "rad", 3) == 0 || memcmp(text, "deg", 3) == 0 ||
                           memcmp(text, "rev", 3) == 0);
}
