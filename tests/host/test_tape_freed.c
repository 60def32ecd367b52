/* test_tape_freed.c: the parts of what op_list_gauge() does (host/image/op_list_gauge.h), each by itself: what rounded constants make of
 * results, to a closed form; lists whose freedoms are known by how they were built; and lists multiplied by whatever a freedom
 * allows, which compute the same. */
#include <math.h>
#include <stdlib.h>

#include "blocks.h"
#include "command.h"
#include "evaluated.h"
#include "host/image/op_list_scaling.h"
#include "unity.h"

void suite_tape_freed(void);

static dice die;

/* A number of few digits, which float does not hold: from 0.1 to 10. */
static double decimal(void) { return (double)(1 + dice_one_of(&die, 9990)) / 999.7; }

/* --- what rounding makes of results --------------------------------------------------------------------------- */

enum { RESULTS_MOST = 5, READ = 1, UNREAD_SHARE = 64 };

/* Results are constants times leaves, so that each is as much off as its constant, whatever the state. What the list does
 * not read again counts a 64th. */
static void test_a_constants_error_is_the_results(void) {
    for (unsigned c = 0; c < dice_cases(200); c++) {
        const int angles = (int)dice_one_of(&die, 3);
        const int results = 1 + (int)dice_one_of(&die, RESULTS_MOST);
        op_list *t = op_list_new(angles, results);
        double squares = 0.0;
        double entries = 0.0;
        bool read[RESULTS_MOST] = {false};
        double off[RESULTS_MOST];
        for (int i = 0; i < results; i++) {
            const double number = decimal();
            const int k = (int)dice_one_of(&die, RESULTS_MOST + 1);
            const double one[2] = {k == 0 ? 1.0 : 0.0, k == 0 ? 0.0 : 1.0};
            int leaf = -1;
            int reads = -1;
            switch (dice_one_of(&die, angles == 2 ? 4 : 3)) {
            case 0: /* a rate of a result counts as reading it */
                leaf = op_list_leaf(t, OP_RATE, k);
                reads = k;
                break;
            case 1:
                leaf = op_list_leaf(t, OP_LINEAR, k);
                reads = angles + k;
                break;
            case 2: leaf = op_list_leaf(t, OP_INPUT, k); break;
            case 3:
                leaf = op_list_unary(t, OP_COS, op_list_phase(t, one, 0.25, -1));
                reads = k == 0 ? 0 : 1;
                break;
            }
            t->result[i] = op_list_mul(t, op_list_constant(t, number), leaf);
            off[i] = fabs((double)(float)number / number - 1.0);
            if (reads >= 0 && reads < results) {
                read[reads] = true;
            }
        }
        const bool *is_read = read;
        for (int i = 0; i < results; i++) {
            /* of three sizes of rates: at rest, a rate is nothing that could be off */
            const op *o = &t->ops[t->result[i]];
            const bool of_rate =
                o->code == OP_RATE || (o->code == OP_MUL && t->ops[o->b].code == OP_RATE);
            const double weight = is_read[i] ? 1.0 : 1.0 / UNREAD_SHARE;
            squares += (of_rate ? 2.0 : 3.0) * (weight * off[i]) * (weight * off[i]);
            entries += (of_rate ? 2.0 : 3.0) * weight * weight;
        }
        const double wanted = sqrt(squares / entries);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * wanted + 1e-13, wanted, op_list_bias(t, t));
        op_list_free(t);
    }
}

/* Every operation, at a place where its value is one and the constant beside it is off: as much is the result. */
static int made_of(op_list *t, int x, unsigned what) {
    const int two = op_list_constant(t, 2.0);
    switch (what) {
    case 0: return op_list_unary(t, OP_ABS, x);
    case 1: return op_list_unary(t, OP_SQRT, op_list_mul(t, x, x));
    case 2:
        return op_list_sub(t, op_list_mul(t, op_list_constant(t, 3.0), x), op_list_mul(t, two, x));
    case 3: return op_list_div(t, op_list_mul(t, x, x), x);
    case 4: return op_list_call(t, FN_MIN, x, op_list_mul(t, two, x));
    case 5: return op_list_call(t, FN_MAX, x, op_list_mul(t, op_list_constant(t, 0.5), x));
    case 6: return op_list_call(t, FN_LOG, op_list_call(t, FN_EXP, x, -1), -1);
    case 7: return op_list_mul(t, x, op_list_unary(t, OP_SIGN, x));
    case 8: return op_list_unary(t, OP_NEG, op_list_unary(t, OP_NEG, x));
    case 9:
        return op_list_add(t, op_list_mul(t, op_list_constant(t, 0.25), x),
                           op_list_mul(t, op_list_constant(t, 0.75), x));
    case 10: return op_list_call(t, FN_ATAN, op_list_call(t, FN_TAN, x, -1), -1);
    }
    /* exponents that a float has */
    return op_list_pow(t, op_list_pow(t, x, op_list_constant(t, 0.125)), op_list_constant(t, 8.0));
}

