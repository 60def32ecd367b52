/* test_algebra.c: the normal form of expressions. Equal expressions become one object, different ones do not.
 * Values, derivatives and substitutions of random expressions are compared with libm and difference quotients. */
#include "host/algebra/algebra.h"

#include "derived.h"

enum { FORM_SYMBOLS = 7, FORM_PRIMES = 3 };

/* The parameters n and a have the same number, but belong to different mechanisms. */
static const symbol form_symbols[FORM_SYMBOLS] = {
    {.kind = SYM_COORDINATE, .name = "q", .text = "", .unit = "", .index = 0},
    {.kind = SYM_COORDINATE, .name = "r", .text = "", .unit = "", .index = 1},
    {.kind = SYM_COORDINATE, .name = "s", .text = "", .unit = "", .index = 2},
    {.kind = SYM_PARAMETER, .name = "m", .text = "", .unit = "", .index = 0},
    {.kind = SYM_PARAMETER, .name = "n", .text = "", .unit = "", .index = 1},
    {.kind = SYM_INPUT, .name = "u", .text = "", .unit = "", .index = 0},
    {.kind = SYM_PARAMETER, .name = "a", .text = "", .unit = "", .index = 1},
};

static int form_place(const symbol *sym) { return (int)(sym - form_symbols); }

static int form_order(double x, double y) { return x < y ? -1 : x > y ? 1 : 0; }

static bool is_tame(const poly *p) {
    return poly_is_finite(p) && p->count <= 12 && p->size < 200.0;
}

static const poly *random_leaf(algebra *a, uint64_t *seed) {
    if (random_bits(seed) % 4 == 0) {
        return poly_number(a, (double)(random_bits(seed) % 13) / 4.0 - 1.5);
    }
    return poly_symbol(a, &form_symbols[random_bits(seed) % FORM_SYMBOLS],
                       (int)(random_bits(seed) % FORM_PRIMES));
}

/* A random expression with finite numbers and up to 12 terms. */
static const poly *form_random(algebra *a, uint64_t *seed, int depth) {
    static const double exponents[] = {-3.0, -2.0, -1.0, -0.5, 0.5, 1.5, 2.0, 3.0, 3.0, 4.0, 17.0};
    static const function_id functions[] = {FN_TAN,  FN_ATAN, FN_EXP, FN_ABS,
                                            FN_SIGN, FN_MIN,  FN_MAX, FN_ATAN2};
    if (depth == 0) {
        return random_leaf(a, seed);
    }
    const poly *x = form_random(a, seed, depth - 1);
    const poly *y = form_random(a, seed, depth - 1);
    const uint64_t draw = random_bits(seed);
    const function_id f = functions[(draw >> 16) % 8];
    const bool two = f == FN_MIN || f == FN_MAX || f == FN_ATAN2;
    const poly *p = x;
    switch (draw % 10) {
    case 0:
    case 1: p = poly_add(a, x, y); break;
    case 2: p = poly_sub(a, x, y); break;
    case 3:
    case 4: p = poly_mul(a, x, y); break;
    case 5: p = poly_pow(a, x, exponents[(draw >> 8) % 11]); break;
    case 6: p = poly_pow_poly(a, x, y); break;
    case 7: p = poly_sin(a, x); break;
    case 8: p = poly_cos(a, x); break;
    case 9: p = poly_call(a, f, x, two ? y : NULL); break;
    }
    return is_tame(p) ? p : random_leaf(a, seed);
}

/* === suite algebra ============================================================================ */

/* --- identities of expressions that are given as text --- */

typedef struct sides {
    bool same;     /* both sides are one object */
    bool expanded; /* the difference is zero after all powers have been expanded */
} sides;

/* Parses both sides as `let` statements and compares their normal forms. */
static sides compare(const char *left, const char *right) {
    char text[1024];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate a\ncoordinate b\ncoordinate x\ncoordinate y\n"
             "T = 1 [kg*m^2]*(a'^2 + b'^2 + x'^2 + y'^2)\n"
             "let left_side = %s\nlet right_side = %s\n",
             left, right);
    diags *all = diags_new();
    whirl_model *m = model_parse("identity", text, strlen(text), all);
    if (m == NULL) {
        diags_flush(all, stdout);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(m, left);
    algebra *a = algebra_new();
    const poly *p = poly_from_expr(a, m->mechanisms[0]->lets[0]->value);
    const poly *q = poly_from_expr(a, m->mechanisms[0]->lets[1]->value);
    const poly *apart = poly_expanded(a, poly_sub(a, p, q));
    const bool good = !algebra_overflow(a);
    const sides found = {p == q && good, poly_is_zero(apart) && good};
    algebra_free(a);
    model_free(m);
    diags_free(all);
    return found;
}

static bool same_form(const char *left, const char *right) { return compare(left, right).same; }

typedef struct pair {
    const char *left;
    const char *right;
} pair;

