/* test_tape_entered.c: operations that are entered at random (host/image/op_list.c): they come to what was asked for, by another
 * evaluation; none stands there twice, and each is in the one form that there is for it; what is found and what is dropped,
 * by looking at all of them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "evaluated.h"
#include "host/image/op_list.h"
#include "unity.h"

void suite_tape_entered(void);

enum { ANGLES = 2, LEAVES = 3, POOL = 400, ENTERED = 330 };

static dice die;
static op_list *list;
static int pool[POOL];
static double meant[POOL];
static int pooled;

static void expect_near(double wanted, double got) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-8 * (1e-3 + fabs(wanted)), wanted, got);
}

/* --- entering at random ---------------------------------------------------------------------------------------- */

static int entered_leaf(double *value) {
    static const op_code codes[] = {OP_LINEAR, OP_RATE, OP_INPUT, OP_ACCEL, OP_RADIANS, OP_TIME};
    static const double constants[] = {0.0, 1.0, -1.0, 2.0, 0.5, -0.0, 3.25};
    const int which = (int)dice_one_of(&die, LEAVES);
    if (dice_one_of(&die, 3) == 0) {
        *value = dice_one_of(&die, 3) == 0 ? dice_between(&die, -2.0, 2.0)
                                           : constants[dice_one_of(&die, 7)];
        return op_list_constant(list, *value);
    }
    if (dice_one_of(&die, 12) == 0) {
        *value = which / 9.0;
        return op_list_noise(list, (uint32_t)which);
    }
    const op_code code = codes[dice_one_of(&die, 6)];
    *value = evaluated_leaf(code, which);
    return op_list_leaf(list, code, which);
}

static int entered_wave(int radians, double value, double *wave) {
    double multiple[ANGLES];
    double phase = dice_one_of(&die, 2) == 0 ? 0.0 : dice_between(&die, -1.0, 1.0);
    const double offset = phase;
    for (int k = 0; k < ANGLES; k++) {
        multiple[k] = dice_one_of(&die, 3) == 0   ? 0.0
                      : dice_one_of(&die, 2) == 0 ? dice_between(&die, -2.0, 2.0)
                                                  : (double)dice_one_of(&die, 5) - 2.0;
        phase += multiple[k] * evaluated_leaf(OP_PHASE, k);
    }
    phase += radians >= 0 ? value : 0.0;
    const int entered = op_list_phase(list, multiple, offset, radians);
    const op *o = &list->ops[entered];
    for (int k = 0; k < ANGLES; k++) { /* whole numbers are turns, others parts */
        const bool whole = multiple[k] == floor(multiple[k]);
        TEST_ASSERT_TRUE((o->turns != NULL ? o->turns[k] : 0) == (whole ? multiple[k] : 0.0));
        TEST_ASSERT_TRUE((o->parts != NULL ? o->parts[k] : 0.0) == (whole ? 0.0 : multiple[k]));
    }
    const bool is_sine = dice_one_of(&die, 2) == 0;
    *wave = is_sine ? sin(phase) : cos(phase);
    return op_list_unary(list, is_sine ? OP_SIN : OP_COS, entered);
}

/* One of two values, which are at a and at b of the list. */
static int entered_operation(int a, double x, int b, double y, double *value) {
    static const double exponents[] = {2.0, 3.0, 0.5, 1.5, -1.0, -2.0, -0.5, 7.0, 0.3, 1.0, 0.0};
    const double e = exponents[dice_one_of(&die, 11)];
    switch (dice_one_of(&die, 14)) {
    case 0:
    case 1: *value = x + y; return op_list_add(list, a, b);
    case 2:
    case 3: *value = x - y; return op_list_sub(list, a, b);
    case 4:
    case 5:
    case 6: *value = x * y; return op_list_mul(list, a, b);
    case 7: *value = x / y; return op_list_div(list, a, b);
    case 8: *value = -x; return op_list_unary(list, OP_NEG, a);
    case 9: *value = fabs(x); return op_list_unary(list, OP_ABS, a);
    case 10: *value = sqrt(x); return op_list_unary(list, OP_SQRT, a);
    case 11: *value = pow(x, e); return op_list_power(list, a, e);
    case 12: *value = pow(x, y); return op_list_pow(list, a, b);
    }
    const function_id f = (function_id)dice_one_of(&die, FUNCTIONS);
    *value = number_call(f, x, y);
    return op_list_call(list, f, a, function_arguments(f) == 2 ? b : -1);
}

