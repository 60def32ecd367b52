/* test_octave.c: files for Octave, in both forms. The test evaluates them line by line: the slopes must be the
 * accelerations of the operation lists, and no value may become complex. Also evaluates the printed LaTeX. */
#include "command.h"
#include "formula.h"
#include "latex.h"
#include "mechanism.h"
#include "printed.h"

/* Evaluates the LaTeX that the program prints, with error bounds, as a number plus multiples of the highest
 * derivatives. latex.h only checks that LaTeX compiles. */

enum { LATEX_UNKNOWNS = 16, LATEX_PLACES = 1 + LATEX_UNKNOWNS };

/* The number is value[0] + sum value[1 + i] * (highest derivative of unknown i). off[] bounds its errors:
 * - of printed numbers, because show_as_fraction() replaces a number that is within 1e-13 of a fraction;
 * - of sums, because the algebra treats a cancellation below 1e-14 of the parts as zero;
 * - round-off, also of libm's functions.
 *
 * Slopes carry the errors on (running error analysis, as in host/engine/rounding.h). */
typedef struct latex_number {
    double value[LATEX_PLACES];
    double off[LATEX_PLACES];
} latex_number;

/* Finds a symbol by its letters ("theta", "m", "mass"), its index ("1"; "" if there is none; "_" for LaTeX's "\_")
 * and its number of dots. Returns false if there is no such symbol. */
typedef bool latex_lookup(void *context, const char *stem, const char *index, int primes,
                          latex_number *found);

/* Relative errors of a printed number, a sum, a product and the value of a function. */
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

static latex_number latex_constant(double value, double off) {
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
    static char about[160]; /* text of the last problem */
    if (r->problem == NULL) {
        snprintf(about, sizeof about, "%s: '%s'", problem, name);
    }
    return fail(r, about);
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

/* How much f changes if x (which = 0) or y changes by `off`, from a difference. Only the absolute value is used. */
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

/* Reads letters and digits up to the closing brace, with "_" for "\_". An index made of letters is in \mathrm. */
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

/* Reads a command's name; the backslash is the present character. The name is "" if no letters follow. */
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

/* Reads the rest of a symbol after its letters: its index, and three or more dots as ^{(3)}. */
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
        return fail_named(r, "no symbol of the mechanism and no function of this file", stem);
    }
    return found;
}