TEST(algebra, equal_expressions_are_one_object) {
    static const pair equal[] = {
        {"sin(a)^2 + cos(a)^2", "1"},
        {"sin(a)*sin(b)", "cos(a - b)/2 - cos(a + b)/2"},
        {"cos(a)*cos(b)", "cos(a - b)/2 + cos(a + b)/2"},
        {"sin(a)*cos(b)", "sin(a + b)/2 + sin(a - b)/2"},
        {"cos(a)*sin(b)", "sin(a + b)/2 - sin(a - b)/2"},
        {"sin(a)*cos(b) + cos(a)*sin(b)", "sin(a + b)"},
        {"cos(a)*cos(b) - sin(a)*sin(b)", "cos(b + a)"},
        {"2*sin(a)*cos(a)", "sin(2*a)"},
        {"cos(a)^2 - sin(a)^2", "cos(2*a)"},
        {"4*sin(a)^3", "3*sin(a) - sin(3*a)"},
        {"8*cos(a)^4", "3 + 4*cos(2*a) + cos(4*a)"},
        {"(sin(a)^2 + cos(a)^2)^5*x", "x"},
        {"sin(-a)", "-sin(a)"},
        {"cos(b - a)", "cos(a - b)"},
        {"sin(a)*sin(a + 0.25)", "cos(0.25)/2 - cos(2*a + 0.25)/2"},
        {"(x + y)^2 - x^2 - 2*x*y - y^2", "0"},
        {"(x + y)*(x - y)", "x^2 - y^2"},
        {"0.1*x + 0.2*x - 0.3*x", "0"},
        {"x/x + y/y", "2"},
        {"x/(2*x + 2*y)", "0.5*x/(x + y)"},
        {"1/(-x - y)", "-1/(y + x)"},
        {"sqrt(x + 1)*sqrt(x + 1)", "1 + x"},
        {"sqrt(4*x)", "2*sqrt(x)"},
        {"x^0.5*x^1.5", "x^2"},
        {"(x^2)^3", "x^6"},
        {"(2*x*y)^3", "8*x^3*y^3"},
        {"(x*cos(a))^-1*x", "1/cos(a)"},
        {"abs(x)^2", "x^2"},
        {"abs(x)*abs(x)", "x*x"},
        {"abs(x)^3", "x^2*abs(x)"},
        {"abs(x)^4", "x^4"},
        {"abs(x)^5", "x^4*abs(x)"},
        {"abs(x)^3*abs(x)^4", "x^6*abs(x)"},
        {"abs(x - y)^6", "(y - x)^6"},
        {"abs(x - y)^2", "x^2 - 2*x*y + y^2"},
        {"max(2, 3)*min(2, 3)*x", "6*x"},
        {"exp(0) + log(1) + atan2(0, 1)", "1"},
        {"x^y*x^y", "(x^y)^2"},
        {"(-x - y)^3", "-(y + x)^3"},
        {"(2*x - 2*y)^4", "16*(y - x)^4"},
        {"(3 - 2*x)^5", "-32*(x - 1.5)^5"},
        {"(x + y)^3*(x + y)^4", "(x + y)^7"},
        {"((x + y)^3)^2", "(x + y)^6"},
        {"(x + y)^3/(x + y)", "(x + y)^2"},
        {"(x + y)^4*(x + y)^-3", "x + y"},
        {"sqrt(x + y)^4", "x^2 + 2*x*y + y^2"},
        {"sqrt(x^2 + y^2)^6", "(y^2 + x^2)^3"},
        {"(x + y - x)^3", "y^3"},
    };
    for (size_t i = 0; i < sizeof equal / sizeof equal[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(same_form(equal[i].left, equal[i].right), equal[i].left);
    }
}

TEST(algebra, different_expressions_are_distinct) {
    static const pair different[] = {
        {"sqrt(x^2)", "x"},           {"sqrt(x^2)", "-x"},      {"abs(x)", "x"},
        {"(x^4)^0.25", "x"},          {"sqrt(x^4)", "-x^2"},    {"asin(sin(a))", "a"},
        {"atan2(y, x)", "atan(y/x)"}, {"log(x^2)", "2*log(x)"}, {"sqrt(x*y)", "sqrt(x)*sqrt(y)"},
        {"sqrt(-x)", "sqrt(x)"},      {"sin(a)", "a"},          {"max(x, y)", "min(x, y)"},
        {"(x^2)^y", "x^(3*y)"},       {"sin(a)", "cos(a)"},     {"sin(2*a)", "2*sin(a)"},
        {"1e-13*x + y", "y"},         {"abs(x)^3", "x^3"},      {"sign(x)*x", "x"},
    };
    for (size_t i = 0; i < sizeof different / sizeof different[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(same_form(different[i].left, different[i].right),
                                  different[i].left);
    }
}

/* The cube of a sum is not expanded. So equal expressions can have two forms, which poly_expanded() shows to be
 * equal. */
TEST(algebra, unexpanded_powers_are_equal_when_expanded) {
    static const pair equal[] = {
        {"(x - y)^3", "x^3 - 3*x^2*y + 3*x*y^2 - y^3"},
        {"(x + y)^4", "((x + y)^2)^2"},
        {"(x + 1)^4", "(x + 1)^3*(x + 1)"},
        {"((x + y)^3 + a)^2", "(x + y)^6 + 2*a*(x + y)^2*(x + y) + a^2"},
        {"exp((x + y)^3)", "exp(x^3 + 3*x*y*(x + y) + y^3)"},
        {"sin((x + y)^3)", "sin(x^3 + 3*x*y*(x + y) + y^3)"},
    };
    for (size_t i = 0; i < sizeof equal / sizeof equal[0]; i++) {
        const sides found = compare(equal[i].left, equal[i].right);
        TEST_ASSERT_FALSE_MESSAGE(found.same, equal[i].left);
        TEST_ASSERT_TRUE_MESSAGE(found.expanded, equal[i].left);
    }
    static const pair different[] = {{"(x - y)^3", "x^3 - y^3"}, {"(x + y)^4", "(x - y)^4"}};
    for (size_t i = 0; i < sizeof different / sizeof different[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(compare(different[i].left, different[i].right).expanded,
                                  different[i].left);
    }
}

enum { VARIABLES = 3, NODES = 64 };

/* An expression as a tree, which the test evaluates with libm and without the algebra. */
typedef struct node {
    expr_op op;
    function_id function;
    int variable;
    double number; /* value of EXPR_NUMBER, exponent of EXPR_POW */
    int left;
    int right;
} node;

typedef struct tree {
    node nodes[NODES];
    int count;
} tree;

static const symbol variables[VARIABLES] = {
    {.kind = SYM_COORDINATE, .name = "u", .text = "", .unit = "", .index = 0},
    {.kind = SYM_COORDINATE, .name = "v", .text = "", .unit = "", .index = 1},
    {.kind = SYM_COORDINATE, .name = "w", .text = "", .unit = "", .index = 2}};

static int grow(tree *t, uint64_t *seed, int depth) {
    static const expr_op inner[] = {EXPR_ADD, EXPR_SUB, EXPR_MUL,  EXPR_MUL,
                                    EXPR_DIV, EXPR_POW, EXPR_CALL, EXPR_CALL};
    static const double exponents[] = {-2.0, -1.0, -0.5, 0.5, 2.0, 3.0, 1.5, 4.0};
    node n = {
        .op = depth <= 0 ? EXPR_SYMBOL : inner[random_bits(seed) % 8], .left = -1, .right = -1};
    if (depth <= 0 && random_bits(seed) % 3 == 0) {
        n.op = EXPR_NUMBER;
        n.number = (double)(random_bits(seed) % 9) / 4.0 - 1.0;
    }
    n.variable = (int)(random_bits(seed) % VARIABLES);
    n.function = (function_id)(random_bits(seed) % FUNCTIONS);
    if (n.op == EXPR_POW) {
        n.number = exponents[random_bits(seed) % 8];
    }
    if (depth > 0) {
        n.left = grow(t, seed, depth - 1);
    }
    if (depth > 0 && n.op != EXPR_POW) {
        n.right = grow(t, seed, depth - 1);
    }
    TEST_ASSERT_TRUE(t->count < NODES);
    t->nodes[t->count] = n;
    return t->count++;
}

/* The result of one operation. NaN if a derivative is infinite, and on the branch cut of atan2. */
static double applied(const node *n, double a, double b, const double x[VARIABLES]) {
    const double none = (double)NAN;
    switch (n->op) {
    case EXPR_NUMBER: return n->number;
    case EXPR_SYMBOL: return x[n->variable];
    case EXPR_ADD: return a + b;
    case EXPR_SUB: return a - b;
    case EXPR_MUL: return a * b;
    case EXPR_DIV: return a / b;
    case EXPR_POW: return a == 0.0 ? none : pow(a, n->number);
    case EXPR_NEG: return -a;
    case EXPR_CALL: break;
    }
    switch (n->function) {
    case FN_SIN: return sin(a);
    case FN_COS: return cos(a);
    case FN_TAN: return tan(a);
    case FN_ASIN: return fabs(a) == 1.0 ? none : asin(a);
    case FN_ACOS: return fabs(a) == 1.0 ? none : acos(a);
    case FN_ATAN: return atan(a);
    case FN_ATAN2: return a == 0.0 ? none : atan2(a, b);
    case FN_SQRT: return a == 0.0 ? none : sqrt(a);
    case FN_EXP: return exp(a);
    case FN_LOG: return log(a);
    case FN_ABS: return fabs(a);
    case FN_SIGN: return (double)(a > 0.0) - (double)(a < 0.0);
    case FN_MIN: return fmin(a, b);
    case FN_MAX: return fmax(a, b);
    case FN_SINH: return sinh(a);
    case FN_COSH: return cosh(a);
    case FN_TANH: return tanh(a);
    }
    return none;
}

/* The value of a tree. NaN if any part is not finite, because 1/0 may have either sign in the normal form. */
static double value_of(const tree *t, int i, const double x[VARIABLES]) {
    const node *n = &t->nodes[i];
    const double a = n->left < 0 ? 0.0 : value_of(t, n->left, x);
    const double b = n->right < 0 ? 0.0 : value_of(t, n->right, x);
    const double value = applied(n, a, b, x);
    return isfinite(a) && isfinite(b) && isfinite(value) ? value : (double)NAN;
}

static const poly *poly_of(algebra *a, const tree *t, int i) {
    const node *n = &t->nodes[i];
    const poly *x = n->left < 0 ? NULL : poly_of(a, t, n->left);
    const poly *y = n->right < 0 ? NULL : poly_of(a, t, n->right);
    switch (n->op) {
    case EXPR_NUMBER: return poly_number(a, n->number);
    case EXPR_SYMBOL: return poly_symbol(a, &variables[n->variable], 0);
    case EXPR_ADD: return poly_add(a, x, y);
    case EXPR_SUB: return poly_sub(a, x, y);
    case EXPR_MUL: return poly_mul(a, x, y);
    case EXPR_DIV: return poly_mul(a, x, poly_pow(a, y, -1.0));
    case EXPR_POW: return poly_pow(a, x, n->number);
    case EXPR_NEG: return poly_scale(a, x, -1.0);
    case EXPR_CALL: break;
    }
    return poly_call(a, n->function, x, function_arguments(n->function) == 2 ? y : NULL);
}

static double variable_value(void *context, const symbol *sym, int primes) {
    (void)primes;
    return ((const double *)context)[sym->index];
}

/* Computes the value and the scale by which errors are judged: the value, or 1e6 times its change if a variable
 * changes by 1e-9, whichever is larger. Returns false if the value is not finite or not smooth around the point. */
static bool smooth_value(const tree *t, int top, const double at[VARIABLES], double *value,
                         double *scale) {
    *value = value_of(t, top, at);
    *scale = fabs(*value);
    for (int k = 0; k < 6; k++) {
        double near[VARIABLES] = {at[0], at[1], at[2]};
        near[k / 2] += k % 2 == 0 ? 1e-9 : -1e-9;
        const double v = value_of(t, top, near);
        if (!isfinite(v) || fabs(v - *value) > 1e-4 * (1.0 + fabs(*value))) {
            return false;
        }
        *scale = fmax(*scale, 1e6 * fabs(v - *value));
    }
    return isfinite(*value) && *scale < 1e6;
}

/* The derivative by a five-point central difference. Returns false if two spacings disagree, as they do near a kink
 * or a pole. */
static bool difference(const tree *t, int top, const double at[VARIABLES], int by, double *slope) {
    double estimate[2];
    for (int k = 0; k < 2; k++) {
        const double h = k == 0 ? 1e-3 : 5e-4;
        double v[4];
        for (int i = 0; i < 4; i++) {
            static const double steps[4] = {-2.0, -1.0, 1.0, 2.0};
            double x[VARIABLES] = {at[0], at[1], at[2]};
            x[by] += steps[i] * h;
            v[i] = value_of(t, top, x);
        }
        estimate[k] = (v[0] - 8.0 * v[1] + 8.0 * v[2] - v[3]) / (12.0 * h);
    }
    *slope = estimate[1];
    return isfinite(*slope) && fabs(estimate[0] - estimate[1]) <= 1e-8 * (1.0 + fabs(estimate[1]));
}

static const poly *replace_v(void *context, algebra *a, const symbol *sym, int primes) {
    (void)a;
    (void)primes;
    return sym == &variables[1] ? (const poly *)context : NULL;
}

typedef struct tally {
    int values;
    int slopes;
    int substitutions;
    int functions[FUNCTIONS];
} tally;

static void check_random(uint64_t *seed, int depth, tally *score) {
    algebra *a = algebra_new();
    tree t = {.count = 0};
    const int top = grow(&t, seed, depth);
    const poly *p = poly_of(a, &t, top);
    double at[VARIABLES];
    for (int k = 0; k < VARIABLES; k++) {
        at[k] = random_between(seed, -1.5, 1.5);
    }
    double value;
    double scale;
    if (!algebra_overflow(a) && smooth_value(&t, top, at, &value, &scale)) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * (1.0 + scale), value,
                                  poly_evaluate(p, variable_value, at));
        score->values++;
        for (int i = 0; i < t.count; i++) {
            score->functions[t.nodes[i].function] += t.nodes[i].op == EXPR_CALL;
        }
        for (int k = 0; k < VARIABLES; k++) {
            double slope;
            if (difference(&t, top, at, k, &slope)) {
                const poly *d = poly_derivative(a, p, &variables[k], 0);
                TEST_ASSERT_DOUBLE_WITHIN(1e-6 * (1.0 + scale + fabs(slope)), slope,
                                          poly_evaluate(d, variable_value, at));
                score->slopes++;
            }
        }
        /* substitutes w^2 - u/2 for v; for the expected value, v has the value of w^2 - u/2 */
        const poly *u = poly_symbol(a, &variables[0], 0);
        const poly *w = poly_symbol(a, &variables[2], 0);
        const poly *in = poly_sub(a, poly_mul(a, w, w), poly_scale(a, u, 0.5));
        const poly *s = poly_substitute(a, p, replace_v, (void *)(uintptr_t)in);
        double moved[VARIABLES] = {at[0], at[2] * at[2] - 0.5 * at[0], at[2]};
        if (!algebra_overflow(a) && smooth_value(&t, top, moved, &value, &scale)) {
            TEST_ASSERT_FALSE(poly_contains(s, &variables[1], 0));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * (1.0 + scale), value,
                                      poly_evaluate(s, variable_value, at));
            score->substitutions++;
        }
    }
    algebra_free(a);
}

