#include "latex_value.h"
#include "test.h"

/* Relative errors of a printed number, a sum, a product and a function value. */
#define PRINTED 1e-13
#define ADDED (1e-14 + DBL_EPSILON)
#define ROUNDED DBL_EPSILON
#define CALLED (4.0 * DBL_EPSILON)

enum { NAME_MAX_LENGTH = 100 };

static const latex_number nothing;

typedef struct reader {
    const char *at;
    const char *problem;
    latex_lookup *lookup;
    void *context;
} reader;

static latex_number sum(reader *r);

/* --- numbers ----------------------------------------------------------------------------------------*/

latex_number latex_constant(double value, double off) {
    latex_number n = {.value = {value}, .off = {off}};
    return n;
}

static latex_number fail(reader *r, const char *problem) {
    if (r->problem == NULL) {
        r->problem = problem;
    }
    return latex_constant((double)NAN, 0.0);
}

static latex_number fail_named(reader *r, const char *problem, const char *name) {
    static char said[160]; /* until the next one */
    if (r->problem == NULL) {
        snprintf(said, sizeof said, "%s: '%s'", problem, name);
    }
    return fail(r, said);
}

static bool is_constant(const latex_number *n) {
    for (int k = 1; k < LATEX_PLACES; k++) {
        if (n->value[k] != 0.0 || n->off[k] != 0.0) {
            return false;
        }
    }
    return true;
}

static latex_number add(latex_number a, latex_number b, double sign) {
    for (int k = 0; k < LATEX_PLACES; k++) {
        a.off[k] += b.off[k] + ADDED * (fabs(a.value[k]) + fabs(b.value[k]));
        a.value[k] += sign * b.value[k];
    }
    return a;
}

static latex_number times(reader *r, latex_number a, latex_number b) {
    if (!is_constant(&b)) {
        const latex_number swap = a;
        a = b;
        b = swap;
    }
    if (!is_constant(&b)) {
        return fail(r, "a product of two highest derivatives");
    }
    for (int k = 0; k < LATEX_PLACES; k++) {
        a.off[k] = a.off[k] * fabs(b.value[0]) + fabs(a.value[k]) * b.off[0];
        a.value[k] *= b.value[0];
        a.off[k] += ROUNDED * fabs(a.value[k]);
    }
    return a;
}

static latex_number over(reader *r, latex_number a, latex_number b) {
    if (!is_constant(&b)) {
        return fail(r, "a highest derivative below a fraction bar");
    }
    for (int k = 0; k < LATEX_PLACES; k++) {
        a.value[k] /= b.value[0];
        a.off[k] = (a.off[k] + fabs(a.value[k]) * b.off[0]) / fabs(b.value[0]) +
                   ROUNDED * fabs(a.value[k]);
    }
    return a;
}

/* Change of f if x changes by `off`, from a difference. Only its size is used. */
static double carried(double (*f)(double, double), double x, double y, int which, double off) {
    const double step = 1e-6 * (1.0 + fabs(which == 0 ? x : y));
    const double more = which == 0 ? f(x + step, y) : f(x, y + step);
    const double less = which == 0 ? f(x - step, y) : f(x, y - step);
    return off == 0.0 ? 0.0 : fabs(more - less) / (2.0 * step) * off;
}

static latex_number call_of(reader *r, double (*f)(double, double), const latex_number *x,
                            const latex_number *y) {
    if (!is_constant(x) || !is_constant(y)) {
        return fail(r, "a function of a highest derivative");
    }
    const double value = f(x->value[0], y->value[0]);
    return latex_constant(value, carried(f, x->value[0], y->value[0], 0, x->off[0]) +
                                     carried(f, x->value[0], y->value[0], 1, y->off[0]) +
                                     CALLED * fabs(value));
}

static latex_number power(reader *r, const latex_number *base, const latex_number *exponent) {
    if (!is_constant(base) || !is_constant(exponent)) {
        return fail(r, "a power of a highest derivative");
    }
    const double x = base->value[0];
    const double e = exponent->value[0];
    const double value = pow(x, e);
    const bool whole = e == floor(e); /* a printed integer exponent is exact */
    const double by_x = base->off[0] == 0.0 ? 0.0 : fabs(e * pow(x, e - 1.0)) * base->off[0];
    const double by_e = whole || value == 0.0 ? 0.0 : fabs(value * log(x)) * exponent->off[0];
    return latex_constant(value, by_x + by_e + CALLED * fabs(value));
}

/* --- functions --------------------------------------------------------------------------------------*/