static void keep(int at, double value) {
    if (pooled < POOL) {
        pool[pooled] = at;
        meant[pooled++] = value;
    }
}

static void enter_some(void) {
    list = op_list_new(ANGLES, 4);
    pooled = 0;
    for (int i = 0; i < 6; i++) {
        double value;
        const int at = entered_leaf(&value);
        keep(at, value == 0.0 ? 0.0 : value);
    }
    while (pooled < ENTERED) {
        const int p = (int)dice_one_of(&die, (unsigned)pooled);
        const int q = (int)dice_one_of(&die, (unsigned)pooled);
        double value = 0.0;
        const unsigned what = dice_one_of(&die, 8);
        const int at = what == 0 ? entered_leaf(&value)
                       : what == 1
                           ? entered_wave(what % 2 == 0 ? -1 : pool[p], meant[p], &value)
                           : entered_operation(pool[p], meant[p], pool[q], meant[q], &value);
        /* what has no value, or whose digits or sign are gone, is taken by nothing more; there is one zero */
        const bool is_zero = value == 0.0 && list->ops[at].code == OP_CONSTANT;
        if (isfinite(value) && ((fabs(value) < 1e6 && fabs(value) > 1e-3) || is_zero)) {
            keep(at, is_zero ? 0.0 : value);
        }
    }
}

/* --- forms ----------------------------------------------------------------------------------------------------- */

static bool is_number(int i, double *value) {
    *value = list->ops[i].value;
    return list->ops[i].code == OP_CONSTANT;
}

static bool is_code(int i, op_code code) { return list->ops[i].code == code; }

static bool is_one_form(const op *o) {
    double x = 0.0;
    double y = 0.0;
    const bool takes = op_rows[o->code].values > 0;
    const bool fixed_a = takes && is_number(o->a, &x);
    const bool fixed_b = takes && o->b >= 0 && is_number(o->b, &y);
    const bool negated = takes && (is_code(o->a, OP_NEG) || (o->b >= 0 && is_code(o->b, OP_NEG)));
    const bool zero = (fixed_a && x == 0.0) || (fixed_b && y == 0.0);
    const bool both = fixed_a && fixed_b;
    const op_kind kind = op_rows[o->code].kind;
    if (kind != OP_IS_BINARY && kind != OP_IS_CALL && kind != OP_IS_PHASE && o->b != -1) {
        return false; /* what is not there is -1 everywhere: equal ones are found by it */
    }
    if (kind == OP_IS_CONSTANT && o->a != -1) {
        return false;
    }
    if (o->code == OP_CONSTANT) {
        return o->value != 0.0 || !signbit(o->value);
    }
    if (o->code == OP_ADD) {
        return !both && !zero && !negated && o->a <= o->b;
    }
    if (o->code == OP_SUB) {
        return !both && !zero && !negated && o->a != o->b;
    }
    if (o->code == OP_MUL && fixed_a) {
        const op *of = &list->ops[o->b];
        const bool again = of->code == OP_MUL && is_number(of->a, &y);
        return !fixed_b && !zero && fabs(x) != 1.0 && !negated && !again;
    }
    if (o->code == OP_MUL) {
        return !fixed_b && !negated && o->a <= o->b;
    }
    if (o->code == OP_DIV) {
        return !fixed_b && !zero && !is_code(o->b, OP_NEG);
    }
    if (o->code == OP_NEG) {
        return !fixed_a && !is_code(o->a, OP_NEG) && !is_code(o->a, OP_SUB);
    }
    if (o->code == OP_SQRT || o->code == OP_ABS || o->code == OP_SIGN) {
        return !fixed_a;
    }
    return o->code != OP_POW || !fixed_b ||
           (y > 0.0 && (y == floor(y) ? y > 64.0 : 2.0 * y != floor(2.0 * y) || y > 32.0));
}