TEST(algebra, random_expressions_their_derivatives_and_substitutions) {
    uint64_t seed = 20060412;
    tally score = {0};
    for (int i = 0; i < 6000; i++) {
        check_random(&seed, 2 + i % 4, &score);
    }
    printf("  %d values, %d derivatives, %d substitutions\n", score.values, score.slopes,
           score.substitutions);
    TEST_ASSERT_GREATER_THAN_INT(2000, score.values);
    TEST_ASSERT_GREATER_THAN_INT(4000, score.slopes);
    TEST_ASSERT_GREATER_THAN_INT(1500, score.substitutions);
    for (int f = 0; f < FUNCTIONS; f++) {
        TEST_ASSERT_GREATER_THAN_INT(100, score.functions[f]);
    }
}

/* === suite algebra_limits ===================================================================== */
/* The limits of host/algebra: the sizes up to which powers and products are expanded, cancellation, values that are
 * not numbers, magnitudes, powers of expressions, and determinants. */

static double value_of_symbol(void *context, const symbol *sym, int primes) {
    return ((const double *)context)[form_place(sym) * FORM_PRIMES + primes];
}

static void random_values(double at[FORM_SYMBOLS * FORM_PRIMES], uint64_t *seed) {
    for (int i = 0; i < FORM_SYMBOLS * FORM_PRIMES; i++) {
        at[i] = random_between(seed, 0.3, 1.6);
    }
}

