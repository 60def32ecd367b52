/* test_units.c: every unit, compared with the standards: the SI Brochure (9th edition, 2019: tables 2, 4, 7 and 8),
 * the agreement of 1959 for inch, foot and pound, and the standard gravity of 1901. The test reads only names from
 * host/lang/units.c. A unit that is not in this table fails, unless it is an SI prefix with an SI symbol of the
 * table. */
#include "host/lang/units.h"
#include "test.h"

#define INCH_M 0.0254
#define FOOT_M (12 * INCH_M)
#define POUND_KG 0.45359237
#define GRAVITY_M_S2 9.80665
#define TURN_RAD 6.283185307179586476925

/* A unit: `si` times the SI unit with these exponents. */
typedef struct definition {
    const char *name;
    double si;
    int m, kg, s, A, K;
    bool prefixed; /* the unit takes SI prefixes */
} definition;

static const definition definitions[] = {
    /* SI base units; the prefixes of mass belong to the gram */
    {"m", 1, 1, 0, 0, 0, 0, true},
    {"g", 1e-3, 0, 1, 0, 0, 0, true},
    {"s", 1, 0, 0, 1, 0, 0, true},
    {"A", 1, 0, 0, 0, 1, 0, true},
    {"K", 1, 0, 0, 0, 0, 1, true},
    /* SI units with names of their own */
    {"rad", 1, 0, 0, 0, 0, 0, true},
    {"Hz", 1, 0, 0, -1, 0, 0, true},
    {"N", 1, 1, 1, -2, 0, 0, true},
    {"Pa", 1, -1, 1, -2, 0, 0, true},
    {"J", 1, 2, 1, -2, 0, 0, true},
    {"W", 1, 2, 1, -3, 0, 0, true},
    {"C", 1, 0, 0, 1, 1, 0, true},
    {"V", 1, 2, 1, -3, -1, 0, true},
    {"F", 1, -2, -1, 4, 2, 0, true},
    {"ohm", 1, 2, 1, -3, -2, 0, true},
    {"Wb", 1, 2, 1, -2, -1, 0, true},
    {"T", 1, 0, 1, -2, -1, 0, true},
    {"H", 1, 2, 1, -2, -2, 0, true},
    /* units that are not SI units */
    {"min", 60, 0, 0, 1, 0, 0, false},
    {"h", 3600, 0, 0, 1, 0, 0, false},
    {"deg", TURN_RAD / 360, 0, 0, 0, 0, 0, false},
    {"rev", TURN_RAD, 0, 0, 0, 0, 0, false},
    {"rpm", TURN_RAD / 60, 0, 0, -1, 0, 0, false},
    {"bar", 1e5, -1, 1, -2, 0, 0, false},
    {"in", INCH_M, 1, 0, 0, 0, 0, false},
    {"ft", FOOT_M, 1, 0, 0, 0, 0, false},
    {"lb", POUND_KG, 0, 1, 0, 0, 0, false},
    {"oz", POUND_KG / 16, 0, 1, 0, 0, 0, false},
    {"lbf", POUND_KG *GRAVITY_M_S2, 1, 1, -2, 0, 0, false},
    {"ozf", POUND_KG *GRAVITY_M_S2 / 16, 1, 1, -2, 0, 0, false},
    {"slug", POUND_KG *GRAVITY_M_S2 / FOOT_M, 0, 1, 0, 0, 0, false},
};
enum { DEFINITIONS = sizeof definitions / sizeof definitions[0] };

static const struct {
    char letter;
    double factor;
} prefixes[] = {{'T', 1e12}, {'G', 1e9},  {'M', 1e6},  {'k', 1e3},  {'h', 1e2},  {'d', 1e-1},
                {'c', 1e-2}, {'m', 1e-3}, {'u', 1e-6}, {'n', 1e-9}, {'p', 1e-12}};

