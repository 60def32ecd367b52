/* test_algebra.c: the normal form: what is equal becomes the same object, what is not stays apart,
 * and values, derivatives and substitutions are right for random expressions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/algebra/algebra.h"
#include "unity.h"

void suite_algebra(void);

/* --- identities, as text -------------------------------------------------------------------------*/

typedef struct sides {
    bool same;     /* one object */
    bool expanded; /* their difference is zero once kept powers are multiplied out */
} sides;

/* Parses both sides as `let`s and compares their normal forms. */
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

static void test_equal_expressions_are_one_object(void) {
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

static void test_what_differs_somewhere_stays_apart(void) {
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

/* A cube of a sum stays one. What is equal only when it is multiplied out is told by poly_expanded(). */
static void test_kept_powers_are_equal_when_expanded(void) {
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

/* --- random expressions --------------------------------------------------------------------------*/

enum { VARIABLES = 3, NODES = 64 };

/* A tree with its own meaning, computed with libm, independent of the algebra. */
typedef struct node {
    expr_op op;
    function_id function;
    int variable;
    double number; /* also the exponent of EXPR_POW */
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

/* NaN also where a derivative is infinite, and where atan2 has its cut. */
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

/* NaN as soon as anything inside is not finite: 1/0 may have either sign in the normal form. */
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

/* A number to judge differences by: what was lost to cancellation shows as a jump between neighbours.
 * False where the expression has no smooth finite value around the point. */
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

/* Five-point central difference; false where two spacings do not agree (a kink, a pole near by). */
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
        /* v := w^2 - u/2, then the value where v has that value */
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

static void test_random_expressions_their_derivatives_and_substitutions(void) {
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

void suite_algebra(void) {
    RUN_TEST(test_equal_expressions_are_one_object);
    RUN_TEST(test_what_differs_somewhere_stays_apart);
    RUN_TEST(test_kept_powers_are_equal_when_expanded);
    RUN_TEST(test_random_expressions_their_derivatives_and_substitutions);
}