/* The magnitude that poly.h defines, computed independently: the sum of the absolute terms, without sines and
 * cosines. For a power of a sum, the sum or its own magnitude counts, whichever is larger. */
static double expected_magnitude(const poly *p, double *at) {
    double sum = 0.0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double part = p->terms[i].coefficient;
        for (int k = 0; k < m->count; k++) {
            const mono_factor *f = &m->factors[k];
            algebra *a = algebra_new();
            double base = poly_evaluate(poly_of_atom(a, f->atom, 1.0), value_of_symbol, at);
            algebra_free(a);
            if (f->atom->kind == ATOM_GROUP && f->exponent > 0.0) {
                base = fmax(fabs(base), expected_magnitude(f->atom->argument[0], at));
            }
            part *= pow(fabs(base), f->exponent);
        }
        sum += fabs(part);
    }
    return sum;
}

TEST(algebra_limits, magnitudes_are_sums_of_sizes) {
    uint64_t seed = 97;
    int differing = 0;
    for (int i = 0; i < 1500; i++) {
        algebra *a = algebra_new();
        const poly *p = form_random(a, &seed, 1 + i % 4);
        double at[FORM_SYMBOLS * FORM_PRIMES];
        random_values(at, &seed);
        const double expected = expected_magnitude(p, at);
        const double value = poly_evaluate(p, value_of_symbol, at);
        if (isfinite(expected) && isfinite(value)) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-12 * expected, expected,
                                      poly_magnitude(p, value_of_symbol, at));
            TEST_ASSERT_TRUE(fabs(value) <= expected * (1.0 + 1e-12));
            differing += fabs(value) < 0.9 * expected;
        }
        algebra_free(a);
    }
    TEST_ASSERT_GREATER_THAN_INT(200, differing);
}