static bool define(const char *name, definition *found) {
    for (int i = 0; i < DEFINITIONS; i++) {
        if (strcmp(definitions[i].name, name) == 0) {
            *found = definitions[i];
            return true;
        }
    }
    for (size_t p = 0; p < sizeof prefixes / sizeof prefixes[0]; p++) {
        for (int i = 0; i < DEFINITIONS && name[0] == prefixes[p].letter; i++) {
            if (definitions[i].prefixed && strcmp(definitions[i].name, name + 1) == 0) {
                *found = definitions[i];
                found->si *= prefixes[p].factor;
                return true;
            }
        }
    }
    return false;
}

static unit_scale parsed(const char *text) {
    unit_scale result = {0};
    unit_error error;
    TEST_ASSERT_TRUE_MESSAGE(unit_parse(text, strlen(text), &result, &error), text);
    return result;
}

static bool is_about(double a, double b) { return fabs(a - b) <= 1e-15 * fabs(b); }

TEST(units, units_equal_the_standards) {
    int count = 0;
    for (const char *name = unit_name(0); name != NULL; name = unit_name(++count)) {
        char said[200];
        definition wanted;
        snprintf(said, sizeof said, "unit '%s': no definition in tests/host/test_units.c", name);
        TEST_ASSERT_TRUE_MESSAGE(define(name, &wanted), said);
        const unit_scale is = parsed(name);
        snprintf(said, sizeof said, "unit '%s' is %.17g of SI, not %.17g", name, wanted.si,
                 is.scale / is.divisor);
        TEST_ASSERT_TRUE_MESSAGE(is_about(is.scale / is.divisor, wanted.si), said);
        char wrong[DIM_TEXT_SIZE];
        const dimension dim = dim_of(wanted.m, wanted.kg, wanted.s, wanted.A, wanted.K);
        char right[DIM_TEXT_SIZE];
        snprintf(said, sizeof said, "unit '%s' is a %.60s, not a %.60s", name,
                 dim_symbols(dim, right, sizeof right), dim_symbols(is.dim, wrong, sizeof wrong));
        TEST_ASSERT_TRUE_MESSAGE(!is.dim.any && !is.dim.unknown && dim_fits(is.dim, dim), said);
    }
    TEST_ASSERT_TRUE(count >= 60);
}

/* If a unit is a power of ten or one over it, its factor must be a ratio of integers. So 7 [ms] must be 7/1000 and
 * correctly rounded, like 7e-3. */
TEST(units, prefixes_round_as_decimal_numbers_do) {
    for (int i = 0; unit_name(i) != NULL; i++) {
        definition wanted;
        const char *name = unit_name(i);
        if (!define(name, &wanted) || wanted.si > 1.0) {
            continue;
        }
        const double power = floor(log10(wanted.si) + 0.5);
        if (!is_about(wanted.si, pow(10.0, power))) {
            continue;
        }
        const unit_scale is = parsed(name);
        for (int number = 1; number < 1000; number++) {
            char text[40];
            snprintf(text, sizeof text, "%de%d", number, (int)power);
            TEST_ASSERT_TRUE_MESSAGE(number * is.scale / is.divisor == strtod(text, NULL), name);
        }
    }
}

/* `whirl list --units` must give each unit as a number of an SI unit of the same dimension. */
TEST(units, units_are_listed_in_si) {
    for (int i = 0; unit_name(i) != NULL; i++) {
        char si[DIM_TEXT_SIZE];
        double value = 0.0;
        definition wanted;
        const char *name = unit_name(i);
        TEST_ASSERT_TRUE_MESSAGE(define(name, &wanted), name);
        const unit_scale told = parsed(unit_in_si(i, &value, si, sizeof si));
        TEST_ASSERT_TRUE_MESSAGE(is_about(value, wanted.si), name);
        TEST_ASSERT_TRUE_MESSAGE(told.scale == told.divisor, name);
        TEST_ASSERT_TRUE_MESSAGE(dim_fits(told.dim, parsed(name).dim), name);
    }
}

