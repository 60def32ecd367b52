#include "expressions.h"

#include "derived.h"

typedef struct writer {
    const expression_names *names;
    int tame;
    uint64_t *seed;
    char *text;
    size_t size;
    size_t at;
} writer;

static unsigned draw(writer *w, unsigned bound) { return (unsigned)(random_bits(w->seed) % bound); }

static void put(writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(writer *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(w->text + w->at, w->size - w->at, format, arguments);
    va_end(arguments);
    w->at += (size_t)length;
    TEST_ASSERT_TRUE_MESSAGE(w->at < w->size, "a longer buffer is needed");
}

static void leaf(writer *w) {
    static const char *const numbers[] = {"2",    "3",    "0.5",     "1.5", "0.1", "7",
                                          "0.05", "0.37", "12.0625", "25",  "1",   "2.718281828"};
    const expression_names *n = w->names;
    switch (draw(w, n->rates ? 6 : 5)) {
    case 0: put(w, "%s", numbers[draw(w, sizeof numbers / sizeof numbers[0])]); break;
    case 5: put(w, "(%s'*1 [s])", n->coordinates[draw(w, (unsigned)n->coordinate_count)]); break;
    case 1:
    case 2: put(w, "%s", n->coordinates[draw(w, (unsigned)n->coordinate_count)]); break;
    default: put(w, "%s", n->constants[draw(w, (unsigned)n->constant_count)]); break;
    }
}

static void expression(writer *w, int depth);

/* Writes the base of a power, a root or a logarithm. If `tame`, the base is positive. */
static void base(writer *w, int depth) {
    switch (draw(w, w->tame ? 5 : 9)) {
    case 0:
        put(w, "(1.5 + sin(");
        expression(w, depth - 1);
        put(w, "))");
        break;
    case 1:
        put(w, "abs(");
        expression(w, depth - 1);
        put(w, ")");
        break;
    case 2: put(w, "%s", w->names->constants[draw(w, (unsigned)w->names->constant_count)]); break;
    case 3: put(w, "%u", 2 + draw(w, 20)); break;
    case 4:
        put(w, "(exp(sin(");
        expression(w, depth - 1);
        put(w, ")))");
        break;
    case 5:
        put(w, "(-");
        expression(w, depth - 1);
        put(w, ")");
        break;
    default: expression(w, depth - 1); break;
    }
}

static void exponent(writer *w, int depth) {
    static const char *const fixed[] = {
        "2",   "3",   "4",      "(-1)",  "(-2)", "0.5",     "(-0.5)", "(1/3)", "(-2/7)",
        "1.5", "2.3", "(-1.7)", "(1/2)", "1e-3", "1.23e-7", "3.0001", "(9/8)", "0.123456789"};
    switch (draw(w, 6)) {
    case 0:
    case 1: put(w, "%s", fixed[draw(w, sizeof fixed / sizeof fixed[0])]); break;
    case 2: put(w, "%s", w->names->constants[draw(w, (unsigned)w->names->constant_count)]); break;
    case 3:
        put(w, "(-%s)", w->names->constants[draw(w, (unsigned)w->names->constant_count)]);
        break;
    case 4:
        put(w, "sin(");
        expression(w, depth - 1);
        put(w, ")");
        break;
    default: expression(w, depth - 1); break;
    }
}

static void call(writer *w, int depth) {
    static const char *const any[] = {"sin", "cos",  "atan", "abs",  "sign",
                                      "tan", "tanh", "exp",  "sinh", "cosh"};
    const unsigned any_count = sizeof any / sizeof any[0];
    static const char *const two[] = {"atan2", "min", "max"};
    static const char *const positive[] = {"sqrt", "log"};
    static const char *const small[] = {"asin", "acos"};
    const unsigned which = draw(w, any_count + 7);
    if (which < any_count) {
        put(w, w->tame && which >= 7 ? "%s(sin(" : "%s((", any[which]);
        expression(w, depth - 1);
        put(w, "))");
    } else if (which < any_count + 3) {
        put(w, "%s(", two[which - any_count]);
        expression(w, depth - 1);
        put(w, ", ");
        expression(w, depth - 1);
        put(w, ")");
    } else if (which < any_count + 5) {
        put(w, "%s(", positive[which - any_count - 3]);
        base(w, depth - 1);
        put(w, ")");
    } else {
        put(w, "%s(%s(", small[which - any_count - 5], draw(w, 2) == 0 ? "0.9*sin" : "0.9*cos");
        expression(w, depth - 1);
        put(w, "))");
    }
}

static void expression(writer *w, int depth) {
    if (depth <= 0) {
        leaf(w);
        return;
    }
    const unsigned which = draw(w, 12);
    if (which < 6) {
        put(w, "(");
        expression(w, depth - 1);
        put(w, " %c ", "+-*/+*"[which]);
        if (which == 3 && w->tame) {
            base(w, depth - 1);
        } else {
            expression(w, depth - 1);
        }
        put(w, ")");
    } else if (which < 9) {
        put(w, "(");
        base(w, depth);
        put(w, ")^(");
        exponent(w, depth);
        put(w, ")");
    } else if (which == 9) {
        put(w, "(-");
        expression(w, depth - 1);
        put(w, ")");
    } else {
        call(w, depth);
    }
}

void expression_write(const expression_names *names, int depth, int tame, uint64_t *seed,
                      char *text, size_t size) {
    writer w = {names, tame, seed, text, size, 0};
    text[0] = '\0';
    expression(&w, depth);
}

/* Writes `text` and replaces each %e by a random expression of the names in `names`. */
static void filled(writer *w, const expression_names *names, const char *text, int depth) {
    for (; *text != '\0'; text++) {
        if (text[0] == '%' && text[1] == 'e') {
            w->names = names;
            expression(w, depth);
            text++;
        } else {
            put(w, "%c", *text);
        }
    }
}

void expression_mechanism(int depth, uint64_t *seed, char *text, size_t size) {
    static const char *const own[] = {"theta1", "x"};
    static const char *const all[] = {"a1", "n_1", "mass_of_it", "Omega_", "x__2", "y1"};
    /* without inputs, which would make the inertia change with time */
    const expression_names constant = {own, 2, 0, all, 3};
    const expression_names still = {own, 2, 0, all, 6};
    const expression_names force = {own, 2, 1, all, 6};
    writer w = {&still, 1, seed, text, size, 0};
    put(&w, "mechanism m\nparameter a1 = 0.8\nparameter n_1 = 2.5\nparameter mass_of_it = 1.3\n"
            "input Omega_ = 1.2\ninput x__2 = 0.4\ninput y1 = 3\n");
    if (draw(&w, 3) == 0) {
        put(&w, "state theta1\nstate x\n");
        filled(&w, &still, "equation 1 [s^2]*theta1''*(2.5 + sin(%e)) + 1 [s]*x'*cos(%e) = %e\n",
               depth);
        filled(&w, &still, "equation 1 [s]*x'*(3 + sin(%e)) = %e - 1 [s]*theta1'\n", depth);
    } else {
        put(&w, "coordinate theta1\ncoordinate x\n");
        filled(
            &w, &constant,
            "T = 1 [kg*m^2]*((2.5 + sin(%e))*theta1'^2 + cos(%e)*theta1'*x' + (3 + cos(%e))*x'^2)\n",
            depth - 1);
        filled(&w, &still, "V = 1 [J]*(%e)\n", depth);
        filled(&w, &force, "Q(theta1) = 1 [N*m]*(%e)\n", depth);
    }
}
