/* test_tape.c: random operations that enter a list (host/image/op_list.c), compared with another evaluation. No
 * operation may occur twice, and each must have its canonical form. Finding and dropping are compared with a search
 * over all operations. Also scaling freedoms and gauges. */
#include "host/image/op_list.h"
#include "host/image/op_list_scaling.h"

#include "command.h"
#include "evaluated.h"

/* === suite tape_entered ======================================================================= */

enum { ANGLES = 2, LEAVES = 3, POOL = 400, ENTERED = 330 };

static dice die;
static op_list *list;
static int pool[POOL];
static double meant[POOL];
static int pooled;

static void expect_near(double wanted, double got) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-8 * (1e-3 + fabs(wanted)), wanted, got);
}

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
    for (int k = 0; k < ANGLES; k++) {
        /* integers are multiples of the angle, other numbers are parts of it */
        const bool whole = multiple[k] == floor(multiple[k]);
        TEST_ASSERT_TRUE((o->turns != NULL ? o->turns[k] : 0) == (whole ? multiple[k] : 0.0));
        TEST_ASSERT_TRUE((o->parts != NULL ? o->parts[k] : 0.0) == (whole ? 0.0 : multiple[k]));
    }
    const bool is_sine = dice_one_of(&die, 2) == 0;
    *wave = is_sine ? sin(phase) : cos(phase);
    return op_list_unary(list, is_sine ? OP_SIN : OP_COS, entered);
}

/* Enters a random operation on the operations a and b of the list, whose values are x and y. *value: its value. */
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
        /* values that are not finite, too large or too small are not used again; a constant zero is */
        const bool is_zero = value == 0.0 && list->ops[at].code == OP_CONSTANT;
        if (isfinite(value) && ((fabs(value) < 1e6 && fabs(value) > 1e-3) || is_zero)) {
            keep(at, is_zero ? 0.0 : value);
        }
    }
}

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
        return false; /* a missing operand is -1, so that equal operations compare equal */
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

TEST(tape_entered, entered_operations_have_right_values) {
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

/* Is operation i a quotient 1/y that is used only once? Then its product with x must become x/y. */
static bool is_reciprocal(int i) {
    double one;
    return is_code(i, OP_DIV) && is_number(list->ops[i].a, &one) && one == 1.0 && uses_of(i) == 1;
}

TEST(tape_entered, unused_operations_are_dropped) {
    static double v[EVALUATED_MOST];
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
}

static int count_of(op_code code) {
    int count = 0;
    for (int i = 0; i < list->count; i++) {
        count += list->ops[i].code == code;
    }
    return count;
}

/* Powers are computed by squaring: the number of products is the number of binary digits, plus that of ones, minus
 * two. */
TEST(tape_entered, powers_use_repeated_squaring) {
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

/* Phases may be multiplied only by integers in the range of int. */
TEST(tape_entered, phases_have_integer_factors) {
    static const double whole[] = {0.0, 1.0, -3.0, 2147483647.0, -2147483647.0};
    static const double not_whole[] = {0.5, -1e-9, 2147483648.0, -2147483648.0, 1e300, 3.0000001};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(op_list_is_whole(whole[i]));
    }
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_FALSE(op_list_is_whole(not_whole[i]));
    }
}

SUITE(tape_entered) { die = dice_of("tape_entered", 4170); }

/* === suite tape_freed ========================================================================= */
/* Parts of op_list_scale() (host/image/op_list_scaling.h). The lists have known scaling freedoms. A list that is
 * scaled by them must compute the same. */

/* A number from 0.001 to 10, a multiple of 1/999.7, which float does not represent. */
static double decimal(void) { return (double)(1 + dice_one_of(&die, 9990)) / 999.7; }

/* A sum of products with constants, which can be scaled without cost. `which` selects its leaves. */
static int free_sum(op_list *t, int which) {
    const int x = op_list_leaf(t, OP_LINEAR, which);
    const int y = op_list_leaf(t, OP_RATE, which);
    const int z = op_list_mul(t, op_list_constant(t, decimal()), op_list_mul(t, x, y));
    const int w = op_list_mul(t, op_list_constant(t, decimal()), op_list_mul(t, y, y));
    return op_list_add(t, z, w);
}

/* free_sum() plus `raws` leaves without constants, which scaling must multiply. */
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

/* The list is scaled by a random factor along each freedom. Its results must stay the same. With `if_alone`, a list whose
 * leaves all have a constant must not get more operations. */
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
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, least); /* the least exponent must be 1 */
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

/* In the sums, leaves without constants must be multiplied. Up to two such leaves are accepted, three are not. */
TEST(tape_freed, few_raw_values_are_multiplied) {
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
            free(f.exponent);
            op_list_free(t);
        }
    }
}

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

/* Scaled by one, the list must have the same results and no more operations. Scaled by other factors, it must have
 * the same results, because further products compensate. */
TEST(tape_freed, multiplied_lists_compute_the_same) {
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
        free(f.exponent);
        free(times);
        TEST_ASSERT_FALSE(op_list_bias(t, t) < 0.0); /* negative or NaN if the bias is not known */
        op_list_free(t);
    }
}

static int place_of(const op_list *t, double constant) {
    int place = -1;
    double number;
    for (int i = 0; i < t->count; i++) {
        const bool is = t->ops[i].code == OP_MUL && op_list_is_constant(t, t->ops[i].a, &number);
        place = is && number == constant ? i : place;
    }
    return place;
}

/* Products for operands must enter in a fixed sequence, those for the second operand first. Then code and hash do
 * not depend on the sequence in which a compiler evaluates arguments. */
TEST(tape_freed, operands_are_entered_in_one_order) {
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

SUITE(tape_freed) { die = dice_of("tape_freed", 4190); }

/* === suite tape_gauged ======================================================================== */
/* The gauges that op_list_scale() must find (host/image/op_list_scaling.h). Each list has a factor that makes all
 * its constants exact in float: a product of small primes. */

/* A sum of two products of leaves, with integers below 120 times `unit`. */
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

/* Scales the list. Then float must represent all constants, the results must be the same, and there must be no more
 * operations. */
static void expect_none_off(op_list *t) {
    double before[1];
    double after[1];
    const int operations = op_list_operations(t);
    results_of(t, before);
    const double bias = op_list_bias(t, t);
    TEST_ASSERT_TRUE(bias > 1e-10);
    op_list_scale(&t, 0);
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

/* Does float represent all multiples in sum_of()? Then there is no gauge to find. */
static bool is_held(double unit) {
    bool held = true;
    for (int number = 61; number < 120; number += 2) {
        held = held && (double)(float)(number * unit) == number * unit;
    }
    return held;
}

/* The units are powers of five, three and seven and their quotients, within the range of the search. */
TEST(tape_gauged, decimals_and_thirds_become_whole) {
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
                        op_list_free(t); /* not tested: float represents the constants */
                    }
                }
            }
        }
    }
}

/* Lists of up to 250 operations (with constants and leaves) are searched; longer lists must not change. */
TEST(tape_gauged, long_lists_do_not_change) {
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
        op_list_scale(&longer, 0);
        TEST_ASSERT_EQUAL(over == 1, hash == op_list_hash(longer));
        op_list_free(longer);
    }
}

SUITE(tape_gauged) { die = dice_of("tape_gauged", 4200); }