static double sign_of(double x) { return (double)(x > 0.0) - (double)(x < 0.0); }

#define OF_ONE(X) \
    X(sin, sin(x)) \
    X(cos, cos(x)) \
    X(tan, tan(x)) \
    X(asin, asin(x)) \
    X(acos, acos(x)) \
    X(atan, atan(x)) \
    X(sqrt, sqrt(x)) \
    X(exp, exp(x)) \
    X(log, log(x)) \
    X(sinh, sinh(x)) \
    X(cosh, cosh(x)) \
    X(tanh, tanh(x)) \
    X(abs, fabs(x)) \
    X(sign, sign_of(x))

#define OF_X(name, ...) \
    static double of_##name(double x, double y) { \
        (void)y; \
        return __VA_ARGS__; \
    }
OF_ONE(OF_X)

typedef struct function {
    const char *name;
    int arguments;
    double (*value)(double x, double y);
} function;

#define ROW(name, ...) {#name, 1, of_##name},
static const function functions[] = {
    OF_ONE(ROW){"atan2", 2, atan2}, {"min", 2, fmin}, {"max", 2, fmax}};

static const function *function_called(const char *name) {
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        if (strcmp(functions[i].name, name) == 0) {
            return &functions[i];
        }
    }
    return NULL;
}

/* --- reading ----------------------------------------------------------------------------------------*/

static void skip(reader *r) {
    while (*r->at == ' ') {
        r->at++;
    }
}

static bool take(reader *r, const char *text) {
    skip(r);
    const size_t length = strlen(text);
    if (strncmp(r->at, text, length) != 0) {
        return false;
    }
    r->at += length;
    return true;
}

static void need(reader *r, const char *text) {
    if (!take(r, text)) {
        fail(r, "something is missing here");
    }
}

static latex_number braced(reader *r) {
    need(r, "{");
    const latex_number inside = sum(r);
    need(r, "}");
    return inside;
}

/* Reads letters and digits up to the brace; "\_" is "_". An index of letters is in \mathrm. */
static void braced_name(reader *r, char *name) {
    int length = 0;
    need(r, "{");
    if (take(r, "\\mathrm")) {
        braced_name(r, name);
        need(r, "}");
        return;
    }
    while (r->problem == NULL && *r->at != '}') {
        r->at += *r->at == '\\';
        if ((!isalnum((unsigned char)*r->at) && *r->at != '_') || length == NAME_MAX_LENGTH) {
            fail(r, "no name");
            break;
        }
        name[length++] = *r->at++;
    }
    name[length] = '\0';
    need(r, "}");
}

/* A command's name without its backslash, which has been read; "" without one. */
static void command(reader *r, char *name) {
    int length = 0;
    r->at++;
    while (isalpha((unsigned char)*r->at) && length < NAME_MAX_LENGTH) {
        name[length++] = *r->at++;
    }
    name[length] = '\0';
}

static void letters(reader *r, char *stem) {
    skip(r);
    if (isalpha((unsigned char)*r->at)) {
        stem[0] = *r->at++;
        stem[1] = '\0';
        return;
    }
    if (*r->at != '\\') {
        stem[0] = '\0';
        fail(r, "a symbol is missing");
        return;
    }
    command(r, stem);
    if (strcmp(stem, "mathrm") == 0) {
        braced_name(r, stem);
    }
}

/* Reads what follows a symbol's letters: its index, and more than two dots as ^{(3)}. */
static latex_number symbol_with(reader *r, const char *stem, int primes) {
    char index[NAME_MAX_LENGTH + 1] = "";
    latex_number found;
    const char *from = r->at;
    if (take(r, "_")) {
        braced_name(r, index);
    }
    if (take(r, "^{(")) {
        char *end;
        primes = (int)strtol(r->at, &end, 10);
        r->at = end;
        need(r, ")}");
    }
    if (r->problem != NULL || !r->lookup(r->context, stem, index, primes, &found)) {
        r->at = r->problem == NULL ? from : r->at;
        return fail_named(
            r, "no symbol of the mechanism and no function of tests/host/latex_value.c", stem);
    }
    return found;
}