static bool same_op(const op *x, const op *y) {
    bool same = x->code == y->code && x->function == y->function && x->a == y->a && x->b == y->b &&
                x->value == y->value;
    for (int k = 0; k < ANGLES; k++) {
        same = same && (x->turns != NULL ? x->turns[k] : 0) == (y->turns != NULL ? y->turns[k] : 0);
        same = same &&
               (x->parts != NULL ? x->parts[k] : 0.0) == (y->parts != NULL ? y->parts[k] : 0.0);
    }
    return same;
}

static void expect_each_once(void) {
    for (int i = 0; i < list->count; i++) {
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_FALSE(same_op(&list->ops[i], &list->ops[k]));
        }
    }
}

/* Every sum, difference, product and quotient of two operations is found where it is, and nowhere else. */
static void expect_found(void) {
    static const op_code codes[] = {OP_ADD, OP_SUB, OP_MUL, OP_DIV};
    for (int tries = 0; tries < 400; tries++) {
        const op_code code = codes[dice_one_of(&die, 4)];
        int a = (int)dice_one_of(&die, (unsigned)list->count);
        int b = (int)dice_one_of(&die, (unsigned)list->count);
        const op *some = &list->ops[dice_one_of(&die, (unsigned)list->count)];
        if (some->code == code) {
            const bool swapped = dice_one_of(&die, 2) == 0;
            a = swapped ? some->b : some->a;
            b = swapped ? some->a : some->b;
        }
        int wanted = -1;
        for (int i = 0; i < list->count; i++) {
            const op *o = &list->ops[i];
            const bool other = o->a == b && o->b == a && (code == OP_ADD || code == OP_MUL);
            if (o->code == code && ((o->a == a && o->b == b) || other)) {
                wanted = i;
            }
        }
        TEST_ASSERT_EQUAL_INT(wanted, op_list_find_binary(list, code, a, b));
    }
}

static void test_entered_operations_come_to_what_was_asked(void) {
    static double v[EVALUATED_MOST];
    for (unsigned c = 0; c < dice_cases(few_or_all(usual_or(30, 8), 200)); c++) {
        enter_some();
        evaluated(list, v);
        for (int i = 0; i < pooled; i++) {
            expect_near(meant[i], v[pool[i]]);
        }
        for (int i = 0; i < list->count; i++) {
            const op *o = &list->ops[i];
            if (!is_one_form(o)) {
                printf("  operation %d is %d of %d and %d, %d and %d\n", i, (int)o->code, o->a,
                       o->b, o->a >= 0 ? (int)list->ops[o->a].code : -1,
                       o->b >= 0 ? (int)list->ops[o->b].code : -1);
            }
            TEST_ASSERT_TRUE_MESSAGE(is_one_form(o), "there is another form");
        }
        expect_each_once();
        expect_found();
        op_list_free(list);
    }
}

/* --- what is dropped ------------------------------------------------------------------------------------------- */

static void mark(bool *needed, int i) {
    int operand[2];
    needed[i] = true;
    for (int k = op_list_operands(&list->ops[i], operand); k > 0; k--) {
        mark(needed, operand[k - 1]);
    }
}

static int uses_of(int i) {
    int uses = 0;
    int operand[2];
    for (int k = 0; k < list->count; k++) {
        for (int n = op_list_operands(&list->ops[k], operand); n > 0; n--) {
            uses += operand[n - 1] == i;
        }
    }
    for (int k = 0; k < list->results; k++) {
        uses += list->result[k] == i;
    }
    return uses;
}

/* 1/y, which nothing else wants, times x is x/y. */
static bool is_reciprocal(int i) {
    double one;
    return is_code(i, OP_DIV) && is_number(list->ops[i].a, &one) && one == 1.0 && uses_of(i) == 1;
}

static void test_what_no_result_needs_is_dropped(void) {
    static double v[EVALUATED_MOST];
    const long blocks = blocks_in_use();
    for (unsigned c = 0; c < dice_cases(few_or_all(usual_or(40, 10), 200)); c++) {
        bool needed[EVALUATED_MOST] = {false};
        double wanted[4];
        enter_some();
        for (int i = 0; i < list->results; i++) {
            const int p = (int)dice_one_of(&die, (unsigned)pooled);
            list->result[i] = pool[p];
            wanted[i] = meant[p];
        }
        op_list_prune(list);
        evaluated(list, v);
        for (int i = 0; i < list->results; i++) {
            TEST_ASSERT_TRUE(list->result[i] >= 0 && list->result[i] < list->count);
            expect_near(wanted[i], v[list->result[i]]);
            mark(needed, list->result[i]);
        }
        for (int i = 0; i < list->count; i++) {
            const op *o = &list->ops[i];
            TEST_ASSERT_TRUE(needed[i]);
            TEST_ASSERT_FALSE(o->code == OP_MUL && (is_reciprocal(o->a) || is_reciprocal(o->b)));
        }
        expect_found();
        op_list_free(list);
    }
    TEST_ASSERT_TRUE(blocks_in_use() == blocks);
}