/* Reads a function call. An exponent may stand before the argument; an argument without parentheses is one symbol. */
static latex_number called(reader *r, const char *name) {
    const function *f = function_called(name);
    if (f == NULL) {
        return fail_named(r, "no function of this file", name);
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

/* Reads {x}_{1}^{(3)}, a symbol with three or more dots, or else the base of a power in braces. */
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
    double value = strtod(r->at, &end); /* no "e": exponents are printed as \cdot 10^{} */
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

/* Evaluates from `text` up to '&', '\\' or the end of the line; *end: that place. Some forms are never printed, such
 * as a product of two highest derivatives: then the value is NaN, *problem the reason, valid until the next call,
 * and *end its place. Otherwise *problem is NULL. */
static latex_number latex_value(const char *text, const char **end, const char **problem,
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

/* === suite octave ============================================================================= */

enum { STATES = 10, RESULTS_MAX = 128 };

/* If a function may be undefined for a real argument, Octave would go on with complex values. */
TEST(octave, files_stay_real) {
    static const struct {
        const char *call;
        bool leaves;
    } calls[] = {{"sqrt(q/u)", true},      {"log(q/u)", true},     {"asin(q/u)", true},
                 {"acos(q/u)", true},      {"(q/u)^0.3", true},    {"sin(q/u)", false},
                 {"cos(q/u)", false},      {"tan(q/u)", false},    {"atan(q/u)", false},
                 {"atan2(q/u, 2)", false}, {"exp(q/u)", false},    {"sinh(q/u)", false},
                 {"cosh(q/u)", false},     {"tanh(q/u)", false},   {"abs(q/u)", false},
                 {"sign(q/u)", false},     {"min(q/u, 2)", false}, {"(q/u)^3", false}};
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
        char text[300];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate q [m]\nparameter u = 1 [m]\nT = 1 [kg]*q'^2/2\n"
                 "Q(q) = 1 [N]*%s\n",
                 calls[i].call);
        derived d = derived_surely(derived_text(text), text);
        char *file = printed(&d, FOLDED);
        TEST_ASSERT_EQUAL_MESSAGE(calls[i].leaves, strstr(file, "~isreal(dy)") != NULL,
                                  calls[i].call);
        free(file);
        derived_free(&d);
    }
}

typedef struct named_value {
    char name[80];
    double value;
} named_value;

enum { NAMED_MAX = 4000, OWN_SEED = 45 };

typedef struct named_file {
    named_value row[NAMED_MAX];
    int count;
    const double *y;
} named_file;

static double named_lookup(void *context, const char *name, int length) {
    const named_file *f = context;
    if (*name == 'y' && name[1] == '(') {
        return f->y[(int)strtol(name + 2, NULL, 10) - 1];
    }
    for (int i = f->count - 1; i >= 0; i--) {
        if ((int)strlen(f->row[i].name) == length &&
            strncmp(f->row[i].name, name, (size_t)length) == 0) {
            return f->row[i].value;
        }
    }
    return (double)NAN;
}

static void name_value(named_file *f, const char *name, double value) {
    TEST_ASSERT_TRUE(f->count < NAMED_MAX && strlen(name) < sizeof f->row->name);
    strcpy(f->row[f->count].name, name);
    f->row[f->count++].value = value;
}

/* Solves A x = b by elimination with partial pivoting. A missing element counts as 0. */
static void solve_named(named_file *f, const char *x, const char *A, const char *b, int n) {
    long double m[UNKNOWNS][UNKNOWNS + 1];
    long double solved[UNKNOWNS];
    char name[80];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= n; j++) {
            if (j < n) {
                snprintf(name, sizeof name, "%s(%d, %d)", A, i + 1, j + 1);
            } else {
                snprintf(name, sizeof name, "%s(%d)", b, i + 1);
            }
            const double known = named_lookup(f, name, (int)strlen(name));
            m[i][j] = isnan(known) ? 0.0L : (long double)known;
        }
    }
    dense_solve(n, UNKNOWNS + 1, m[0], solved);
    for (int k = 0; k < n; k++) {
        snprintf(name, sizeof name, "%s(%d)", x, k + 1);
        name_value(f, name, (double)solved[k]);
    }
}

/* Runs the lines of a file with n equations. slope[components] receives the slopes. */
static void run_named(const char *what, const char *text, named_file *f, int n, int components,
                      double *slope) {
    for (const char *line = strstr(text, "\n  ") + 1; strncmp(line, "  ", 2) == 0;
         line = strchr(line, '\n') + 1) {
        char target[80];
        char A[80];
        char b[80];
        const char *from = strstr(line, " = ");
        if (strncmp(line, "  if ", 5) == 0) {
            continue;
        }
        TEST_ASSERT_TRUE_MESSAGE(from != NULL && from - line < 80, what);
        snprintf(target, sizeof target, "%.*s", (int)(from - line - 2), line + 2);
        from += 3;
        const char *end;
        if (strcmp(target, "dy") == 0 && *from == '[') {
            for (int i = 0; *from != ']'; i++, from = end) {
                from += strspn(from, "[; ");
                slope[i] = formula_value(from, &end, named_lookup, f);
                TEST_ASSERT_TRUE_MESSAGE(strchr(";]", *end) != NULL, what);
            }
        } else if (sscanf(from, "%79[A-Za-z_] \\ %79[A-Za-z_];", A, b) == 2) {
            solve_named(f, target, A, b, n);
        } else if (strncmp(from, "zeros(", 6) != 0) {
            const bool element = strchr(from, '(') != NULL && strchr(from, '*') == NULL;
            char whole[80];
            snprintf(whole, sizeof whole, "%.*s", (int)strcspn(from, ";"), from);
            const double known = element ? named_lookup(f, whole, (int)strlen(whole)) : (double)NAN;
            if (isnan(known)) {
                const double value = formula_value(from, &end, named_lookup, f);
                if (strncmp(end, ";", 1) != 0) {
                    printf("  %s: %.120s\n", what, line);
                }
                TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(";", end, 1, what);
                name_value(f, target, value);
            } else {
                name_value(f, target, known);
            }
        }
    }
    for (int i = 0; strstr(text, "  dy(1) = ") != NULL && i < components; i++) {
        char element[20];
        snprintf(element, sizeof element, "dy(%d)", i + 1);
        slope[i] = named_lookup(f, element, (int)strlen(element));
    }
}

