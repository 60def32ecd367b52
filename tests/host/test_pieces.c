/* test_pieces.c: a sum taken apart for lowering: half angles put back where they save a term,
 * and the value stays what it was. */
#include <math.h>

#include "derived.h"
#include "host/derive/pieces.h"
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
            const factor *f = &pieces[i].mono->factors[k];
            product *= pow(at[f->atom->symbol->index], f->exponent);
        }
        if (pieces[i].trig != TRIG_NONE) {
            const double angle = poly_evaluate(pieces[i].angle, variable_value, at);
            const double wave = pieces[i].trig == TRIG_SIN ? sin(angle) : cos(angle);
            product *= pieces[i].squared ? wave * wave : wave;
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
    TEST_ASSERT_TRUE(pieces[0].squared && pieces[0].trig == TRIG_SIN && pieces[0].angle == u);
    TEST_ASSERT_TRUE(pieces[0].coefficient == 2.0);
    const poly *tall = poly_scale(a, poly_add(a, one, poly_cos(a, poly_scale(a, u, 4.0))), -3.0);
    TEST_ASSERT_EQUAL_INT(1, pieces_of(a, tall, pieces));
    TEST_ASSERT_TRUE(pieces[0].squared && pieces[0].trig == TRIG_COS);
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

static void test_pieces_have_the_sums_value(void) {
    uint64_t seed = 7;
    for (int round = 0; round < 500; round++) {
        algebra *a = algebra_new();
        const poly *sum = poly_number(a, 0.0);
        for (int i = 0; i < 5; i++) { /* small whole factors, so that squares do turn up */
            const poly *u = poly_symbol(a, &variables[0], 0);
            const poly *v = poly_symbol(a, &variables[1], 0);
            const poly *angle = poly_add(a, poly_scale(a, u, (double)(random_bits(&seed) % 3)),
                                         poly_scale(a, v, (double)(random_bits(&seed) % 2)));
            const poly *wave =
                random_bits(&seed) % 2 == 0 ? poly_sin(a, angle) : poly_cos(a, angle);
            const poly *front = random_bits(&seed) % 2 == 0 ? u : poly_number(a, 2.0);
            sum = poly_add(a, sum, poly_mul(a, front, poly_mul(a, wave, wave)));
        }
        double at[VARIABLES] = {random_between(&seed, -3.0, 3.0), random_between(&seed, -3.0, 3.0)};
        piece pieces[64];
        TEST_ASSERT_TRUE(sum->count < 64);
        const int count = pieces_of(a, sum, pieces);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, poly_evaluate(sum, variable_value, at),
                                  pieces_value(pieces, count, at));
        algebra_free(a);
    }
}

void suite_pieces(void) {
    UnitySetTestFile(__FILE__);
    RUN_TEST(test_squares_of_sines_come_back);
    RUN_TEST(test_pieces_have_the_sums_value);
}
