/* test_algebra_limits.c: what host/algebra takes on and what it leaves: sizes up to which powers and products are
 * multiplied out, what cancels, numbers that are none; magnitudes, powers of expressions and determinants. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "forms.h"

#include "unity.h"

void suite_algebra_limits(void);

/* --- values -------------------------------------------------------------------------------------------- */

static double value_of_symbol(void *context, const symbol *sym, int primes) {
    return ((const double *)context)[form_place(sym) * FORM_PRIMES + primes];
}

static void random_values(double at[FORM_SYMBOLS * FORM_PRIMES], uint64_t *seed) {
    for (int i = 0; i < FORM_SYMBOLS * FORM_PRIMES; i++) {
        at[i] = random_between(seed, 0.3, 1.6);
    }
}

/* As poly.h says, written down once more: each term's size, without its sine; a power of a sum by the larger of the
 * sum and its parts. */
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

static void test_magnitudes_are_sums_of_sizes(void) {
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

/* x^y and the like: the random expressions of test_algebra.c have powers of numbers only. */
static void test_powers_of_expressions_and_their_slopes(void) {
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

static void test_a_number_that_is_none_is_seen_wherever_it_is(void) {
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

static double grown(double number, double by) { return number + by; }

static void test_each_number_is_changed_and_those_that_vanish_go(void) {
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

/* --- limits -------------------------------------------------------------------------------------------- */

/* A sum of so many rates, which no power keeps whole. */
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

/* Powers of a sum are multiplied out while that has at most 64 products; positions' only squares. */
static void test_powers_are_multiplied_out_up_to_a_size(void) {
    symbol rates[12];
    for (int count = 2; count <= 12; count++) {
        for (int exponent = 2; exponent <= 7; exponent++) {
            algebra *a = algebra_new();
            const poly *sum = sum_of_rates(a, rates, count);
            const poly *p = poly_pow(a, sum, exponent);
            double products =
                1.0; /* of equal ones: (count + exponent - 1 over exponent) are left */
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
    TEST_ASSERT_FALSE(poly_is_place(poly_symbol(a, &form_symbols[0], 0))); /* no sum */
    TEST_ASSERT_FALSE(
        poly_is_place(poly_add(a, sum_of_places, poly_symbol(a, &form_symbols[0], 1))));
    TEST_ASSERT_FALSE(poly_is_place(poly_add(a, sum_of_places, poly_sin(a, sum_of_places))));
    TEST_ASSERT_FALSE(
        poly_is_place(poly_add(a, sum_of_places, poly_call(a, FN_EXP, sum_of_places, NULL))));
    algebra_free(a);
}

/* Sums whose product would have more than 400000 terms are multiplied as wholes, and the value is the same. */
static void test_large_products_stay_products(void) {
    enum { MOST = 633 };
    static symbol rates[MOST];
    for (int count = MOST - 1; count <= MOST; count++) {
        algebra *a = algebra_new();
        const poly *left = sum_of_rates(a, rates, count);
        const poly *right = poly_sub(a, left, poly_scale(a, poly_symbol(a, &rates[0], 1), 2.0));
        const poly *p = poly_mul(a, left, right);
        TEST_ASSERT_FALSE(algebra_overflow(a));
        /* 632 * 632 = 399424; 633 * 633 = 400689 */
        TEST_ASSERT_TRUE(count < MOST ? p->count > count : p->count == count);
        algebra_free(a);
    }
}

/* What is too large is given up on, and said so: 10^6 leaves. */
static void test_what_grows_without_end_overflows(void) {
    algebra *a = algebra_new();
    const poly *p = poly_symbol(a, &form_symbols[0], 0);
    double last = 0.0;
    for (int i = 0; i < 40 && !algebra_overflow(a); i++) { /* twice the leaves in each round */
        last = p->size;
        p = poly_call(a, FN_ATAN2, p, poly_add(a, p, a->one));
    }
    TEST_ASSERT_TRUE(algebra_overflow(a));
    TEST_ASSERT_TRUE(last <= 1e6 && p->size > 1e6);
    TEST_ASSERT_TRUE(poly_is_zero(poly_mul(a, p, p)));
    TEST_ASSERT_TRUE(poly_is_zero(poly_derivative(a, p, &form_symbols[0], 0)));
    algebra_free(a);
}

/* What is given up on must not depend on the host: objects count for fixed sizes, with 48 bytes in tables. */
static void test_work_is_counted_alike_on_every_host(void) {
    algebra *a = algebra_new();
    enum { ATOM = 72 + 48, MONO = 48 + 48, POLY = 32 + 48, PART = 16, PAIR = 24 + 48, TERM = 2 };
    size_t before = a->work;
    const poly *q = poly_symbol(a, &form_symbols[0], 0);
    TEST_ASSERT_EQUAL_UINT64(ATOM + MONO + PART + POLY + PART, a->work - before);
    const poly *r = poly_symbol(a, &form_symbols[1], 0);
    before = a->work;
    poly_symbol(a, &form_symbols[1], 0); /* known */
    TEST_ASSERT_EQUAL_UINT64(0, a->work - before);
    const poly *sum = poly_add(a, q, r); /* two terms handled, a new sum of two */
    TEST_ASSERT_EQUAL_UINT64(2 * TERM + POLY + 2 * PART, a->work - before);
    before = a->work;
    const poly *product =
        poly_mul(a, q, r); /* asked for and remembered, added up as a row of one */
    TEST_ASSERT_EQUAL_UINT64(MONO + 2 * PART + POLY + PART + 2 * TERM + PAIR, a->work - before);
    before = a->work;
    TEST_ASSERT_TRUE(poly_mul(a, r, q) == product);
    TEST_ASSERT_EQUAL_UINT64(0, a->work - before);
    poly_each_number(a, sum, grown, 0.0); /* two terms handled, nothing new */
    TEST_ASSERT_EQUAL_UINT64(2 * TERM, a->work - before);
    algebra_free(a);
}

/* A row of lets, each naming the one before twice, is worked out once each: two to the sixtieth would not end. */
static void test_lets_are_worked_out_once(void) {
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

/* 0.1 + 0.2 - 0.3 is zero; a ten times larger rest is not. */
static void test_what_cancels_to_a_rounding_error_is_zero(void) {
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
    TEST_ASSERT_TRUE(isinf(coefficient_sum((double)INFINITY, 1.0)));
    TEST_ASSERT_TRUE(isnan(coefficient_sum((double)INFINITY, -(double)INFINITY)));
    algebra_free(a);
}

/* --- determinants --------------------------------------------------------------------------------------- */

/* By permutations, with the sign from their inversions. */
static double leibniz(const double *m, int n, const int *rows, const int *columns, int size) {
    int order[6] = {0, 1, 2, 3, 4, 5};
    double sum = 0.0;
    int total = 1;
    for (int i = 2; i <= size; i++) {
        total *= i;
    }
    for (int number = 0; number < total; number++) {
        int rest = number;
        bool used[6] = {false};
        for (int i = 0; i < size; i++) { /* Lehmer's code */
            int skip = rest % (size - i);
            rest /= size - i;
            int k = 0;
            while (used[k] || skip-- > 0) {
                k++;
            }
            used[k] = true;
            order[i] = k;
        }
        double product = 1.0;
        for (int i = 0; i < size; i++) {
            product *= m[rows[i] * n + columns[order[i]]];
            for (int j = 0; j < i; j++) {
                product = order[j] > order[i] ? -product : product;
            }
        }
        sum += product;
    }
    return sum;
}

static void test_determinants_of_any_rows_and_columns(void) {
    uint64_t seed = 3;
    for (int i = 0; i < 120; i++) {
        const int n = 1 + i % 5;
        algebra *a = algebra_new();
        double numbers[25];
        const poly *m[25];
        for (int k = 0; k < n * n; k++) {
            numbers[k] = (double)(random_bits(&seed) % 9) - 4.0;
            m[k] = poly_number(a, numbers[k]);
        }
        unsigned rows = 0;
        unsigned columns = 0;
        int row[6];
        int column[6];
        const int size = 1 + (int)(random_bits(&seed) % (unsigned)n);
        for (int k = 0, r = 0, c = 0; k < n; k++) { /* the last rows, the first columns but one */
            if (k >= n - size) {
                rows |= 1U << k;
                row[r++] = k;
            }
            if (size == n || k != i % (size + 1)) {
                if (c < size) {
                    columns |= 1U << k;
                    column[c++] = k;
                }
            }
        }
        double value = 1e300;
        TEST_ASSERT_TRUE(poly_is_number(poly_determinant(a, m, n, rows, columns), &value));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, leibniz(numbers, n, row, column, size), value);
        algebra_free(a);
    }
}

void suite_algebra_limits(void) {
    RUN_TEST(test_magnitudes_are_sums_of_sizes);
    RUN_TEST(test_powers_of_expressions_and_their_slopes);
    RUN_TEST(test_a_number_that_is_none_is_seen_wherever_it_is);
    RUN_TEST(test_each_number_is_changed_and_those_that_vanish_go);
    RUN_TEST(test_powers_are_multiplied_out_up_to_a_size);
    RUN_TEST(test_large_products_stay_products);
    RUN_TEST(test_what_grows_without_end_overflows);
    RUN_TEST(test_work_is_counted_alike_on_every_host);
    RUN_TEST(test_lets_are_worked_out_once);
    RUN_TEST(test_what_cancels_to_a_rounding_error_is_zero);
    RUN_TEST(test_determinants_of_any_rows_and_columns);
}