/* Checks the comments at the head of a file: the components of y in sequence, and their start values. */
static void check_head(const derived *d, const char *text) {
    const char *names = strstr(text, "\n% y = (");
    const char *starts = strstr(text, "\n% [T, Y] = ode45(@");
    TEST_ASSERT_TRUE(names != NULL && starts != NULL);
    names += strlen("\n% y = (");
    starts = strstr(starts, ", [0 ");
    TEST_ASSERT_TRUE(strtod(starts + strlen(", [0 "), NULL) == d->image->until_s);
    starts = strstr(starts, "], [") + strlen("], [");
    for (int level = 0; level < 8; level++) {
        for (int i = 0; i < d->equations->count; i++) {
            const unknown *u = &d->equations->unknowns[i];
            char name[80];
            char *end;
            if (u->order > level) {
                snprintf(name, sizeof name, "%s%.*s", u->symbol->name, level, "''''''''");
                TEST_ASSERT_EQUAL_STRING_LEN(name, names, strlen(name));
                TEST_ASSERT_NOT_NULL_MESSAGE(strchr(",)", names[strlen(name)]), names);
                names += strlen(name) + 2;
                TEST_ASSERT_TRUE(strtod(starts, &end) == d->instance->start[i][level]);
                starts = end + strspn(end, "; ");
            }
        }
    }
    TEST_ASSERT_EQUAL_STRING_LEN("], options);", starts, 12);
}

/* Checks lines such as "I_r = 0.01125; % [kg*m^2] = M_r*R^2/2: ...": with --set, the formula after the unit must
 * give the printed value. Returns the number of such lines. */
static int check_written(const derived *d, const char *text) {
    int checked = 0;
    const mechanism *m = d->instance->mechanism;
    for (const char *at = strstr(text, "\n  "); (at = strstr(at, "] = ")) != NULL; at++) {
        const char *line = at;
        while (line[-1] != '\n') {
            line--;
        }
        char name[80];
        char set[300];
        const char *equals = strstr(line, " = ");
        snprintf(name, sizeof name, "%.*s", (int)(equals - line - 2), line + 2);
        const double value = strtod(equals + 3, NULL);
        const size_t length = strcspn(at + 4, ":\n");
        snprintf(set, sizeof set, "%s=%.*s", name, (int)length, at + 4);
        const char *sets[] = {set};
        const overrides changes = {.sets = sets, .set_count = 1};
        diags *errors = diags_new();
        instance *again = instance_make(m, d->instance->scene, &changes, errors);
        diags_flush(errors, stdout);
        TEST_ASSERT_NOT_NULL_MESSAGE(again, set);
        bool found = false;
        for (int i = 0; i < m->parameter_count; i++) {
            found = found || (strcmp(m->parameters[i]->name, name) == 0 &&
                              fabs(again->parameter[i] - value) <= 1e-15 * fabs(value));
        }
        for (int i = 0; i < m->input_count; i++) {
            found = found || (strcmp(m->inputs[i]->name, name) == 0 &&
                              fabs(again->input[i] - value) <= 1e-15 * fabs(value));
        }
        TEST_ASSERT_TRUE_MESSAGE(found, set);
        checked++;
        instance_free(again);
        diags_free(errors);
    }
    return checked;
}

static int written; /* number of values with a formula */

/* Compares the slopes dy(y) of a file with the lists of the image, at random states. Returns whether any state could
 * be compared. */