/* A decimal exponent, as in m^1.5 of Hertz's law, must equal the same exponent written as a fraction. */
TEST(units, decimal_exponents) {
    for (int i = 0; unit_name(i) != NULL; i++) {
        for (int halves = -7; halves <= 7; halves++) {
            char decimal[60];
            char fraction[60];
            snprintf(decimal, sizeof decimal, i % 2 == 0 ? "N/%s^%.1f" : "N/%s^(%.1f)", // NOLINT
                     unit_name(i), 0.5 * halves);
            snprintf(fraction, sizeof fraction, "N/%s^(%d/2)", unit_name(i), halves);
            const unit_scale is = parsed(decimal);
            const unit_scale wanted = parsed(fraction);
            TEST_ASSERT_TRUE_MESSAGE(is.scale == wanted.scale && is.divisor == wanted.divisor &&
                                         dim_fits(is.dim, wanted.dim),
                                     decimal);
        }
    }
    unit_scale result;
    unit_error error;
    /* 1.05 is not a multiple of 1/12 */
    TEST_ASSERT_FALSE(unit_parse("m^1.05", 6, &result, &error));
}

TEST(units, names_are_unique) {
    for (int i = 0; unit_name(i) != NULL; i++) {
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_TRUE_MESSAGE(strcmp(unit_name(i), unit_name(k)) != 0, unit_name(i));
        }
        const char *name = unit_name(i); /* in the sequence of units.h */
        const bool angle =
            strcmp(name, "rad") == 0 || strcmp(name, "deg") == 0 || strcmp(name, "rev") == 0;
        TEST_ASSERT_TRUE_MESSAGE(unit_is_angle(name, strlen(name)) == angle, name);
    }
}

TEST(units, no_unit_is_missing) {
    for (int i = 0; i < DEFINITIONS; i++) {
        bool there = false;
        for (int k = 0; unit_name(k) != NULL; k++) {
            there = there || strcmp(unit_name(k), definitions[i].name) == 0;
        }
        TEST_ASSERT_TRUE_MESSAGE(there, definitions[i].name);
    }
}

TEST(units, hints_for_habits_mean_the_same) {
    static const definition habits[] = {
        {"Nm", 1, 2, 1, -2, 0, 0, false},
        {"Ns", 1, 1, 1, -1, 0, 0, false},
        {"Nms", 1, 2, 1, -1, 0, 0, false},
        {"mps", 1, 1, 0, -1, 0, 0, false},
        {"sec", 1, 0, 0, 1, 0, 0, false},
        {"second", 1, 0, 0, 1, 0, 0, false},
        {"seconds", 1, 0, 0, 1, 0, 0, false},
        {"minute", 60, 0, 0, 1, 0, 0, false},
        {"meter", 1, 1, 0, 0, 0, 0, false},
        {"metre", 1, 1, 0, 0, 0, 0, false},
        {"inch", INCH_M, 1, 0, 0, 0, 0, false},
        {"inches", INCH_M, 1, 0, 0, 0, 0, false},
        {"foot", FOOT_M, 1, 0, 0, 0, 0, false},
        {"feet", FOOT_M, 1, 0, 0, 0, 0, false},
        {"degree", TURN_RAD / 360, 0, 0, 0, 0, 0, false},
        {"degrees", TURN_RAD / 360, 0, 0, 0, 0, 0, false},
        {"turn", TURN_RAD, 0, 0, 0, 0, 0, false},
        {"rps", TURN_RAD, 0, 0, -1, 0, 0, false},
        {"radian", 1, 0, 0, 0, 0, 0, false},
        {"radians", 1, 0, 0, 0, 0, 0, false},
        {"lbs", POUND_KG, 0, 1, 0, 0, 0, false},
        {"lbm", POUND_KG, 0, 1, 0, 0, 0, false},
        {"newton", 1, 1, 1, -2, 0, 0, false},
        {"kgf", GRAVITY_M_S2, 1, 1, -2, 0, 0, false},
        {"volt", 1, 2, 1, -3, -1, 0, false},
        {"hr", 3600, 0, 0, 1, 0, 0, false},
        {"Ah", 3600, 0, 0, 1, 1, 0, false},
        {"Wh", 3600, 2, 1, -2, 0, 0, false},
    };
    for (size_t i = 0; i < sizeof habits / sizeof habits[0]; i++) {
        const definition *h = &habits[i];
        unit_scale result;
        unit_error error;
        char unit[40] = "";
        TEST_ASSERT_TRUE_MESSAGE(!unit_parse(h->name, strlen(h->name), &result, &error), h->name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, strncmp(error.hint, "write ", 6), h->name);
        char *rest;
        double number = strtod(error.hint + 6, &rest); /* "write 3600 [s]", or "write N*m" */
        if (rest == error.hint + 6 || sscanf(rest, " [%39[^]]", unit) < 1) {
            number = 1.0;
            TEST_ASSERT_EQUAL_INT_MESSAGE(1, sscanf(error.hint, "write %39s", unit), h->name);
        }
        const unit_scale is = parsed(unit);
        TEST_ASSERT_TRUE_MESSAGE(is_about(number * is.scale / is.divisor, h->si), h->name);
        TEST_ASSERT_TRUE_MESSAGE(dim_fits(is.dim, dim_of(h->m, h->kg, h->s, h->A, h->K)), h->name);
    }
}