/* A call, perhaps with its exponent before the argument. An argument without parentheses is one symbol. */
static latex_number called(reader *r, const char *name) {
    const function *f = function_called(name);
    if (f == NULL) {
        return fail_named(r, "no function of tests/host/latex_value.c", name);
    }
    latex_number exponent = latex_constant(1.0, 0.0);
    const bool raised = take(r, "^");
    latex_number x;
    latex_number y = nothing;
    exponent = raised ? braced(r) : exponent;
    if (take(r, "\\left(")) {
        x = sum(r);
        if (f->arguments == 2) {
            need(r, ",");
            y = sum(r);
        }
        need(r, "\\right)");
    } else {
        char stem[NAME_MAX_LENGTH + 1];
        letters(r, stem);
        x = symbol_with(r, stem, 0);
    }
    const latex_number value = call_of(r, f->value, &x, &y);
    return raised ? power(r, &value, &exponent) : value;
}

static latex_number after_command(reader *r) {
    char name[NAME_MAX_LENGTH + 1];
    const char *from = r->at;
    if (take(r, "\\left(")) {
        const latex_number inside = sum(r);
        need(r, "\\right)");
        return inside;
    }
    command(r, name);
    const int dots = strcmp(name, "dot") == 0 ? 1 : strcmp(name, "ddot") == 0 ? 2 : 0;
    if (dots > 0) {
        need(r, "{");
        letters(r, name);
        need(r, "}");
        return symbol_with(r, name, dots);
    }
    if (strcmp(name, "frac") == 0) {
        const latex_number top = braced(r);
        return over(r, top, braced(r));
    }
    if (strcmp(name, "sqrt") == 0) {
        const latex_number inside = braced(r);
        return call_of(r, of_sqrt, &inside, &nothing);
    }
    if (strcmp(name, "operatorname") == 0) {
        braced_name(r, name);
    } else if (function_called(name) == NULL) {
        r->at = from;
        letters(r, name);
        return symbol_with(r, name, 0);
    }
    return called(r, name);
}

/* {x}_{1}^{(3)}: more than two dots. Otherwise the base of a power in braces. */
static latex_number group(reader *r) {
    const char *from = r->at;
    char stem[NAME_MAX_LENGTH + 1];
    reader look = *r;
    look.at++;
    letters(&look, stem);
    if (look.problem == NULL && take(&look, "}")) {
        char index[NAME_MAX_LENGTH + 1];
        const char *behind = look.at;
        if (take(&look, "_")) {
            braced_name(&look, index);
        }
        if (look.problem == NULL && take(&look, "^{(")) {
            r->at = behind;
            return symbol_with(r, stem, 0);
        }
    }
    r->at = from;
    return braced(r);
}

static latex_number number(reader *r) {
    char *end;
    double value = strtod(r->at, &end); /* no e: that is written \cdot 10^{} */
    r->at = end;
    if (take(r, "\\cdot 10^{")) {
        value *= pow(10.0, (double)strtol(r->at, &end, 10));
        r->at = end;
        need(r, "}");
    }
    return latex_constant(value, PRINTED * fabs(value));
}

static latex_number factor(reader *r) {
    latex_number base;
    skip(r);
    if (isdigit((unsigned char)*r->at)) {
        base = number(r);
    } else if (*r->at == '\\') {
        base = after_command(r);
    } else if (*r->at == '{') {
        base = group(r);
    } else if (take(r, "(")) {
        base = sum(r);
        need(r, ")");
    } else {
        char stem[NAME_MAX_LENGTH + 1];
        letters(r, stem);
        base = symbol_with(r, stem, 0);
    }
    if (r->problem == NULL && take(r, "^")) {
        const latex_number exponent = braced(r);
        return power(r, &base, &exponent);
    }
    return base;
}

static latex_number product(reader *r) {
    latex_number value = factor(r);
    while (r->problem == NULL) {
        if (take(r, "\\,")) {
            value = times(r, value, factor(r));
        } else if (take(r, "/")) {
            value = over(r, value, factor(r));
        } else {
            return value;
        }
    }
    return value;
}

static latex_number sum(reader *r) {
    latex_number value = take(r, "-") ? add(nothing, product(r), -1.0) : product(r);
    while (r->problem == NULL) {
        const double sign = take(r, "+") ? 1.0 : take(r, "-") ? -1.0 : 0.0;
        if (sign == 0.0) {
            return value;
        }
        value = add(value, product(r), sign);
    }
    return value;
}

latex_number latex_value(const char *text, const char **end, const char **problem,
                         latex_lookup *lookup, void *context) {
    reader r = {text, NULL, lookup, context};
    latex_number value = sum(&r);
    skip(&r);
    if (*r.at != '&' && *r.at != '\n' && *r.at != '\0' && strncmp(r.at, "\\\\", 2) != 0) {
        value = fail(&r, "what does not belong here");
    }
    *end = r.at;
    *problem = r.problem;
    return value;
}