static bool compare_form(const char *name, derived *d, language form) {
    const equations *e = d->equations;
    char *text = printed(d, form);
    bool compared = false;
    uint64_t seed = OWN_SEED;
    check_head(d, text);
    written += form == OCTAVE ? check_written(d, text) : 0;
    for (int k = 0; k < 3; k++) {
        static named_file f;
        state_values s;
        double y[4 * UNKNOWNS];
        double slope[4 * UNKNOWNS] = {0};
        double result[RESULTS_MAX];
        int number = 0;
        TEST_ASSERT_TRUE_MESSAGE(d->image->list[IMAGE_BOOKS]->results <= RESULTS_MAX, name);
        random_state(&s, d, &seed);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        double largest = 0.0;
        for (int i = 0; i < e->count; i++) {
            largest = fmax(largest, isfinite(result[i]) ? fabs(result[i]) : (double)INFINITY);
        }
        if (!(largest < 1e12)) {
            continue; /* singular at this state */
        }
        for (int level = 0; level < 8; level++) {
            for (int i = 0; i < e->count; i++) {
                y[number] = s.value[i][level];
                number += e->unknowns[i].order > level;
            }
        }
        f.count = 0;
        f.y = y;
        run_named(name, text, &f, e->count, number, slope);
        compared = true;
        number = 0;
        for (int level = 0; level < 8; level++) {
            for (int i = 0; i < e->count; i++) {
                const bool highest = level + 1 == e->unknowns[i].order;
                if (e->unknowns[i].order > level) {
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(highest ? 1e-7 * largest : 0.0,
                                                      highest ? result[i] : s.value[i][level + 1],
                                                      slope[number++], name);
                }
            }
        }
    }
    free(text);
    return compared;
}

static bool compare_named(const char *name, derived *d) {
    return d->image->recovered == 0 && compare_form(name, d, FOLDED) &&
           compare_form(name, d, OCTAVE);
}

static int named_scene(const scene *s) {
    static char last[80];
    if (strcmp(last, s->mechanism->name) == 0) {
        return 0;
    }
    snprintf(last, sizeof last, "%s", s->mechanism->name);
    derived d = derived_surely(derived_builtin(s->name), s->name);
    const bool compared = compare_named(s->name, &d);
    derived_free(&d);
    return compared;
}

static int named_files;
static void named_mechanism(const char *name, derived *d) { named_files += compare_named(name, d); }

TEST(octave, both_forms_compute_the_same) {
    enum { MECHANISMS = 30 };
    int compared = 0;
    written = 0;
    const int scenes = each_builtin_scene(named_scene);
    each_mechanism(named_mechanism);
    printf("  %d scenes, %d files, %d values with their text\n", scenes, named_files, written);
    TEST_ASSERT_TRUE(scenes > 20 && named_files > 25 && written > 50);
    for (int i = 0; i < MECHANISMS; i++) {
        char text[MECHANISM_SIZE];
        mechanism_write((unsigned)i, (uint64_t)(OWN_SEED + i), text);
        derived d = derived_text(text);
        compared += d.image != NULL && compare_named(text, &d);
        derived_free(&d);
    }
    printf("  seed %d on: %d of %d mechanisms compared\n", OWN_SEED, compared, MECHANISMS);
    TEST_ASSERT_TRUE(10 * compared > 7 * MECHANISMS);
}

/* === suite latex_runs ========================================================================= */
/* The printed LaTeX must be the model that runs. At random states, the printed equations (latex_value()) are solved
 * for the highest derivatives. These, and the printed closed forms, are compared with the operation list in double.
 * The tolerance follows from the printed digits and from round-off, carried through the formulas and the inverse
 * matrix. Every built-in scene, tests/mechanisms and generated mechanisms are tested; PRINTED_MECHANISMS=N sets the
 * number of the latter. */

enum { LATEX_RUNS_STATES = 3, SEED = 78, LATEX_RUNS_RESULTS_MAX = 256 };

/* A value with a larger relative tolerance shows nothing and does not count as compared. */
#define TELLING 1e-6

/* Factor on the error bounds, because the slopes leave out products of errors. */
#define SLACK 2.0

typedef struct comparison {
    const char *name;
    const derived *of;
    const image *image;
    state_values s;
    double runs[UNKNOWNS]; /* highest derivatives by the operation list */
    double off[UNKNOWNS];  /* error bounds of the values */
    int asked;             /* number of highest derivatives, in all states */
    int compared;          /* number of values with a small tolerance */
    int closed;            /* compared values that come from closed forms */
    double nearest;        /* largest error, divided by its bound */
} comparison;

static int cases_compared;
static int cases_closed;
static int cases_asked;
static int cases_blocks;
static int cases_wide;
static double cases_nearest;