static void test_errors_go_through_operations(void) {
    for (unsigned what = 0; what < 12; what++) {
        for (int tries = 0; tries < 10; tries++) {
            const double number =
                decimal() / 10.0; /* times an input, from 1 to 3: no more than 3 */
            const double off = fabs((double)(float)number / number - 1.0);
            op_list *t = op_list_new(0, 1);
            const int x =
                op_list_mul(t, op_list_constant(t, number), op_list_leaf(t, OP_INPUT, tries));
            t->result[0] =
                made_of(t, what == 10 ? op_list_mul(t, op_list_constant(t, 0.5), x) : x, what);
            const double bias = op_list_bias(t, t);
            /* three and two times the number, each off by its half unit, stand for once it */
            TEST_ASSERT_TRUE(bias <= 5.0 * 0x1p-24 && bias >= 0.0);
            if (what != 2 && what != 9 && what != 4 && what != 5) {
                const double wanted =
                    what == 10 ? fabs((double)(float)(0.5 * number) / (0.5 * number) - 1.0) : off;
                TEST_ASSERT_DOUBLE_WITHIN(1e-4 * wanted + 1e-13, wanted, bias);
            }
            op_list_free(t);
        }
    }
}

/* A sine of radians is off by what its slope makes of them. */
static void test_errors_go_through_phases(void) {
    for (int tries = 0; tries < 40; tries++) {
        const double offset = dice_between(&die, 0.1, 1.4);
        const double rad = decimal() / 10.0;
        const double off = (double)(float)rad - rad;
        const double angle = offset + rad;
        const bool is_sine = tries % 2 == 0;
        const double value = is_sine ? sin(angle) : cos(angle);
        const double slope = is_sine ? cos(angle) : -sin(angle);
        op_list *t = op_list_new(0, 1);
        const int phase = op_list_phase(t, NULL, offset, op_list_constant(t, rad));
        t->result[0] = op_list_unary(t, is_sine ? OP_SIN : OP_COS, phase);
        const double wanted = fabs(slope * off / value);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * wanted + 1e-13, wanted, op_list_bias(t, t));
        op_list_free(t);
    }
}

/* --- lists whose freedoms are known ------------------------------------------------------------------------------ */

/* A sum of products with constants: it can be multiplied for nothing. `which` tells its leaves from those of others. */
static int free_sum(op_list *t, int which) {
    const int x = op_list_leaf(t, OP_LINEAR, which);
    const int y = op_list_leaf(t, OP_RATE, which);
    const int z = op_list_mul(t, op_list_constant(t, decimal()), op_list_mul(t, x, y));
    const int w = op_list_mul(t, op_list_constant(t, decimal()), op_list_mul(t, y, y));
    return op_list_add(t, z, w);
}

/* That, and so many leaves as they are: multiplying it multiplies them. */
static int raw_sum(op_list *t, int which, int raws) {
    int sum = free_sum(t, which);
    for (int k = 0; k < raws; k++) {
        sum = op_list_add(t, sum, op_list_leaf(t, OP_INPUT, 10 * which + k));
    }
    return sum;
}

static bool multiplies_raw(const op_list_freedoms *f, int k) {
    bool any = false;
    for (int i = f->length / 3; i < f->length; i++) {
        any = any || f->exponent[k * f->length + i] != 0.0;
    }
    return any;
}

/* Results of list `made` are those of `t`. */
static void expect_same_results(const op_list *t, const op_list *made) {
    static double v[EVALUATED_MOST];
    double wanted[8];
    TEST_ASSERT_EQUAL_INT(t->results, made->results);
    evaluated(t, v);
    for (int i = 0; i < t->results; i++) {
        wanted[i] = v[t->result[i]];
    }
    evaluated(made, v);
    for (int i = 0; i < t->results; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-11 * (1.0 + fabs(wanted[i])), wanted[i], v[made->result[i]]);
    }
}

/* Every freedom, by any number: the same results; and without raw values no operation more, `if_alone`: where no product with
 * a constant is taken twice, in two ways. */
static void expect_free(const op_list *t, const op_list_freedoms *f, bool if_alone) {
    double *times = calloc((size_t)f->length, sizeof *times);
    TEST_ASSERT_NOT_NULL(times);
    for (int k = 0; k < f->count; k++) {
        const double *exponent = f->exponent + k * f->length;
        const double x = dice_between(&die, 0.3, 3.0);
        double least = (double)INFINITY;
        for (int i = 0; i < f->length; i++) {
            times[i] = pow(x, exponent[i]);
            least = exponent[i] != 0.0 ? fmin(least, fabs(exponent[i])) : least;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, least); /* they begin with one */
        op_list *made = op_list_multiplied(t, times);
        expect_same_results(t, made);
        if (if_alone && !multiplies_raw(f, k)) {
            TEST_ASSERT_TRUE(op_list_operations(made) <= op_list_operations(t));
        }
        op_list_free(made);
    }
    free(times);
}

