/* test_pieces.c: a sum taken apart for lowering: half angles put back where they save a term,
 * and the value stays what it was. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "derived.h"
#include "host/derive/lower.h"
#include "unity.h"

void suite_pieces(void);

enum { VARIABLES = 2 };

static const symbol variables[VARIABLES] = {
    {.kind = SYM_COORDINATE, .name = "u", .text = "", .unit = "", .index = 0},
    {.kind = SYM_COORDINATE, .name = "v", .text = "", .unit = "", .index = 1}};

static double variable_value(void *context, const symbol *sym, int primes) {
    (void)primes;
    return ((const double *)context)[sym->index];
}

static double pieces_value(const piece *pieces, int count, double at[VARIABLES]) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double product = pieces[i].coefficient;
        for (int k = 0; k < pieces[i].mono->count; k++) {
            const mono_factor *f = &pieces[i].mono->factors[k];
            product *= pow(at[f->atom->symbol->index], f->exponent);
        }
        if (pieces[i].angle != NULL) {
            const double angle = poly_evaluate(pieces[i].angle, variable_value, at);
            product *= pow(sin(angle), pieces[i].sines) * pow(cos(angle), pieces[i].cosines);
        }
        sum += product;
    }
    return sum;
}

static void test_squares_of_sines_come_back(void) {
    algebra *a = algebra_new();
    const poly *u = poly_symbol(a, &variables[0], 0);
    const poly *v = poly_symbol(a, &variables[1], 0);
    const poly *one = poly_number(a, 1.0);
    const poly *flat =
        poly_mul(a, poly_mul(a, v, v), poly_sub(a, one, poly_cos(a, poly_scale(a, u, 2.0))));
    piece pieces[8];
    TEST_ASSERT_EQUAL_INT(1, pieces_of(a, flat, pieces));
    TEST_ASSERT_TRUE(pieces[0].sines == 2 && pieces[0].cosines == 0 && pieces[0].angle == u);
    TEST_ASSERT_TRUE(pieces[0].coefficient == 2.0);
    const poly *tall = poly_scale(a, poly_add(a, one, poly_cos(a, poly_scale(a, u, 4.0))), -3.0);
    TEST_ASSERT_EQUAL_INT(1, pieces_of(a, tall, pieces));
    TEST_ASSERT_TRUE(pieces[0].sines == 0 && pieces[0].cosines == 2);
    TEST_ASSERT_TRUE(pieces[0].coefficient == -6.0 && pieces[0].angle == poly_scale(a, u, 2.0));
    /* other factors, other sizes, or an odd multiple: nothing to put back */
    TEST_ASSERT_EQUAL_INT(2,
                          pieces_of(a, poly_sub(a, v, poly_cos(a, poly_scale(a, u, 2.0))), pieces));
    TEST_ASSERT_EQUAL_INT(
        2, pieces_of(a, poly_sub(a, one, poly_cos(a, poly_scale(a, u, 3.0))), pieces));
    TEST_ASSERT_EQUAL_INT(
        2,
        pieces_of(a, poly_sub(a, poly_number(a, 1.5), poly_cos(a, poly_scale(a, u, 2.0))), pieces));
    algebra_free(a);
}

/* sin(w)^(2p) cos(w)^(2q) and its slope, of w = 2u - v and times 0.3 v: each comes back as one piece where
 * the slope is one product, else as two. */
static void test_even_powers_come_back(void) {
    for (int p = 0; p <= 8; p++) {
        for (int q = 0; p + q <= 8; q++) {
            if (p + q == 0) {
                continue;
            }
            algebra *a = algebra_new();
            const poly *u = poly_symbol(a, &variables[0], 0);
            const poly *v = poly_symbol(a, &variables[1], 0);
            const poly *w = poly_sub(a, poly_scale(a, u, 2.0), v);
            const poly *power = poly_scale(a,
                                           poly_mul(a, poly_pow(a, poly_sin(a, w), 2.0 * p),
                                                    poly_pow(a, poly_cos(a, w), 2.0 * q)),
                                           0.3);
            piece pieces[32];
            TEST_ASSERT_TRUE(power->count <= 32);
            TEST_ASSERT_EQUAL_INT(1, pieces_of(a, poly_mul(a, power, v), pieces));
            const bool doubled = p == q; /* sin(w)^2 cos(w)^2 = sin(2w)^2/4 */
            TEST_ASSERT_EQUAL_INT(2 * p, pieces[0].sines);
            TEST_ASSERT_EQUAL_INT(doubled ? 0 : 2 * q, pieces[0].cosines);
            TEST_ASSERT_TRUE(pieces[0].angle == (doubled ? poly_scale(a, w, 2.0) : w));
            const double size = doubled ? 0.3 * pow(0.25, p) : 0.3;
            TEST_ASSERT_DOUBLE_WITHIN(1e-13 * size, size, pieces[0].coefficient);
            const poly *slope = poly_derivative(a, power, &variables[1], 0);
            const int count = pieces_of(a, slope, pieces);
            TEST_ASSERT_EQUAL_INT(p > 0 && q > 0 && !doubled ? 2 : 1, count);
            for (int i = 0; i < count && slope->count > 1; i++) {
                TEST_ASSERT_TRUE(pieces[i].sines >= 2 * p - 1);
                TEST_ASSERT_TRUE(doubled || pieces[i].cosines >= 2 * q - 1);
            }
            algebra_free(a);
        }
    }
}