/* Is `name` the name with these letters and index? "theta" and "1" fit theta1 and theta_1; "mass" and "" fit mass. */
static bool is_called(const char *name, const char *stem, const char *index) {
    const size_t length = strlen(stem);
    const char *rest = name + length;
    return strncmp(name, stem, length) == 0 &&
           (strcmp(rest, index) == 0 ||
            (*rest == '_' && *index != '\0' && strcmp(rest + 1, index) == 0));
}

static bool symbol_here(void *context, const char *stem, const char *index, int primes,
                        latex_number *found) {
    const comparison *c = context;
    const mechanism *m = c->of->instance->mechanism;
    const equations *e = c->of->equations;
    const struct {
        const symbol **list;
        int count;
    } all[] = {{m->coordinates, m->coordinate_count},
               {m->parameters, m->parameter_count},
               {m->inputs, m->input_count}};
    int matches = 0;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < all[k].count; i++) {
            const symbol *s = all[k].list[i];
            if (!is_called(s->name, stem, index) || (k > 0 && primes > 0)) {
                continue;
            }
            matches++;
            *found = latex_constant(0.0, 0.0);
            if (k == 0 && primes == e->unknowns[i].order) {
                found->value[1 + i] = 1.0;
            } else {
                found->value[0] = state_value((void *)(uintptr_t)&c->s, s, primes);
            }
        }
    }
    for (int i = 0; i < m->let_count && primes == 0;
         i++) { /* check_lets() reads the lets' definitions */
        if (is_called(m->lets[i]->name, stem, index)) {
            const poly *value = poly_from_expr(e->algebra, m->lets[i]->value);
            void *s = (void *)(uintptr_t)&c->s;
            matches++;
            *found = latex_constant(poly_evaluate(value, state_value, s),
                                    1e-13 * poly_magnitude(value, state_value, s));
        }
    }
    return matches == 1;
}

static latex_number read_side(comparison *c, const char *text, const char **end) {
    const char *problem;
    const latex_number n = latex_value(text, end, &problem, symbol_here, c);
    if (problem != NULL) {
        printf("  %s: %s: %.60s\n", c->name, problem, *end);
    }
    TEST_ASSERT_NULL_MESSAGE(problem, problem != NULL ? problem : c->name);
    return n;
}

/* Reads "LEFT &= RIGHT \\". Returns the next line. */
static const char *read_line(comparison *c, const char *line, latex_number *left,
                             latex_number *right) {
    const char *end;
    *left = read_side(c, line, &end);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("&= ", end, 3, c->name);
    *right = read_side(c, end + 3, &end);
    end += strncmp(end, "\\\\", 2) == 0 ? 2 : 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE('\n', *end, c->name);
    return end + 1;
}

static bool hold_against(comparison *c, int i, double printed_value, double bound) {
    const double apart = fabs(printed_value - c->runs[i]);
    if (!isfinite(printed_value) || !(bound <= TELLING * fmax(fabs(c->runs[i]), 1e-3))) {
        return false;
    }
    if (!(apart <= bound)) {
        printf(
            "  %s: the highest derivative of %s is %.17g as printed, %.17g as it runs, known to %.2g\n",
            c->name, c->of->equations->unknowns[i].symbol->name, printed_value, c->runs[i], bound);
    }
    TEST_ASSERT_TRUE_MESSAGE(apart <= bound, c->name);
    c->nearest = fmax(c->nearest, apart > 0.0 ? apart / bound : 0.0);
    return true;
}