static int without_raw(const op_list_freedoms *f) {
    int count = 0;
    for (int k = 0; k < f->count; k++) {
        count += !multiplies_raw(f, k);
    }
    return count;
}

/* Numerators and denominators of sums that are free: each quotient has one freedom, and a root one that is half as much. */
static void test_a_quotient_has_one_freedom(void) {
    for (unsigned c = 0; c < dice_cases(60); c++) {
        const int quotients = 1 + (int)dice_one_of(&die, 4);
        op_list *t = op_list_new(0, quotients);
        int above[4];
        int below[4];
        double power[4];
        for (int k = 0; k < quotients; k++) {
            const bool by_root = dice_one_of(&die, 3) == 0;
            above[k] = free_sum(t, 3 * k);
            below[k] = free_sum(t, 3 * k + 1);
            power[k] = by_root ? 0.5 : 1.0;
            t->result[k] =
                op_list_div(t, above[k], by_root ? op_list_unary(t, OP_SQRT, below[k]) : below[k]);
        }
        op_list_freedoms f = op_list_freedoms_of(t);
        TEST_ASSERT_EQUAL_INT(3 * t->count, f.length);
        TEST_ASSERT_EQUAL_INT(quotients, without_raw(&f));
        for (int k = 0; k < quotients; k++) {
            bool found = false;
            for (int i = 0; i < f.count; i++) {
                const double *e = f.exponent + i * f.length;
                found = found || e[above[k]] != 0.0;
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, e[above[k]], power[k] * e[below[k]]);
            }
            TEST_ASSERT_TRUE(found);
        }
        expect_free(t, &f, true);
        op_list_freedoms_free(&f);
        op_list_free(t);
    }
}

/* With leaves in the sums, the freedom multiplies them: for one or two of these it is there, for three it is not. */
static void test_few_raw_values_are_multiplied(void) {
    for (int raws = 0; raws <= 3; raws++) {
        for (int in_denominator = 0; in_denominator < 2; in_denominator++) {
            op_list *t = op_list_new(0, 1);
            const int one = raw_sum(t, 0, raws);
            const int other = free_sum(t, 1);
            t->result[0] = in_denominator ? op_list_div(t, other, one) : op_list_div(t, one, other);
            op_list_freedoms f = op_list_freedoms_of(t);
            bool whole = false;
            for (int k = 0; k < f.count; k++) {
                const double *e = f.exponent + k * f.length;
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, e[one], e[other]);
                whole = whole || e[one] != 0.0;
            }
            TEST_ASSERT_EQUAL(raws < 3, whole);
            TEST_ASSERT_EQUAL_INT(raws == 0, without_raw(&f));
            expect_free(t, &f, true);
            op_list_freedoms_free(&f);
            op_list_free(t);
        }
    }
}

/* --- any list ------------------------------------------------------------------------------------------------------ */

static int some_operation(op_list *t, int a, int b) {
    const double two[2] = {1.0, -0.5};
    switch (dice_one_of(&die, 15)) {
    case 0: return op_list_sub(t, a, b);
    case 1:
        return op_list_div(
            t, a, op_list_add(t, op_list_unary(t, OP_ABS, b), op_list_constant(t, decimal())));
    case 2: return op_list_unary(t, OP_SQRT, op_list_unary(t, OP_ABS, a));
    case 3: return op_list_unary(t, OP_SIN, op_list_phase(t, two, 0.5, a));
    case 4: return op_list_unary(t, OP_COS, op_list_phase(t, two, 0.0, -1));
    case 5: return op_list_call(t, FN_MIN, a, b);
    case 6: return op_list_call(t, FN_MAX, a, b);
    case 7: return op_list_unary(t, OP_SIGN, a);
    case 8: return op_list_call(t, FN_ATAN2, a, b);
    case 9: return op_list_pow(t, op_list_unary(t, OP_ABS, a), op_list_constant(t, 0.3));
    case 10: return op_list_unary(t, OP_NEG, a);
    case 11: return op_list_mul(t, op_list_constant(t, decimal()), a);
    case 12: return op_list_mul(t, a, b);
    case 13: return op_list_leaf(t, dice_one_of(&die, 2) == 0 ? OP_ACCEL : OP_TIME, 0);
    }
    return op_list_add(t, a, b);
}