static void test_other_rows_stay_as_they_are(void) {
    algebra *a = algebra_new();
    const poly *u = poly_symbol(a, &variables[0], 0);
    const poly *one = poly_number(a, 1.0);
    const poly *two = poly_cos(a, poly_scale(a, u, 2.0));
    const poly *four = poly_cos(a, poly_scale(a, u, 4.0));
    const poly *row =
        poly_add(a, poly_sub(a, poly_scale(a, one, 3.0), poly_scale(a, two, 4.0)), four);
    piece pieces[8];
    TEST_ASSERT_EQUAL_INT(1, pieces_of(a, row, pieces));
    /* a small part more at the pole is a part more: nothing cancels to less than it */
    const poly *more = poly_add(a, row, poly_number(a, 1e-12));
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, more, pieces));
    /* 3 - 4 cos a + cos 2a = 8 sin(a/2)^4, but a turn angle has no half */
    const poly *half =
        poly_add(a, poly_sub(a, poly_scale(a, one, 3.0), poly_scale(a, poly_cos(a, u), 4.0)), two);
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, half, pieces));
    /* nothing cancels at 0 or pi/2 */
    const poly *flat =
        poly_add(a, poly_add(a, one, poly_scale(a, two, 2.0)), poly_scale(a, four, 0.5));
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, flat, pieces));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(pieces[i].sines + pieces[i].cosines <= 1);
    }
    /* products would have to be large, and cancel elsewhere; or there would be more of them */
    const poly *tall = poly_sub(a, poly_cos(a, poly_scale(a, u, 16.0)), one);
    const poly *few = poly_add(a, tall, poly_scale(a, poly_sub(a, two, one), 1e-3));
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, few, pieces));
    const poly *many = tall;
    for (int k = 1; k < 8; k++) {
        const poly *cosine = poly_cos(a, poly_scale(a, u, 2.0 * k));
        many = poly_add(a, many, poly_scale(a, poly_sub(a, cosine, one), 1e-3));
    }
    piece room[16];
    TEST_ASSERT_EQUAL_INT(9, pieces_of(a, many, room));
    algebra_free(a);
}

static void test_pieces_have_the_sums_value(void) {
    uint64_t seed = 7;
    int powers = 0;
    for (int round = 0; round < 2000; round++) {
        algebra *a = algebra_new();
        const poly *sum = poly_number(a, 0.0);
        for (int i = 0; i < 3; i++) { /* small whole factors, so that powers do turn up */
            const poly *u = poly_symbol(a, &variables[0], 0);
            const poly *v = poly_symbol(a, &variables[1], 0);
            const poly *angle = poly_add(a, poly_scale(a, u, (double)(random_bits(&seed) % 3)),
                                         poly_scale(a, v, (double)(random_bits(&seed) % 2)));
            const poly *cosine =
                random_bits(&seed) % 2 == 0 ? poly_sin(a, angle) : poly_cos(a, angle);
            const poly *front = random_bits(&seed) % 2 == 0 ? u : poly_number(a, 2.0);
            const double exponent = 2.0 * (double)(1 + random_bits(&seed) % 3);
            sum = poly_add(a, sum, poly_mul(a, front, poly_pow(a, cosine, exponent)));
        }
        if (random_bits(&seed) % 2 == 0) {
            sum = poly_derivative(a, sum, &variables[0], 0);
        }
        double at[VARIABLES] = {random_between(&seed, -3.0, 3.0), random_between(&seed, -3.0, 3.0)};
        piece pieces[64];
        TEST_ASSERT_TRUE(sum->count < 64);
        const int count = pieces_of(a, sum, pieces);
        TEST_ASSERT_TRUE(count <= sum->count);
        for (int i = 0; i < count; i++) {
            powers += pieces[i].sines + pieces[i].cosines > 2;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, poly_evaluate(sum, variable_value, at),
                                  pieces_value(pieces, count, at));
        algebra_free(a);
    }
    printf("  %d powers above the second\n", powers);
    TEST_ASSERT_GREATER_THAN_INT(500, powers);
}