/* The unit that records and hints print for a dimension must be an SI unit of that dimension, and the usual unit if
 * there is one. */
TEST(units, dimensions_are_written_in_their_usual_units) {
    static const char *const recorded[] = {"N", "N*m", "W", "N*m*s", "V"};
    static const char *const hinted[] = {"N",       "N*m", "W",   "Pa", "N/m", "N*s/m", "rad/s",
                                         "rad/s^2", "V",   "ohm", "C",  "F",   "H"};
    char unit[DIM_TEXT_SIZE];
    for (size_t i = 0; i < sizeof recorded / sizeof recorded[0]; i++) {
        TEST_ASSERT_EQUAL_STRING(recorded[i],
                                 dim_recorded_unit(parsed(recorded[i]).dim, unit, sizeof unit));
    }
    for (size_t i = 0; i < sizeof hinted / sizeof hinted[0]; i++) {
        TEST_ASSERT_EQUAL_STRING(hinted[i], dim_unit(parsed(hinted[i]).dim, unit, sizeof unit));
    }
    for (int of_si = 0; of_si < 3 * DEFINITIONS * DEFINITIONS; of_si++) {
        const definition *a = &definitions[of_si % DEFINITIONS];
        const definition *b = &definitions[of_si / DEFINITIONS % DEFINITIONS];
        const int sign = of_si / DEFINITIONS / DEFINITIONS - 1; /* -1: a/b; 0: a; 1: a*b */
        const dimension dim = dim_of(a->m + sign * b->m, a->kg + sign * b->kg, a->s + sign * b->s,
                                     a->A + sign * b->A, a->K + sign * b->K);
        for (int k = 0; k < 2 && !dim_is_none(dim); k++) {
            const unit_scale is = parsed(k == 0 ? dim_unit(dim, unit, sizeof unit)
                                                : dim_recorded_unit(dim, unit, sizeof unit));
            TEST_ASSERT_TRUE_MESSAGE(is.scale == is.divisor && dim_fits(is.dim, dim), unit);
        }
    }
}

/* In each base unit, exponents must be limited to 99 and -99. */
TEST(units, exponents_end_at_both_ends) {
    for (int i = 0; i < 2 * DIM_BASES; i++) {
        const int sign = i < DIM_BASES ? 1 : -1;
        int one[DIM_BASES] = {0};
        one[i % DIM_BASES] = sign;
        const dimension unit = dim_of(one[0], one[1], one[2], one[3], one[4]);
        dimension made = dim_none();
        for (int k = 0; k < 99; k++) {
            TEST_ASSERT_TRUE(dim_multiply(made, unit, &made));
        }
        TEST_ASSERT_FALSE(dim_multiply(made, unit, &made));
        TEST_ASSERT_FALSE(
            dim_divide(made, dim_of(-one[0], -one[1], -one[2], -one[3], -one[4]), &made));
    }
}