static op_list *some_list(void) {
    static double v[EVALUATED_MOST];
    int value[60];
    int count = 4;
    op_list *t = op_list_new(2, 1 + (int)dice_one_of(&die, 3));
    for (int k = 0; k < 4; k++) {
        value[k] = k == 3 ? op_list_noise(t, 5) : op_list_leaf(t, k == 0 ? OP_RATE : OP_INPUT, k);
    }
    const int wanted = 6 + (int)dice_one_of(&die, 20);
    while (count < wanted) {
        const int made = some_operation(t, value[dice_one_of(&die, (unsigned)count)],
                                        value[dice_one_of(&die, (unsigned)count)]);
        evaluated(t, v);
        if (isfinite(v[made]) && fabs(v[made]) < 1e3 && fabs(v[made]) > 1e-3) {
            value[count++] = made;
        }
    }
    for (int i = 0; i < t->results; i++) {
        t->result[i] = value[count - 1 - (int)dice_one_of(&die, 3)];
    }
    op_list_prune(t);
    op_list_order(t);
    return t;
}

/* Multiplied by one it is the same list, and by what it may be multiplied by, or by anything, the same results: what does not
 * fit is made up for. */
static void test_multiplied_lists_compute_the_same(void) {
    const long blocks = blocks_in_use();
    for (unsigned c = 0; c < dice_cases(few_or_all(usual_or(60, 20), 400)); c++) {
        op_list *t = some_list();
        double *times = calloc(3 * (size_t)t->count + 1, sizeof *times);
        TEST_ASSERT_NOT_NULL(times);
        for (int i = 0; i < 3 * t->count; i++) {
            times[i] = 1.0;
        }
        op_list *same = op_list_multiplied(t, times);
        expect_same_results(t, same);
        TEST_ASSERT_TRUE(op_list_operations(same) <= op_list_operations(t));
        op_list_free(same);
        for (int i = 0; i < 3 * t->count; i++) {
            times[i] = exp2((double)dice_one_of(&die, 3) - 1.0);
        }
        op_list *other = op_list_multiplied(t, times);
        expect_same_results(t, other);
        op_list_free(other);
        op_list_freedoms f = op_list_freedoms_of(t);
        expect_free(t, &f, false);
        op_list_freedoms_free(&f);
        free(times);
        TEST_ASSERT_FALSE(op_list_bias(t, t) < 0.0); /* or no number, where there is no telling */
        op_list_free(t);
    }
    TEST_ASSERT_TRUE(blocks_in_use() == blocks);
}

/* Where the product with this constant stands. */
static int place_of(const op_list *t, double constant) {
    int place = -1;
    double number;
    for (int i = 0; i < t->count; i++) {
        const bool is = t->ops[i].code == OP_MUL && op_list_is_constant(t, t->ops[i].a, &number);
        place = is && number == constant ? i : place;
    }
    return place;
}

/* Products that operands are made of stand in one order, that of the second first: whatever order a compiler has for the
 * arguments of a call, a scene's code and its hash are the same. */
static void test_operands_are_entered_in_one_order(void) {
    for (int what = 0; what < 6; what++) {
        op_list *t = op_list_new(0, 1);
        const int x = op_list_leaf(t, OP_INPUT, 0);
        const int y = op_list_leaf(t, OP_INPUT, 1);
        const int a = op_list_mul(t, op_list_constant(t, 0.375), op_list_mul(t, x, x));
        const int b = op_list_mul(t, op_list_constant(t, 0.75), op_list_mul(t, y, y));
        t->result[0] = what == 0   ? op_list_add(t, a, b)
                       : what == 1 ? op_list_sub(t, a, b)
                       : what == 2 ? op_list_call(t, FN_MIN, a, b)
                       : what == 3 ? op_list_call(t, FN_MAX, a, b)
                       : what == 4 ? op_list_call(t, FN_ATAN2, a, b)
                                   : op_list_pow(t, a, b);
        op_list_prune(t);
        double times[3 * 20];
        TEST_ASSERT_TRUE(t->count <= 20);
        for (int i = 0; i < 3 * t->count; i++) {
            times[i] = 1.0;
        }
        op_list *made = op_list_multiplied(t, times);
        TEST_ASSERT_TRUE(place_of(made, 0.75) >= 0);
        TEST_ASSERT_TRUE(place_of(made, 0.75) < place_of(made, 0.375));
        op_list_free(made);
        op_list_free(t);
    }
}

void suite_tape_freed(void) {
    die = dice_of("tape_freed", 4190);
    RUN_TEST(test_a_constants_error_is_the_results);
    RUN_TEST(test_errors_go_through_operations);
    RUN_TEST(test_errors_go_through_phases);
    RUN_TEST(test_a_quotient_has_one_freedom);
    RUN_TEST(test_few_raw_values_are_multiplied);
    RUN_TEST(test_multiplied_lists_compute_the_same);
    RUN_TEST(test_operands_are_entered_in_one_order);
}
