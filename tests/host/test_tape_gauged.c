/* test_tape_gauged.c: what tape_gauge() is to find (host/image/tape_gauge.h), in lists that are built so that a number is known
 * after which no constant is off: products of small primes, and constants that vanish. */
#include <math.h>
#include <stdlib.h>

#include "blocks.h"
#include "command.h"
#include "evaluated.h"
#include "host/image/tape_gauge.h"
#include "unity.h"

void suite_tape_gauged(void);

static dice die;

/* A sum of two products of leaves, with whole numbers below 120 times `unit`. */
static int sum_of(tape *t, int which, double unit) {
    const int x = tape_leaf(t, OP_LINEAR, which);
    const int y = tape_leaf(t, OP_RATE, which);
    const int one = tape_mul(t, x, x);
    const int other = tape_mul(t, y, y);
    const double a = 61.0 + 2.0 * dice_one_of(&die, 29);
    const double b = 61.0 + 2.0 * dice_one_of(&die, 29);
    return tape_add(t, tape_mul(t, tape_constant(t, a * unit), one),
                    tape_mul(t, tape_constant(t, b * unit), other));
}

/* A quotient of such sums. */
static tape *quotient(double unit) {
    tape *t = tape_new(0, 1);
    const int above = sum_of(t, 0, unit);
    t->result[0] = tape_div(t, above, sum_of(t, 1, unit));
    tape_prune(t);
    return t;
}

static void results_of(const tape *t, double *result) {
    static double v[EVALUATED_MOST];
    evaluated(t, v);
    for (int i = 0; i < t->results; i++) {
        result[i] = v[t->result[i]];
    }
}

/* Gauges the list, which is to be off by nothing then; it computes the same with no operation more. */
static void expect_none_off(tape *t) {
    double before[1];
    double after[1];
    const int operations = tape_operations(t);
    results_of(t, before);
    const double bias = tape_bias(t, t);
    TEST_ASSERT_TRUE(bias > 1e-10);
    tape_gauge(&t, 0);
    TEST_ASSERT_TRUE(tape_bias(t, t) <= 1e-6 * bias);
    TEST_ASSERT_TRUE(tape_operations(t) <= operations);
    results_of(t, after);
    for (int i = 0; i < t->results; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * fabs(before[i]), before[i], after[i]);
    }
    tape_free(t);
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
                    tape *t = quotient(unit);
                    if (tape_bias(t, t) > 1e-10) {
                        expect_none_off(t);
                    } else {
                        tape_free(t); /* as it happens */
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
        tape *t = tape_new(0, 1);
        const int x = tape_leaf(t, OP_LINEAR, 0);
        const int y = tape_leaf(t, OP_RATE, 1);
        const int times_x = tape_mul(t, tape_constant(t, unit), tape_mul(t, x, x));
        const double a =
            61.0 +
            2.0 * dice_one_of(&die, 29); /* no float of 24 bits keeps these ratios by chance */
        const double b = 151.0 + 2.0 * dice_one_of(&die, 29);
        const int times_y = tape_mul(t, tape_constant(t, a * unit), tape_mul(t, y, y));
        const int third = tape_mul(t, tape_constant(t, b * unit), tape_mul(t, x, y));
        t->result[0] = tape_div(t, tape_add(t, times_x, times_y), tape_add(t, third, times_x));
        tape_prune(t);
        const int operations = tape_operations(t);
        double before;
        double after;
        results_of(t, &before);
        tape_gauge(&t, 0);
        results_of(t, &after);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, before, after);
        TEST_ASSERT_TRUE(tape_operations(t) <= operations);
        TEST_ASSERT_TRUE(tape_bias(t, t) < 1e-13);
        tape_free(t);
    }
}

/* Up to 250 operations, constants and leaves among them. */
static void test_long_lists_are_left_alone(void) {
    for (int over = 0; over < 2; over++) {
        const double unit = 0.01;
        tape *longer = tape_new(0, 2);
        const int above = sum_of(longer, 0, unit);
        longer->result[0] = tape_div(longer, above, sum_of(longer, 1, unit));
        int sum = tape_leaf(longer, OP_INPUT, 0);
        while (longer->count < 250 + over) {
            sum = tape_unary(longer, OP_ABS, sum);
        }
        longer->result[1] = sum;
        tape_prune(longer);
        TEST_ASSERT_EQUAL_INT(250 + over, longer->count);
        const uint64_t hash = tape_hash(longer);
        tape_gauge(&longer, 0);
        TEST_ASSERT_EQUAL(over == 1, hash == tape_hash(longer));
        tape_free(longer);
    }
}

/* One operation more, and one for each forty. */
static void test_what_a_better_list_may_cost(void) {
    tape *t = tape_new(0, 1);
    int sum = tape_leaf(t, OP_INPUT, 0);
    for (int operations = 0; operations < 200; operations++) {
        TEST_ASSERT_EQUAL_INT(operations, tape_operations(t));
        TEST_ASSERT_EQUAL_INT((int)(1.0 + floor(operations / 40.0)), tape_gauge_price(t));
        sum = tape_unary(t, OP_ABS, sum);
    }
    tape_free(t);
}

void suite_tape_gauged(void) {
    die = dice_of("tape_gauged", 4200);
    RUN_TEST(test_decimals_and_thirds_become_whole);
    RUN_TEST(test_constants_vanish);
    RUN_TEST(test_long_lists_are_left_alone);
    RUN_TEST(test_what_a_better_list_may_cost);
}
