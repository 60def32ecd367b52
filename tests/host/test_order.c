/* test_order.c: lists that are put into an order with few values live: the same operations, each behind what it takes,
 * and the same bits; values carried to memory and back less often, and as seldom as can be where one can tell.
 * WHIRL_CASES: so many random lists. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/base/alloc.h"
#include "host/engine/engine.h"

#include "unity.h"

void suite_order(void);

enum { ANGLES = 5, LEAVES = 12, STATES = 3, SIZE_MOST = 900, RESULTS_MOST = 12 };

/* --- random lists --------------------------------------------------------------------------------*/

/* One of the earlier operations that are values; late ones are likelier. */
static int some_value(dice *d, const int *value, int values) {
    const int near = values < 40 ? values : 40;
    const bool anywhere = dice_one_of(d, 3) == 0;
    const unsigned back = dice_one_of(d, (unsigned)(anywhere ? values : near));
    return value[values - 1 - (int)back];
}

/* A sine or cosine of angles, of a value, or of both. */
static int some_wave(dice *d, op_list *t, const int *value, int values) {
    double multiple[ANGLES];
    const bool turns = dice_one_of(d, 4) > 0;
    for (int k = 0; k < ANGLES; k++) {
        multiple[k] = turns ? (double)dice_one_of(d, 5) - 2.0 : 0.0;
    }
    const int radians = dice_one_of(d, 3) > 0 ? -1 : some_value(d, value, values);
    const int phase = op_list_phase(t, multiple, dice_one_of(d, 2) * 0.25, radians);
    return op_list_unary(t, dice_one_of(d, 2) > 0 ? OP_SIN : OP_COS, phase);
}

/* Any function of the language, a new one too. */
static int some_call(dice *d, op_list *t, int a, int b) {
    const function_id function = (function_id)dice_one_of(d, FUNCTIONS);
    return op_list_call(t, function, a, function_arguments(function) == 2 ? b : -1);
}

static int some_operation(dice *d, op_list *t, const int *value, int values) {
    const int a = some_value(d, value, values);
    const int b = some_value(d, value, values);
    switch (dice_one_of(d, 16)) {
    case 0: return op_list_leaf(t, OP_LINEAR, (int)dice_one_of(d, LEAVES));
    case 1: return op_list_leaf(t, OP_RATE, (int)dice_one_of(d, LEAVES));
    case 2: return op_list_leaf(t, OP_INPUT, (int)dice_one_of(d, LEAVES));
    case 3: return op_list_constant(t, dice_between(d, -2.0, 2.0));
    case 4: return some_wave(d, t, value, values);
    case 5: return op_list_div(t, a, b);
    case 6: return op_list_unary(t, OP_SQRT, op_list_unary(t, OP_ABS, a));
    case 7:
    case 8:
    case 9: return some_call(d, t, a, b);
    case 10: return op_list_sub(t, a, b);
    case 11: return op_list_unary(t, OP_NEG, a);
    case 12:
    case 13: return op_list_mul(t, a, b);
    }
    return op_list_add(t, a, b);
}

static op_list *some_list(dice d) {
    const int size = (int)dice_one_of(&d, SIZE_MOST);
    op_list *t = op_list_new(ANGLES, (int)dice_one_of(&d, RESULTS_MOST + 1));
    int *value = alloc((int64_t)size + 1, sizeof *value);
    int values = 1;
    value[0] = op_list_leaf(t, OP_RATE, 0);
    while (values <= size) {
        value[values] = some_operation(&d, t, value, values);
        values++;
    }
    for (int i = 0; i < t->results; i++) {
        t->result[i] = some_value(&d, value, values);
    }
    free(value);
    if (dice_one_of(&d, 4) > 0) { /* else with operations that no result needs */
        op_list_prune(t);
    }
    return t;
}

/* --- the same in another order -------------------------------------------------------------------*/

static int by_size(const void *x, const void *y) {
    const uint64_t left = *(const uint64_t *)x;
    const uint64_t right = *(const uint64_t *)y;
    return (left > right) - (left < right);
}