/* The exponent may be an expression, as in x^y. The other random expressions have only numbers as exponents. */
TEST(algebra_limits, powers_of_expressions_and_their_slopes) {
    uint64_t seed = 5;
    int slopes = 0;
    for (int i = 0; i < 600; i++) {
        algebra *a = algebra_new();
        const poly *base =
            poly_add(a, poly_symbol(a, &form_symbols[0], 0), form_random(a, &seed, 1));
        const poly *exponent =
            poly_add(a, poly_symbol(a, &form_symbols[i % 2], 0), form_random(a, &seed, 1));
        const poly *p = poly_mul(a, poly_pow_poly(a, base, exponent), form_random(a, &seed, 1));
        double at[FORM_SYMBOLS * FORM_PRIMES];
        random_values(at, &seed);
        const double b = poly_evaluate(base, value_of_symbol, at);
        const double e = poly_evaluate(exponent, value_of_symbol, at);
        if (b > 0.2 && fabs(e) < 5.0) {
            const poly *power = poly_pow_poly(a, base, exponent);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * (1.0 + pow(b, e)), pow(b, e),
                                      poly_evaluate(power, value_of_symbol, at));
            const double h = 1e-5;
            double v[2];
            for (int side = 0; side < 2; side++) {
                double near[FORM_SYMBOLS * FORM_PRIMES];
                memcpy(near, at, sizeof near);
                near[0] += side == 0 ? -h : h;
                v[side] = poly_evaluate(p, value_of_symbol, near);
            }
            const poly *d = poly_derivative(a, p, &form_symbols[0], 0);
            const double slope = (v[1] - v[0]) / (2.0 * h);
            if (isfinite(slope)) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-5 * (1.0 + fabs(slope) + fabs(v[0])), slope,
                                          poly_evaluate(d, value_of_symbol, at));
                slopes++;
            }
        }
        algebra_free(a);
    }
    TEST_ASSERT_GREATER_THAN_INT(200, slopes);
}