/* Compares A x = b with n printed lines "LEFT &= RIGHT". Returns the rest of the text. */
static const char *check_equations(comparison *c, const char *line) {
    const int n = c->of->equations->count;
    long double a[UNKNOWNS][UNKNOWNS];
    long double inverse[UNKNOWNS][UNKNOWNS];
    double b[UNKNOWNS];
    double off[UNKNOWNS]; /* bound on A x - b at the list's x */
    for (int i = 0; i < n; i++) {
        latex_number left;
        latex_number right;
        line = read_line(c, line, &left, &right);
        b[i] = right.value[0] - left.value[0];
        off[i] = left.off[0] + right.off[0] + DBL_EPSILON * fabs(b[i]);
        for (int j = 0; j < n; j++) {
            a[i][j] = (long double)(left.value[1 + j] - right.value[1 + j]);
            off[i] += (left.off[1 + j] + right.off[1 + j]) * fabs(c->runs[j]);
        }
    }
    for (int k = 0; k < n; k++) { /* column k of the inverse */
        long double m[UNKNOWNS][UNKNOWNS + 1];
        long double column[UNKNOWNS];
        for (int i = 0; i < n; i++) {
            memcpy(m[i], a[i], sizeof a[i]);
            m[i][n] = i == k ? 1.0L : 0.0L;
        }
        dense_solve(n, UNKNOWNS + 1, m[0], column);
        for (int i = 0; i < n; i++) {
            inverse[i][k] = column[i];
        }
    }
    for (int i = 0; i < n; i++) {
        double x = 0.0;
        double bound = c->off[i];
        for (int j = 0; j < n; j++) {
            double size = fabs(b[j]);
            for (int k = 0; k < n; k++) {
                size += fabs((double)a[j][k] * c->runs[k]);
            }
            x += (double)inverse[i][j] * b[j];
            bound += fabs((double)inverse[i][j]) * (off[j] + n * DBL_EPSILON * size);
        }
        c->asked++;
        c->compared += hold_against(c, i, x, SLACK * bound);
    }
    return line;
}

static void check_closed_forms(comparison *c, const char *line) {
    for (int i = 0; i < c->of->equations->count; i++) {
        latex_number left;
        latex_number right;
        line = read_line(c, line, &left, &right);
        for (int k = 0; k < LATEX_PLACES; k++) {
            TEST_ASSERT_TRUE_MESSAGE(left.value[k] == (k == 1 + i ? 1.0 : 0.0), c->name);
            TEST_ASSERT_TRUE_MESSAGE(k == 0 || right.value[k] == 0.0, c->name);
        }
        c->closed += hold_against(c, i, right.value[0], SLACK * (right.off[0] + c->off[i]));
    }
}

static void check_lets(comparison *c, const char *text) {
    const char *line = strstr(text, "% with\n\\begin{align}\n");
    line = line == NULL ? "\\end" : strchr(line + 7, '\n') + 1;
    while (strncmp(line, "\\end", 4) != 0) {
        latex_number left;
        latex_number right;
        line = read_line(c, line, &left, &right);
        TEST_ASSERT_TRUE_MESSAGE(
            fabs(left.value[0] - right.value[0]) <= SLACK * (left.off[0] + right.off[0]), c->name);
    }
}

/* Computes the highest derivatives at the state. Returns false if one of them is not finite. */
static bool run_there(comparison *c) {
    const image *im = c->image;
    const op_list *t = im->list[IMAGE_STEP];
    double result[LATEX_RUNS_RESULTS_MAX];
    double off[LATEX_RUNS_RESULTS_MAX];
    const derived moving = {.instance = c->of->instance,
                            .equations = c->of->equations,
                            .image = (image *)(uintptr_t)im};
    TEST_ASSERT_TRUE(t->results <= LATEX_RUNS_RESULTS_MAX);
    derived_run_known(t, &moving, &c->s, result, off);
    bool finite = true;
    for (int k = 0; k < t->results; k++) {
        for (int i = 0; i < im->count; i++) {
            const component slope_of =
                im->form == WH_SECOND_ORDER ? (component){0, 0} : image_component(im, k);
            const bool this_one =
                im->form == WH_SECOND_ORDER
                    ? im->place[i] == k
                    : slope_of.unknown == i && slope_of.primes + 1 == im->unknown[i].order;
            if (this_one) {
                c->runs[i] = result[k];
                c->off[i] = 0x1p-53 * off[k];
                finite = finite && fabs(result[k]) < 1e12;
            }
        }
    }
    return finite;
}

/* The text between begin{align} and end{align} must compile and fit the page. A long sine in nested parentheses
 * cannot be broken into lines, so a few generated equations may be wider. */
static void check_widths(const char *name, const char *text) {
    enum {
        LINE = 345,
        PAPER = 455
    }; /* widths in pt: a line of LaTeX's article, and A4 with margins of 1 inch */
    static const char begin[] = "\\begin{align}";
    for (const char *at = text; (at = strstr(at, begin)) != NULL;) {
        at += strlen(begin);
        const char *end = strstr(at, "\\end{align}");
        const char *where;
        char *block = strndup(at, (size_t)(end - at));
        TEST_ASSERT_NULL_MESSAGE(latex_problem(block, &where), name);
        const int width = latex_width(block);
        cases_wide += width > LINE;
        cases_blocks++;
        TEST_ASSERT_TRUE_MESSAGE(width <= PAPER, name);
        free(block);
    }
}