/* What each operation computes, wherever it stands: sorted. Phases also as they follow each other, in *phases. */
static uint64_t *computed_by(const op_list *t, uint64_t *phases) {
    uint64_t *sum = alloc((int64_t)t->count + 1, sizeof *sum);
    int operand[2];
    *phases = 1;
    for (int i = 0; i < t->count; i++) {
        op alone = t->ops[i];
        const int operands = op_list_operands(&alone, operand);
        if (op_rows[alone.code].values > 0) {
            alone.a = -2;
        }
        alone.b = operands > 0 ? -2 : alone.b;
        sum[i] = op_list_op_hash(t, &alone);
        for (int k = 0; k < operands; k++) {
            TEST_ASSERT_TRUE_MESSAGE(operand[k] < i, "an operation before what it takes");
            sum[i] = (sum[i] + sum[operand[k]]) * UINT64_C(0x9e3779b97f4a7c15);
        }
        *phases = alone.code == OP_PHASE ? *phases * 31 + sum[i] : *phases;
    }
    qsort(sum, (size_t)t->count, sizeof *sum, by_size);
    return sum;
}

static void expect_same_operations(const op_list *entered, const op_list *ordered) {
    uint64_t phases[2];
    TEST_ASSERT_EQUAL_INT(entered->count, ordered->count);
    uint64_t *before = computed_by(entered, &phases[0]);
    uint64_t *after = computed_by(ordered, &phases[1]);
    TEST_ASSERT_EQUAL_MEMORY(before, after, ((size_t)entered->count + 1) * sizeof *before);
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(phases[0], phases[1], "phases in another order");
    free(before);
    free(after);
}

static void expect_same_bits(dice *d, const op_list *entered, const op_list *ordered) {
    evaluator *one = evaluator_new(entered);
    evaluator *other = evaluator_new(ordered);
    for (int state = 0; state < STATES; state++) {
        double leaf[ANGLES + 3 * LEAVES];
        double before[RESULTS_MOST + 1] = {0.0};
        double after[RESULTS_MOST + 1] = {0.0};
        for (int i = 0; i < ANGLES + 3 * LEAVES; i++) {
            leaf[i] = dice_between(d, -1.5, 1.5);
        }
        const double *in = leaf + ANGLES;
        evaluator_run(one, 0.0, leaf, in, in + LEAVES, in + 2 * LEAVES, before);
        evaluator_run(other, 0.0, leaf, in, in + LEAVES, in + 2 * LEAVES, after);
        TEST_ASSERT_EQUAL_MEMORY(before, after, sizeof before);
    }
    evaluator_free(one);
    evaluator_free(other);
}

static void test_random_lists_compute_the_same(void) {
    dice d = dice_of("order", 41);
    const unsigned cases = dice_cases(300);
    long long before = 0;
    long long after = 0;
    int moved = 0;
    for (unsigned i = 0; i < cases; i++) {
        const dice same = {d.state * 2862933555777941757ULL + i};
        op_list *entered = some_list(same);
        op_list *ordered = some_list(same);
        op_list_order(ordered);
        expect_same_operations(entered, ordered);
        expect_same_bits(&d, entered, ordered);
        const int carried = op_list_carried(entered);
        const int carried_now = op_list_carried(ordered);
        TEST_ASSERT_TRUE_MESSAGE(carried_now <= carried, "values are carried more often");
        TEST_ASSERT_TRUE((carried_now < carried) ==
                         (op_list_hash(entered) != op_list_hash(ordered)));
        moved += carried_now < carried;
        before += carried;
        after += carried_now;
        op_list_free(entered);
        op_list_free(ordered);
    }
    char told[96];
    snprintf(told, sizeof told, "%d of %u lists reordered; values carried %lld times, were %lld",
             moved, cases, after, before);
    TEST_MESSAGE(told);
    TEST_ASSERT_TRUE(moved > 0);
}

/* --- as seldom as can be -------------------------------------------------------------------------*/

/* The sum of n squares, first all squares: each leaf has to be read once, and no more. As entered, all but the squares
 * that 20 registers hold are stored and read again; the last register is where the next square is made. */
static void test_squares_are_summed_as_they_come(void) {
    for (int n = 1; n <= 200; n++) {
        op_list *t = op_list_new(0, 1);
        int *square = alloc(n, sizeof *square);
        for (int i = 0; i < n; i++) {
            const int leaf = op_list_leaf(t, OP_LINEAR, i);
            square[i] = op_list_mul(t, leaf, leaf);
        }
        int sum = square[0];
        for (int i = 1; i < n; i++) {
            sum = op_list_add(t, sum, square[i]);
        }
        t->result[0] = sum;
        TEST_ASSERT_EQUAL_INT(n <= 20 ? n : n + 2 * (n - 20), op_list_carried(t));
        op_list_order(t);
        TEST_ASSERT_EQUAL_INT(n, op_list_carried(t));
        free(square);
        op_list_free(t);
    }
}

void suite_order(void) {
    RUN_TEST(test_random_lists_compute_the_same);
    RUN_TEST(test_squares_are_summed_as_they_come);
}