TEST(algebra_limits, non_finite_numbers_are_found) {
    algebra *a = algebra_new();
    const double none[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    const poly *q = poly_symbol(a, &form_symbols[0], 0);
    const poly *r = poly_symbol(a, &form_symbols[1], 0);
    for (int i = 0; i < 3; i++) {
        const poly *bad = poly_mul(a, q, poly_number(a, none[i]));
        const poly *sum = poly_add(a, r, bad);
        const poly *hidden[] = {bad,
                                sum,
                                poly_sin(a, sum),
                                poly_call(a, FN_EXP, sum, NULL),
                                poly_call(a, FN_ATAN2, r, sum),
                                poly_call(a, FN_ATAN2, sum, r),
                                poly_pow_poly(a, sum, r),
                                poly_pow_poly(a, r, sum),
                                poly_mul(a, r, poly_call(a, FN_TAN, sum, NULL)),
                                poly_add(a, r, poly_cos(a, sum))};
        for (size_t k = 0; k < sizeof hidden / sizeof hidden[0]; k++) {
            TEST_ASSERT_FALSE(poly_is_finite(hidden[k]));
        }
    }
    TEST_ASSERT_TRUE(poly_is_finite(a->zero));
    TEST_ASSERT_TRUE(poly_is_finite(poly_call(a, FN_ATAN2, poly_sin(a, q), poly_pow(a, r, 0.5))));
    algebra_free(a);
}

static double grown(folding *f, double number, double by) {
    (void)f;
    return number + by;
}

TEST(algebra_limits, numbers_change_and_zero_terms_vanish) {
    uint64_t seed = 11;
    for (int i = 0; i < 200; i++) {
        algebra *a = algebra_new();
        const poly *p = form_random(a, &seed, 3);
        const double by = p->count > 0 && i % 2 == 0 ? -p->terms[i % p->count].coefficient : 0.75;
        const poly *changed = poly_each_number(a, p, grown, by);
        int k = 0;
        for (int t = 0; t < p->count; t++) {
            if (p->terms[t].coefficient + by != 0.0) {
                TEST_ASSERT_TRUE(changed->terms[k].mono == p->terms[t].mono);
                TEST_ASSERT_TRUE(changed->terms[k].coefficient == p->terms[t].coefficient + by);
                k++;
            }
        }
        TEST_ASSERT_EQUAL_INT(k, changed->count);
        algebra_free(a);
    }
}

/* A sum of rates. Powers of such a sum are expanded. */
static const poly *sum_of_rates(algebra *a, symbol *rates, int count) {
    const poly *sum = poly_number(a, 0.0);
    for (int i = 0; i < count; i++) {
        rates[i] =
            (symbol){.kind = SYM_COORDINATE, .name = "v", .text = "", .unit = "", .index = i};
        sum = poly_add(a, sum, poly_symbol(a, &rates[i], 1));
    }
    TEST_ASSERT_EQUAL_INT(count, sum->count);
    return sum;
}

/* A power of a sum of rates is expanded if the result has up to 64 products. Of the powers of a sum of coordinates,
 * only the square is expanded. */
TEST(algebra_limits, powers_expand_up_to_a_size) {
    symbol rates[12];
    for (int count = 2; count <= 12; count++) {
        for (int exponent = 2; exponent <= 7; exponent++) {
            algebra *a = algebra_new();
            const poly *sum = sum_of_rates(a, rates, count);
            const poly *p = poly_pow(a, sum, exponent);
            /* C(count + exponent - 1, exponent), because equal products merge */
            double products = 1.0;
            double left = 1.0;
            for (int i = 0; i < exponent; i++) {
                products *= count;
                left *= (double)(count + i) / (i + 1);
            }
            TEST_ASSERT_EQUAL_INT(products <= 64.0 ? (int)lround(left) : 1, p->count);
            TEST_ASSERT_TRUE(p->keeps_powers == false);
            algebra_free(a);
        }
    }
    algebra *a = algebra_new();
    const poly *sum_of_places =
        poly_add(a, poly_symbol(a, &form_symbols[0], 0), poly_symbol(a, &form_symbols[1], 0));
    TEST_ASSERT_EQUAL_INT(3, poly_pow(a, sum_of_places, 2.0)->count);
    TEST_ASSERT_EQUAL_INT(1, poly_pow(a, sum_of_places, 3.0)->count);
    TEST_ASSERT_TRUE(poly_pow(a, sum_of_places, 3.0)->keeps_powers);
    TEST_ASSERT_EQUAL_INT(4, poly_expanded(a, poly_pow(a, sum_of_places, 3.0))->count);
    TEST_ASSERT_TRUE(poly_is_place(sum_of_places));
    /* a single symbol does not count as a sum */
    TEST_ASSERT_FALSE(poly_is_place(poly_symbol(a, &form_symbols[0], 0)));
    TEST_ASSERT_FALSE(
        poly_is_place(poly_add(a, sum_of_places, poly_symbol(a, &form_symbols[0], 1))));
    TEST_ASSERT_FALSE(poly_is_place(poly_add(a, sum_of_places, poly_sin(a, sum_of_places))));
    TEST_ASSERT_FALSE(
        poly_is_place(poly_add(a, sum_of_places, poly_call(a, FN_EXP, sum_of_places, NULL))));
    algebra_free(a);
}

/* A product of sums that would have more than 400000 terms is not expanded. */
TEST(algebra_limits, large_products_stay_products) {
    enum { MOST = 633 };
    static symbol rates[MOST];
    for (int count = MOST - 1; count <= MOST; count++) {
        algebra *a = algebra_new();
        const poly *left = sum_of_rates(a, rates, count);
        const poly *right = poly_sub(a, left, poly_scale(a, poly_symbol(a, &rates[0], 1), 2.0));
        const poly *p = poly_mul(a, left, right);
        TEST_ASSERT_FALSE(algebra_overflow(a));
        /* 632 * 632 = 399424 terms are allowed, 633 * 633 = 400689 are not */
        TEST_ASSERT_TRUE(count < MOST ? p->count > count : p->count == count);
        algebra_free(a);
    }
}

/* An expression with more than 10^6 leaves is reported as an overflow. */
TEST(algebra_limits, very_large_expressions_overflow) {
    algebra *a = algebra_new();
    const poly *p = poly_symbol(a, &form_symbols[0], 0);
    double last = 0.0;
    /* each round doubles the number of leaves */
    for (int i = 0; i < 40 && !algebra_overflow(a); i++) {
        last = p->size;
        p = poly_call(a, FN_ATAN2, p, poly_add(a, p, a->one));
    }
    TEST_ASSERT_TRUE(algebra_overflow(a));
    TEST_ASSERT_TRUE(last <= 1e6 && p->size > 1e6);
    TEST_ASSERT_TRUE(poly_is_zero(poly_mul(a, p, p)));
    TEST_ASSERT_TRUE(poly_is_zero(poly_derivative(a, p, &form_symbols[0], 0)));
    algebra_free(a);
}

/* The limit of work must not depend on the host. So each object counts with a fixed size, and each table entry with
 * 48 bytes. */
TEST(algebra_limits, work_count_is_host_independent) {
    algebra *a = algebra_new();
    enum { ATOM = 72 + 48, MONO = 48 + 48, POLY = 32 + 48, PART = 16, PAIR = 24 + 48, TERM = 2 };
    size_t before = a->work;
    const poly *q = poly_symbol(a, &form_symbols[0], 0);
    TEST_ASSERT_EQUAL_UINT64(ATOM + MONO + PART + POLY + PART, a->work - before);
    const poly *r = poly_symbol(a, &form_symbols[1], 0);
    before = a->work;
    poly_symbol(a, &form_symbols[1], 0); /* the symbol exists already: no work */
    TEST_ASSERT_EQUAL_UINT64(0, a->work - before);
    const poly *sum =
        poly_add(a, q, r); /* work for two operands of one term, and for a new sum of two terms */
    TEST_ASSERT_EQUAL_UINT64(4 * TERM + POLY + 2 * PART, a->work - before);
    before = a->work;
    /* work for a new product of two factors, for a sum of this one term, and for a table entry of the pair */
    const poly *product = poly_mul(a, q, r);
    TEST_ASSERT_EQUAL_UINT64(MONO + 2 * PART + POLY + PART + 2 * TERM + PAIR, a->work - before);
    before = a->work;
    TEST_ASSERT_TRUE(poly_mul(a, r, q) == product);
    TEST_ASSERT_EQUAL_UINT64(0, a->work - before);
    poly_each_number(a, sum, grown, 0.0); /* work for two terms, without a new object */
    TEST_ASSERT_EQUAL_UINT64(2 * TERM, a->work - before);
    algebra_free(a);
}

/* Each `let` of a chain uses the previous one twice and is evaluated once. Otherwise the 2^60 evaluations would
 * never end. */
TEST(algebra_limits, lets_are_evaluated_once) {
    enum { LETS = 60 };
    char text[8192];
    size_t length = (size_t)snprintf(text, sizeof text,
                                     "mechanism m\ncoordinate x\nT = 1 [kg*m^2]*x'^2\n"
                                     "let l0 = sin(x)\n");
    for (int i = 1; i <= LETS; i++) {
        length += (size_t)snprintf(text + length, sizeof text - length, "let l%d = (l%d + l%d)/2\n",
                                   i, i - 1, i - 1);
    }
    diags *all = diags_new();
    whirl_model *m = model_parse("lets", text, length, all);
    TEST_ASSERT_NOT_NULL(m);
    algebra *a = algebra_new();
    const mechanism *of = m->mechanisms[0];
    TEST_ASSERT_TRUE(poly_from_expr(a, of->lets[LETS]->value) ==
                     poly_from_expr(a, of->lets[0]->value));
    algebra_free(a);
    model_free(m);
    diags_free(all);
}

/* 0.1 + 0.2 - 0.3 counts as zero; a difference that is ten times larger does not. */
TEST(algebra_limits, cancellation_to_round_off_is_zero) {
    algebra *a = algebra_new();
    const poly *q = poly_symbol(a, &form_symbols[0], 0);
    const double sizes[] = {1e-30, 1.0, 3e20};
    for (int i = 0; i < 3; i++) {
        const poly *p = poly_scale(a, q, sizes[i]);
        TEST_ASSERT_TRUE(poly_is_zero(poly_sub(a, p, poly_scale(a, p, 1.0 + 4e-15))));
        TEST_ASSERT_TRUE(poly_is_zero(poly_sub(a, p, poly_scale(a, p, 1.0 - 4e-15))));
        TEST_ASSERT_FALSE(poly_is_zero(poly_sub(a, p, poly_scale(a, p, 1.0 + 4e-14))));
        TEST_ASSERT_FALSE(poly_is_zero(poly_sub(a, p, poly_scale(a, p, 1.0 - 4e-14))));
    }
    TEST_ASSERT_TRUE(isinf(coefficient_sum(NULL, (double)INFINITY, 1.0)));
    TEST_ASSERT_TRUE(isnan(coefficient_sum(NULL, (double)INFINITY, -(double)INFINITY)));
    algebra_free(a);
}

/* Multiplies a lower triangular matrix with ones on its diagonal by an upper one. The determinant is the product of
 * the upper diagonal. */
TEST(algebra_limits, determinants_of_products) {
    uint64_t seed = 3;
    for (int round = 0; round < 60; round++) {
        const int n = 1 + round % 5;
        const unsigned all = (1U << n) - 1;
        algebra *a = algebra_new();
        double part[25]; /* both triangular matrices, in one array */
        const poly *m[25];
        double wanted = 1.0;
        double value = 1e300;
        for (int k = 0; k < n * n; k++) {
            part[k] = (double)(random_bits(&seed) % 9) - 4.0;
            wanted *= k % (n + 1) == 0 ? part[k] : 1.0;
        }
        for (int k = 0; k < n * n; k++) {
            double sum = k / n <= k % n ? part[k] : 0.0;
            for (int i = 0; i < k / n && i <= k % n; i++) {
                sum += part[k / n * n + i] * part[i * n + k % n];
            }
            m[k] = poly_number(a, sum);
        }
        TEST_ASSERT_TRUE(poly_is_number(poly_determinant(a, m, n, all, all), &value));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted, value);
        algebra_free(a);
    }
}

