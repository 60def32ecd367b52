/* test_tape_gauged.c: what op_list_gauge() is to find (host/image/op_list_gauge.h), in lists that are built so that a number is known
 * after which no constant is off: products of small primes, and constants that vanish. */
#include <math.h>
#include <stdlib.h>

#include "blocks.h"
#include "command.h"
#include "evaluated.h"
#include "host/image/op_list_scaling.h"
#include "unity.h"

void suite_tape_gauged(void);

static dice die;

/* A sum of two products of leaves, with whole numbers below 120 times `unit`. */
static int sum_of(op_list *t, int which, double unit) {
    const int x = op_list_leaf(t, OP_LINEAR, which);
    const int y = op_list_leaf(t, OP_RATE, which);
    const int one = op_list_mul(t, x, x);
    const int other = op_list_mul(t, y, y);
    const double a = 61.0 + 2.0 * dice_one_of(&die, 29);
    const double b = 61.0 + 2.0 * dice_one_of(&die, 29);
    return op_list_add(t, op_list_mul(t, op_list_constant(t, a * unit), one),
                       op_list_mul(t, op_list_constant(t, b * unit), other));
}

/* A quotient of such sums. */
static op_list *quotient(double unit) {
    op_list *t = op_list_new(0, 1);
    const int above = sum_of(t, 0, unit);
    t->result[0] = op_list_div(t, above, sum_of(t, 1, unit));
    op_list_prune(t);
    return t;
}

static void results_of(const op_list *t, double *result) {
    static double v[EVALUATED_MOST];
    evaluated(t, v);
    for (int i = 0; i < t->results; i++) {
        result[i] = v[t->result[i]];
    }
}

/* Gauges the list, which is to be off by nothing then; it computes the same with no operation more. */
static void expect_none_off(op_list *t) {
    double before[1];
    double after[1];
    const int operations = op_list_operations(t);
    results_of(t, before);
    const double bias = op_list_bias(t, t);
    TEST_ASSERT_TRUE(bias > 1e-10);
    op_list_gauge(&t, 0);
    TEST_ASSERT_TRUE(op_list_bias(t, t) <= 1e-6 * bias);
    TEST_ASSERT_TRUE(op_list_operations(t) <= operations);
    results_of(t, after);
    for (int i = 0; i < t->results; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * fabs(before[i]), before[i], after[i]);
    }
    op_list_free(t);
}

static double primes(int fives, int threes, int sevens) {
    return pow(5.0, fives) * pow(3.0, threes) * pow(7.0, sevens);
}

/* Is it one that float has, for all whole numbers of sum_of()? Then there is nothing to find. */
static bool is_held(double unit) {
    bool held = true;
    for (int number = 61; number < 120; number += 2) {
        held = held && (double)(float)(number * unit) == number * unit;
    }
    return held;
}

/* Whole numbers over powers of five, three and seven, and times such powers, as far as is looked. */
static void test_decimals_and_thirds_become_whole(void) {
    const long blocks = blocks_in_use();
    const unsigned few = few_or_all(usual_or(4, 12), 1);
    for (int fives = -6; fives <= 6; fives++) {
        for (int threes = -3; threes <= 3; threes++) {
            for (int sevens = -1; sevens <= 1; sevens++) {
                const double unit = primes(fives, threes, sevens);
                const bool extreme = abs(fives) == 6 || abs(threes) == 3;
                if (dice_one_of(&die, extreme ? few : 5 * few) == 0 && !is_held(unit)) {
                    op_list *t = quotient(unit);
                    if (op_list_bias(t, t) > 1e-10) {
                        expect_none_off(t);
                    } else {
                        op_list_free(t); /* as it happens */
                    }
                }
            }
        }
    }
    TEST_ASSERT_TRUE(blocks_in_use() == blocks);
}

/* A number that nobody would guess, which all constants have: without it they are whole. */
static void test_constants_vanish(void) {
    for (int tries = 0; tries < 20; tries++) {
        const double unit = dice_between(&die, 0.1, 10.0);
        op_list *t = op_list_new(0, 1);
        const int x = op_list_leaf(t, OP_LINEAR, 0);
        const int y = op_list_leaf(t, OP_RATE, 1);
        const int times_x = op_list_mul(t, op_list_constant(t, unit), op_list_mul(t, x, x));
        const double a =
            61.0 +
            2.0 * dice_one_of(&die, 29); /* no float of 24 bits keeps these ratios by chance */
        const double b = 151.0 + 2.0 * dice_one_of(&die, 29);
        const int times_y = op_list_mul(t, op_list_constant(t, a * unit), op_list_mul(t, y, y));
        const int third = op_list_mul(t, op_list_constant(t, b * unit), op_list_mul(t, x, y));
        t->result[0] =
            op_list_div(t, op_list_add(t, times_x, times_y), op_list_add(t, third, times_x));
        op_list_prune(t);
        const int operations = op_list_operations(t);
        double before;
        double after;
        results_of(t, &before);
        op_list_gauge(&t, 0);
        results_of(t, &after);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, before, after);
        TEST_ASSERT_TRUE(op_list_operations(t) <= operations);
        TEST_ASSERT_TRUE(op_list_bias(t, t) < 1e-13);
        op_list_free(t);
    }
}

/* Up to 250 operations, constants and leaves among them. */
static void test_long_lists_are_left_alone(void) {
    for (int over = 0; over < 2; over++) {
        const double unit = 0.01;
        op_list *longer = op_list_new(0, 2);
        const int above = sum_of(longer, 0, unit);
        longer->result[0] = op_list_div(longer, above, sum_of(longer, 1, unit));
        int sum = op_list_leaf(longer, OP_INPUT, 0);
        while (longer->count < 250 + over) {
            sum = op_list_unary(longer, OP_ABS, sum);
        }
        longer->result[1] = sum;
        op_list_prune(longer);
        TEST_ASSERT_EQUAL_INT(250 + over, longer->count);
        const uint64_t hash = op_list_hash(longer);
        op_list_gauge(&longer, 0);
        TEST_ASSERT_EQUAL(over == 1, hash == op_list_hash(longer));
        op_list_free(longer);
    }
}

/* One operation more, and one for each forty. */
static void test_what_a_better_list_may_cost(void) {
    op_list *t = op_list_new(0, 1);
    int sum = op_list_leaf(t, OP_INPUT, 0);
    for (int operations = 0; operations < 200; operations++) {
        TEST_ASSERT_EQUAL_INT(operations, op_list_operations(t));
        TEST_ASSERT_EQUAL_INT((int)(1.0 + floor(operations / 40.0)), op_list_gauge_price(t));
        sum = op_list_unary(t, OP_ABS, sum);
    }
    op_list_free(t);
}

void suite_tape_gauged(void) {
    die = dice_of("tape_gauged", 4200);
    RUN_TEST(test_decimals_and_thirds_become_whole);
    RUN_TEST(test_constants_vanish);
    RUN_TEST(test_long_lists_are_left_alone);
    RUN_TEST(test_what_a_better_list_may_cost);
}