/* Fourth powers and squares of one wave, each times another factor: each is found, whatever stands beside it. */
static void test_each_of_several_comes_back(void) {
    for (unsigned which = 0; which < 64;
         which++) { /* three factors, each none, a square or a fourth power */
        algebra *a = algebra_new();
        const poly *u = poly_symbol(a, &variables[0], 0);
        const poly *v = poly_symbol(a, &variables[1], 0);
        const poly *sum = poly_number(a, 0.0);
        int parts = 0;
        for (unsigned k = 0; k < 3; k++) {
            const unsigned power = which >> (2 * k) & 3U;
            const poly *beside = poly_pow(a, v, (double)k + 1.0);
            const poly *cosine = power == 1 ? poly_cos(a, u) : poly_sin(a, u);
            const double exponent = power == 3 ? 4.0 : 2.0;
            if (power > 0) {
                sum = poly_add(a, sum, poly_mul(a, beside, poly_pow(a, cosine, exponent)));
                parts++;
            }
        }
        piece pieces[16];
        TEST_ASSERT_EQUAL_INT(parts, pieces_of(a, sum, pieces));
        for (int i = 0; i < parts; i++) {
            TEST_ASSERT_TRUE(pieces[i].angle == u && pieces[i].sines + pieces[i].cosines >= 2);
            TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.0, pieces[i].coefficient);
        }
        algebra_free(a);
    }
}

/* --- sines inside sines ----------------------------------------------------------------------- */

/* Sines of angles that have sines inside: each is found, whichever angles are made from which. */
enum { MECHANISMS = 300, STATES = 3 };

static unsigned draw(uint64_t *seed, unsigned bound) {
    return (unsigned)(random_bits(seed) % bound);
}

/* Sums, differences and multiples of a few angles, with and without a sine inside. */
static void angle(FILE *to, int depth, uint64_t *seed) {
    static const char *const simple[] = {"q", "x", "(q + n)", "(q - x)", "(2*q)", "(x + n)"};
    static const char *const before[] = {"(", "(", "sin(", "exp(sin("};
    static const char *const after[] = {")", ")", ")", "))"};
    const unsigned which = depth > 0 ? draw(seed, 6) : 4;
    if (which >= 4) {
        fputs(simple[draw(seed, sizeof simple / sizeof simple[0])], to);
        return;
    }
    fputs(before[which], to);
    angle(to, depth - 1, seed);
    if (which < 2) {
        fputs(which == 0 ? " + " : " - ", to);
        angle(to, depth - 1, seed);
    }
    fputs(after[which], to);
}

/* The accelerations of the operation list solve the equations. Returns how many states had some. */
static int check(const derived *d, uint64_t *seed) {
    const equations *e = d->equations;
    int checked = 0;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, d, seed);
        TEST_ASSERT_TRUE(d->image->list[IMAGE_BOOKS]->results <= UNKNOWNS);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        for (int i = 0; i < e->count; i++) {
            double size;
            const double rest = derived_rest(d, &s, result, i, &size);
            TEST_ASSERT_TRUE(fabs(rest) <= 1e-9 * size);
        }
        checked++;
    }
    return checked;
}

static void test_sines_inside_sines(void) {
    uint64_t seed = 7;
    int checked = 0;
    for (int i = 0; i < MECHANISMS; i++) {
        char *text = NULL;
        size_t size = 0;
        FILE *to = open_memstream(&text, &size);
        TEST_ASSERT_NOT_NULL(to);
        fputs("mechanism m\ncoordinate q\ncoordinate x\nparameter n = 2.5\n"
              "T = 1 [kg*m^2]*(2*q'^2 + cos(",
              to);
        angle(to, 1 + i % 3, &seed);
        fputs(")*q'*x' + (3 + cos(", to);
        angle(to, 1 + i % 3, &seed);
        fputs("))*x'^2)\nV = 1 [J]*cos(", to);
        angle(to, 1 + i % 3, &seed);
        fputs(")\n", to);
        fclose(to);
        derived d = derived_text(text);
        derived_expect(&d, text);
        checked += check(&d, &seed);
        derived_free(&d);
        free(text);
    }
    printf("  seed 7: %d states of %d mechanisms\n", checked, MECHANISMS);
    TEST_ASSERT_EQUAL_INT(MECHANISMS * STATES, checked);
}

void suite_pieces(void) {
    RUN_TEST(test_squares_of_sines_come_back);
    RUN_TEST(test_even_powers_come_back);
    RUN_TEST(test_other_rows_stay_as_they_are);
    RUN_TEST(test_each_of_several_comes_back);
    RUN_TEST(test_pieces_have_the_sums_value);
    RUN_TEST(test_sines_inside_sines);
}