/* === suite normal_form ======================================================================== */
/* The promises of poly.h, checked independently on random expressions: the sequence of terms and factors, the sizes,
 * one object for equal expressions, and a form that does not depend on earlier computations. WH_FORMS=N sets the
 * number of expressions. */

/* --- the sequence of terms and factors, as algebra.h describes it --- */

static int expected_poly_order(const poly *x, const poly *y);

static int expected_atom_order(const atom *x, const atom *y) {
    int order = form_order(x->kind, y->kind);
    if (order == 0 && x->kind == ATOM_SYMBOL) {
        order = form_order(x->primes, y->primes);
        order = order != 0 ? order : form_order(x->symbol->kind, y->symbol->kind);
        order = order != 0 ? order : form_order(x->symbol->index, y->symbol->index);
        return order != 0 ? order
                          : form_order((double)strcmp(x->symbol->name, y->symbol->name), 0.0);
    }
    order = order != 0 ? order : form_order(x->function, y->function);
    for (int i = 0; i < 2 && order == 0 && x->argument[i] != NULL; i++) {
        order = expected_poly_order(x->argument[i], y->argument[i]);
    }
    return order;
}

static int expected_mono_order(const mono *x, const mono *y) {
    int order = form_order(x->count, y->count);
    for (int i = 0; i < x->count && order == 0; i++) {
        order = expected_atom_order(x->factors[i].atom, y->factors[i].atom);
        order = order != 0 ? order : form_order(x->factors[i].exponent, y->factors[i].exponent);
    }
    order = order != 0 ? order : form_order(x->trig, y->trig);
    return order != 0 || x->angle == NULL ? order : expected_poly_order(x->angle, y->angle);
}

static int expected_poly_order(const poly *x, const poly *y) {
    int order = 0;
    for (int i = 0; i < x->count && i < y->count && order == 0; i++) {
        order = expected_mono_order(x->terms[i].mono, y->terms[i].mono);
        order = order != 0 ? order : form_order(x->terms[i].coefficient, y->terms[i].coefficient);
    }
    return order != 0 ? order : form_order(x->count, y->count);
}

typedef struct known {
    uint64_t symbols;
    double size;
    bool keeps_powers;
    bool contains[FORM_SYMBOLS][FORM_PRIMES];
} known;

static void walk_poly(const poly *p, known *all);

static void walk_atom(const atom *x, known *all) {
    if (x->kind == ATOM_SYMBOL) {
        all->symbols |= symbol_bit(x->symbol, x->primes);
        all->size += 1.0;
        all->contains[form_place(x->symbol)][x->primes] = true;
        return;
    }
    all->size += 1.0;
    for (int i = 0; i < 2 && x->argument[i] != NULL; i++) {
        walk_poly(x->argument[i], all);
    }
}

static void walk_poly(const poly *p, known *all) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        all->size += 1.0;
        if (m->angle != NULL) {
            walk_poly(m->angle, all);
        }
        for (int k = 0; k < m->count; k++) {
            const mono_factor *f = &m->factors[k];
            const bool whole = f->exponent == floor(f->exponent) && f->exponent > 1.0;
            all->keeps_powers =
                all->keeps_powers || (f->atom->kind == ATOM_GROUP && whole &&
                                      pow(f->atom->argument[0]->count, f->exponent) <= 64.0);
            walk_atom(f->atom, all);
        }
    }
}

static void check_knowledge(const poly *p) {
    known all = {0};
    walk_poly(p, &all);
    TEST_ASSERT_TRUE(p->symbols == all.symbols);
    TEST_ASSERT_TRUE(p->size == all.size);
    TEST_ASSERT_TRUE(p->keeps_powers == all.keeps_powers);
    for (int s = 0; s < FORM_SYMBOLS; s++) {
        bool any = false;
        for (int primes = 0; primes < FORM_PRIMES; primes++) {
            const bool inside = all.contains[s][primes];
            any = any || inside;
            TEST_ASSERT_TRUE(poly_contains(p, &form_symbols[s], primes) == inside);
            TEST_ASSERT_TRUE(!inside || poly_may_contain(p, &form_symbols[s], primes));
        }
        TEST_ASSERT_TRUE(poly_contains(p, &form_symbols[s], -1) == any);
    }
}

static void check_form(const poly *p);

static void check_factor(const mono_factor *f) {
    const atom *x = f->atom;
    TEST_ASSERT_TRUE(fabs(f->exponent) >= 1e-12);
    if (x->kind == ATOM_SYMBOL) {
        return;
    }
    check_form(x->argument[0]);
    double value;
    if (x->kind == ATOM_POWER) {
        check_form(x->argument[1]);
        TEST_ASSERT_FALSE(poly_is_number(x->argument[1], &value));
    } else if (x->kind == ATOM_GROUP) {
        TEST_ASSERT_TRUE(f->exponent != 1.0);
        TEST_ASSERT_FALSE(poly_is_number(x->argument[0], &value));
    } else if (x->function == FN_ABS) {
        TEST_ASSERT_TRUE(f->exponent < 2.0); /* |p|^2 must have become p^2 */
    }
}

