#include "formula.h"
#include "test.h"

typedef struct reader {
    const char *at;
    formula_lookup *lookup;
    void *context;
    bool bad;
} reader;

static double sum(reader *r);

static void skip(reader *r) {
    while (*r->at == ' ') {
        r->at++;
    }
}

static bool take(reader *r, char c) {
    skip(r);
    if (*r->at != c) {
        return false;
    }
    r->at++;
    return true;
}

static void need(reader *r, char c) { r->bad = !take(r, c) || r->bad; }

static double call(reader *r, const char *name, int length) {
    const double x = sum(r);
    const double y = take(r, ',') ? sum(r) : 0.0;
    need(r, ')');
    static const struct {
        const char *name;
        double (*function)(double);
    } one[] = {{"sin", sin},   {"cos", cos},   {"tan", tan},  {"asin", asin}, {"acos", acos},
               {"atan", atan}, {"sqrt", sqrt}, {"exp", exp},  {"log", log},   {"abs", fabs},
               {"sinh", sinh}, {"cosh", cosh}, {"tanh", tanh}};
    for (size_t i = 0; i < sizeof one / sizeof one[0]; i++) {
        if ((int)strlen(one[i].name) == length && strncmp(one[i].name, name, (size_t)length) == 0) {
            return one[i].function(x);
        }
    }
    if (length == 5 && strncmp(name, "atan2", 5) == 0) {
        return atan2(x, y);
    }
    if (length == 4 && strncmp(name, "sign", 4) == 0) {
        return (double)(x > 0.0) - (double)(x < 0.0);
    }
    if (length == 3 && strncmp(name, "min", 3) == 0) {
        return fmin(x, y);
    }
    if (length == 3 && strncmp(name, "max", 3) == 0) {
        return fmax(x, y);
    }
    char said[100];
    snprintf(said, sizeof said, "tests/host/formula.c does not know the function '%.*s'", length,
             name);
    TEST_FAIL_MESSAGE(said);
    return 0.0;
}

static double primary(reader *r) {
    skip(r);
    if (take(r, '(')) {
        const double inside = sum(r);
        need(r, ')');
        return inside;
    }
    if (isdigit((unsigned char)*r->at)) {
        char *end;
        const double number = strtod(r->at, &end);
        r->at = end;
        return number;
    }
    const char *name = r->at;
    while (isalnum((unsigned char)*r->at) || *r->at == '_' || *r->at == '\'') {
        r->at++;
    }
    int length = (int)(r->at - name);
    if (length == 0) {
        r->bad = true;
        return 0.0;
    }
    if (*r->at == '(' && length == 1 && *name == 'y') { /* an element, such as y(3) */
        while (*r->at != ')' && *r->at != '\0') {
            r->at++;
        }
        need(r, ')');
        length = (int)(r->at - name);
    } else if (*r->at == '(') {
        r->at++;
        return call(r, name, length);
    }
    const double value = r->lookup(r->context, name, length);
    if (isnan(value)) {
        r->at = name;
        r->bad = true;
    }
    return value;
}

static double power(reader *r) {
    const double base = primary(r);
    return take(r, '^') ? pow(base, power(r)) : base;
}

static double product(reader *r) {
    double value = take(r, '-') ? -power(r) : power(r);
    for (;;) {
        if (take(r, '*')) {
            value *= power(r);
        } else if (take(r, '/')) {
            value /= power(r);
        } else {
            return value;
        }
    }
}

static double sum(reader *r) {
    double value = product(r);
    for (;;) {
        skip(r);
        if (r->at[0] == '+') {
            r->at++;
            value += product(r);
        } else if (r->at[0] == '-') {
            r->at++;
            value -= product(r);
        } else {
            return value;
        }
        if (r->bad) {
            return value;
        }
    }
}

double formula_value(const char *text, const char **end, formula_lookup *lookup, void *context) {
    reader r = {text, lookup, context, false};
    const double value = sum(&r);
    skip(&r);
    *end = r.at;
    return r.bad ? (double)NAN : value;
}