/* --- powers ----------------------------------------------------------------------------------------------------- */

static int count_of(op_code code) {
    int count = 0;
    for (int i = 0; i < list->count; i++) {
        count += list->ops[i].code == code;
    }
    return count;
}

/* By squares: as many products as the exponent has binary digits, and ones among them, less two. */
static void test_powers_take_few_products(void) {
    static double v[EVALUATED_MOST];
    for (int half = 1; half <= 160; half++) {
        for (int sign = 0; sign < 2; sign++) {
            const double e = half / 2.0;
            const int whole = half / 2;
            const bool by_root = half % 2 == 1 && e <= 32.0;
            const bool by_products = half % 2 == 0 && whole <= 64;
            int products = 0;
            for (int left = whole; left > 1; left /= 2) {
                products += 1 + left % 2;
            }
            list = op_list_new(0, 1);
            const int x = op_list_leaf(list, OP_LINEAR, 1);
            const int at = op_list_power(list, x, sign == 0 ? e : -e);
            evaluated(list, v);
            expect_near(pow(v[x], sign == 0 ? e : -e), v[at]);
            const bool plain = by_root || by_products;
            TEST_ASSERT_EQUAL_INT(plain ? products + (by_root && whole > 0) : 0, count_of(OP_MUL));
            TEST_ASSERT_EQUAL_INT(by_root, count_of(OP_SQRT));
            TEST_ASSERT_EQUAL_INT(!plain, count_of(OP_POW));
            TEST_ASSERT_EQUAL_INT(sign, count_of(OP_DIV));
            op_list_free(list);
        }
    }
}

/* Whole numbers that an int holds. */
static void test_what_turns_a_phase(void) {
    static const double whole[] = {0.0, 1.0, -3.0, 2147483647.0, -2147483647.0};
    static const double not_whole[] = {0.5, -1e-9, 2147483648.0, -2147483648.0, 1e300, 3.0000001};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(op_list_is_whole(whole[i]));
    }
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_FALSE(op_list_is_whole(not_whole[i]));
    }
}

/* A function of a constant is one: nothing is left to evaluate. */
static void test_functions_of_constants(void) {
    die = dice_of("functions of constants", 4133);
    list = op_list_new(ANGLES, 1);
    for (int i = 0; i < 200; i++) {
        const double x = dice_between(&die, 0.0, 6.0) * (i % 2 == 0 ? 1.0 : -1.0);
        const struct {
            op_code code;
            double value;
        } rows[] = {{OP_SIN, sin(x)},
                    {OP_COS, cos(x)},
                    {OP_SQRT, sqrt(fabs(x))},
                    {OP_ABS, fabs(x)},
                    {OP_SIGN, x > 0.0 ? 1.0 : -1.0}};
        for (unsigned k = 0; k < sizeof rows / sizeof rows[0]; k++) {
            const double from = rows[k].code == OP_SQRT ? fabs(x) : x;
            double is = 0.0;
            const int made = op_list_unary(list, rows[k].code, op_list_constant(list, from));
            TEST_ASSERT_TRUE(op_list_is_constant(list, made, &is));
            TEST_ASSERT_DOUBLE_WITHIN(1e-15, rows[k].value, is);
        }
    }
    op_list_free(list);
}

void suite_tape_entered(void) {
    die = dice_of("tape_entered", 4170);
    RUN_TEST(test_entered_operations_come_to_what_was_asked);
    RUN_TEST(test_what_no_result_needs_is_dropped);
    RUN_TEST(test_powers_take_few_products);
    RUN_TEST(test_what_turns_a_phase);
    RUN_TEST(test_functions_of_constants);
}