static int compare_all(const char *name, derived *d) {
    const equations *e = d->equations;
    if (e == NULL || e->count > UNKNOWNS) {
        return 0;
    }
    for (int i = 0; i < e->count; i++) {
        if (e->unknowns[i].order >= ORDERS_MAX) {
            return 0;
        }
    }
    diags *errors = diags_new();
    image *im = image_make(e, NULL, &plainly, IMAGE_TO_WRITE, errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(im, name);
    char *rows = printed(d, LATEX);
    check_widths(name, rows);
    if (!d->instance->mechanism->is_system) {
        char *steps = printed(d, LATEX_STEPS);
        check_widths(name, steps);
        free(steps);
    }
    char *text = latex_joined(rows);
    free(rows);
    TEST_ASSERT_NOT_NULL(text);
    comparison c = {.name = name, .of = d, .image = im};
    uint64_t seed = SEED;
    static const char begin[] = "\\begin{align}\n";
    for (int k = 0; k < LATEX_RUNS_STATES; k++) {
        random_state(&c.s, d, &seed);
        if (run_there(&c)) {
            const char *behind = check_equations(&c, strstr(text, begin) + strlen(begin));
            const char *closed = strstr(behind, begin);
            check_lets(&c, text);
            if (closed != NULL && strncmp(closed - 7, "% with\n", 7) != 0) {
                check_closed_forms(&c, closed + strlen(begin));
            }
        }
    }
    cases_asked += c.asked;
    cases_compared += c.compared;
    cases_closed += c.closed;
    cases_nearest = fmax(cases_nearest, c.nearest);
    free(text);
    image_free(im);
    diags_free(errors);
    return c.compared;
}

static void begin_cases(void) {
    cases_asked = cases_compared = cases_closed = cases_blocks = cases_wide = 0;
    cases_nearest = 0.0;
}

static void end_cases(void) {
    printf(
        "  seed %d: of %d highest derivatives %d compared, %d in closed form too; apart by at most %.2g of "
        "what they may be\n",
        SEED, cases_asked, cases_compared, cases_closed, cases_nearest);
    TEST_ASSERT_TRUE(10 * cases_compared >= 9 * cases_asked && cases_closed > 0);
    printf("  %d of %d blocks wider than a line\n", cases_wide, cases_blocks);
    TEST_ASSERT_TRUE(100 * cases_wide <= 2 * cases_blocks);
}

static int compare_scene(const scene *s) {
    derived d = derived_surely(derived_builtin(s->name), s->name);
    const int compared = compare_all(s->name, &d);
    derived_free(&d);
    return compared > 0;
}

TEST(latex_runs, scenes_match_their_latex) {
    begin_cases();
    TEST_ASSERT_TRUE(each_builtin_scene(compare_scene) > 60);
    end_cases();
    TEST_ASSERT_EQUAL_INT(0, cases_wide);
}

static int files;
static void compare_file(const char *name, derived *d) { files += compare_all(name, d) > 0; }

TEST(latex_runs, files_match_their_latex) {
    files = 0;
    begin_cases();
    each_mechanism(compare_file);
    TEST_ASSERT_TRUE(files > 25);
    end_cases();
    TEST_ASSERT_EQUAL_INT(0, cases_wide);
}

TEST(latex_runs, generated_mechanisms_match_their_latex) {
    const char *more = getenv("PRINTED_MECHANISMS");
    const int wanted = more != NULL ? (int)strtol(more, NULL, 10) : (int)usual_or(60, 20);
    int compared = 0;
    begin_cases();
    for (int i = 0; i < wanted; i++) {
        char text[MECHANISM_SIZE];
        mechanism_write((unsigned)i, (uint64_t)(SEED + i), text);
        derived d = derived_text(text);
        compared += compare_all(text, &d) > 0;
        derived_free(&d);
    }
    end_cases();
    TEST_ASSERT_TRUE(10 * compared >= 7 * wanted);
}