static void check_form(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        TEST_ASSERT_TRUE(p->terms[i].coefficient != 0.0);
        TEST_ASSERT_TRUE(i == 0 || expected_mono_order(p->terms[i - 1].mono, m) < 0);
        TEST_ASSERT_TRUE((m->trig == TRIG_NONE) == (m->angle == NULL));
        if (m->angle != NULL) { /* sin(-x) must have become -sin(x) */
            double value;
            TEST_ASSERT_FALSE(poly_is_number(m->angle, &value));
            TEST_ASSERT_TRUE(m->angle->terms[0].coefficient > 0.0);
            check_form(m->angle);
        }
        for (int k = 0; k < m->count; k++) {
            check_factor(&m->factors[k]);
            TEST_ASSERT_TRUE(k == 0 ||
                             expected_atom_order(m->factors[k - 1].atom, m->factors[k].atom) < 0);
        }
    }
}

/* A copy of an expression must be the same object as the expression. */
static void check_interned(algebra *a, const poly *p) {
    poly *copy = poly_scratch(p->count);
    copy->count = p->count;
    memcpy(copy->terms, p->terms, (size_t)p->count * sizeof p->terms[0]);
    TEST_ASSERT_TRUE(poly_intern(a, copy) == p);
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        TEST_ASSERT_TRUE(mono_make(a, m->factors, m->count, m->trig, m->angle) == m);
    }
    if (p->count > 0) { /* a different expression must be another object */
        copy->terms[p->count - 1].coefficient *= 2.0;
        TEST_ASSERT_TRUE(poly_intern(a, copy) != p);
        copy->terms[p->count - 1] = p->terms[p->count - 1];
        copy->count--;
        TEST_ASSERT_TRUE(poly_intern(a, copy) != p);
    }
    free(copy);
}

static int forms(void) {
    const char *wanted = getenv("WH_FORMS");
    return wanted != NULL ? (int)strtol(wanted, NULL, 10) : 3000;
}

TEST(normal_form, random_expressions_have_normal_form) {
    uint64_t seed = 20061122;
    printf("  %d expressions, seed %" PRIu64 "\n", forms(), seed);
    int seen[4] = {0};
    int kept = 0;
    int waves = 0;
    algebra *a = NULL;
    for (int i = 0; i < forms(); i++) {
        if (i % 100 == 0) {
            algebra_free(a);
            a = algebra_new();
        }
        const poly *p = form_random(a, &seed, 1 + i % 5);
        check_form(p);
        check_knowledge(p);
        check_interned(a, p);
        kept += p->keeps_powers;
        for (int t = 0; t < p->count; t++) {
            waves += p->terms[t].mono->trig != TRIG_NONE;
            for (int k = 0; k < p->terms[t].mono->count; k++) {
                seen[p->terms[t].mono->factors[k].atom->kind]++;
            }
        }
    }
    TEST_ASSERT_FALSE(algebra_overflow(a));
    algebra_free(a);
    for (int k = 0; k < 4; k++) {
        TEST_ASSERT_GREATER_THAN_INT(forms() / 30, seen[k]);
    }
    TEST_ASSERT_GREATER_THAN_INT(forms() / 200, kept);
    TEST_ASSERT_GREATER_THAN_INT(forms() / 20, waves);
}

TEST(normal_form, order_of_arguments_changes_nothing) {
    uint64_t seed = 31;
    for (int i = 0; i < 400; i++) {
        algebra *a = algebra_new();
        const poly *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = form_random(a, &seed, 1 + i % 4);
        }
        TEST_ASSERT_TRUE(poly_add(a, p[0], p[1]) == poly_add(a, p[1], p[0]));
        TEST_ASSERT_TRUE(poly_mul(a, p[0], p[1]) == poly_mul(a, p[1], p[0]));
        TEST_ASSERT_TRUE(poly_is_zero(poly_sub(a, p[0], p[0])));
        TEST_ASSERT_TRUE(poly_scale(a, poly_scale(a, p[0], -8.0), -0.125) == p[0]);
        TEST_ASSERT_TRUE(poly_sub(a, p[0], p[1]) == poly_add(a, p[0], poly_scale(a, p[1], -1.0)));
        for (int k = 0; k < 3; k++) {
            for (int m = 0; m < 3; m++) {
                const int order = poly_order(p[k], p[m]);
                TEST_ASSERT_TRUE(form_order(order, 0) == expected_poly_order(p[k], p[m]));
                TEST_ASSERT_TRUE((order == 0) == (p[k] == p[m]));
            }
        }
        algebra_free(a);
    }
}

static void write_poly(FILE *out, const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        fprintf(out, "%+a", p->terms[i].coefficient);
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            fprintf(out, "*%d:%s'%d:%d(", (int)x->kind,
                    x->kind == ATOM_SYMBOL ? x->symbol->name : "", x->primes, (int)x->function);
            for (int j = 0; j < 2 && x->kind != ATOM_SYMBOL && x->argument[j] != NULL; j++) {
                write_poly(out, x->argument[j]);
                fputc(';', out);
            }
            fprintf(out, ")^%a", m->factors[k].exponent);
        }
        if (m->angle != NULL) {
            fprintf(out, "*%d(", (int)m->trig);
            write_poly(out, m->angle);
            fputc(')', out);
        }
    }
}

static char *written(const poly *p) {
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    write_poly(out, p);
    fclose(out);
    return text;
}

TEST(normal_form, form_is_independent_of_earlier_expressions) {
    for (uint64_t number = 1; number <= 300; number++) {
        algebra *fresh = algebra_new();
        algebra *used = algebra_new();
        uint64_t other = number * 77;
        for (int i = 0; i < 4; i++) {
            form_random(used, &other, 4);
        }
        for (int s = FORM_SYMBOLS - 1; s >= 0; s--) {
            poly_symbol(used, &form_symbols[s], s % FORM_PRIMES);
        }
        uint64_t first = number;
        uint64_t second = number;
        char *left = written(form_random(fresh, &first, 4));
        char *right = written(form_random(used, &second, 4));
        TEST_ASSERT_EQUAL_STRING(left, right);
        free(left);
        free(right);
        algebra_free(fresh);
        algebra_free(used);
    }
}
