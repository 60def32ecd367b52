/* test_running_error.c: the bound on the round-off of an operation list, for random lists of every operation. By
 * definition, the bound is each operation's own rounding plus its operands' errors times the slopes. Here, the
 * slopes are finite differences. */
#include "command.h"
#include "host/engine/rounding.h"

enum { LEAVES = 6, ANGLES = 2, DRAWN = 14, MOST_OPS = 80 };

typedef struct drawn_list {
    op_list *list;
    double leaf[LEAVES];
    double phase_rad[ANGLES];
    double angle_rad[ANGLES];
    double value[MOST_OPS];
    double sine[MOST_OPS];
    double cosine[MOST_OPS];
} drawn_list;

static double phase_of(const drawn_list *l, const op *o) {
    double sum = o->value + (o->b >= 0 ? l->value[o->b] : 0.0);
    for (int i = 0; i < ANGLES; i++) {
        sum += (o->turns != NULL ? o->turns[i] * l->phase_rad[i] : 0.0) +
               (o->parts != NULL ? o->parts[i] * l->angle_rad[i] : 0.0);
    }
    return sum;
}

static double computed(const drawn_list *l, const op *o, double x, double y) {
    switch (o->code) {
    case OP_CONSTANT: return o->value;
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_ACCEL: return l->leaf[o->a];
    case OP_TIME: return 7.5;
    case OP_RADIANS: return l->angle_rad[o->a];
    case OP_PHASE: return phase_of(l, o);
    case OP_SIN: return sin(x);
    case OP_COS: return cos(x);
    case OP_ADD: return x + y;
    case OP_SUB: return x - y;
    case OP_MUL: return x * y;
    case OP_DIV: return x / y;
    case OP_NEG: return -x;
    case OP_SQRT: return sqrt(x);
    case OP_ABS: return fabs(x);
    case OP_SIGN: return x < 0.0 ? -1.0 : 1.0;
    case OP_MIN: return fmin(x, y);
    case OP_MAX: return fmax(x, y);
    case OP_CALL: return number_call(o->function, x, y);
    case OP_POW: return pow(x, y);
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break;
    }
    TEST_FAIL_MESSAGE("not drawn");
    return 0.0;
}

static bool takes_two(const op *o) {
    return op_rows[o->code].kind == OP_IS_BINARY ||
           (op_rows[o->code].kind == OP_IS_CALL && o->b >= 0);
}

static bool takes_one(const op *o) {
    return takes_two(o) || op_rows[o->code].kind == OP_IS_UNARY ||
           op_rows[o->code].kind == OP_IS_WAVE || op_rows[o->code].kind == OP_IS_CALL;
}

/* Computes the values. Returns false if a value is undefined, too large, or near a jump of its slope. */
static bool compute(drawn_list *l) {
    for (int i = 0; i < l->list->count; i++) {
        const op *o = &l->list->ops[i];
        const double x = takes_one(o) ? l->value[o->a] : 0.0;
        const double y = takes_two(o) ? l->value[o->b] : 0.0;
        l->value[i] = computed(l, o, x, y);
        l->sine[i] = sin(l->value[i]);
        l->cosine[i] = cos(l->value[i]);
        const bool jumps = o->code == OP_ABS || o->code == OP_SIGN || o->code == OP_CALL;
        const bool turns = o->code == OP_MIN || o->code == OP_MAX;
        if (!isfinite(l->value[i]) || fabs(l->value[i]) > 1e6 || (jumps && fabs(x) < 1e-3) ||
            (turns && fabs(x - y) < 1e-3) || (o->code == OP_POW && !(x > 1e-3))) {
            return false;
        }
    }
    return true;
}

/* Absolute slope by the first or second operand, from a difference over this part of the operand. */
static double slope(const drawn_list *l, const op *o, double x, double y, bool second,
                    double part) {
    const double step = part * fmax(1e-3, fabs(second ? y : x));
    const double up = second ? computed(l, o, x, y + step) : computed(l, o, x + step, y);
    const double down = second ? computed(l, o, x, y - step) : computed(l, o, x - step, y);
    return fabs(up - down) / (2.0 * step);
}

/* Stored values are not rounded, nor are the results of operations that change no digit. */
static bool is_exact(op_code code) {
    return code == OP_LINEAR || code == OP_RATE || code == OP_INPUT || code == OP_ACCEL ||
           code == OP_TIME || code == OP_RADIANS || code == OP_NEG || code == OP_ABS ||
           code == OP_SIGN || code == OP_MIN || code == OP_MAX;
}

static double phase_error(const drawn_list *l, const op *o, const double *error) {
    double sum = fabs(o->value) + (o->b >= 0 ? fabs(l->value[o->b]) + error[o->b] : 0.0);
    for (int i = 0; i < ANGLES; i++) {
        sum += (o->turns != NULL ? fabs(o->turns[i] * l->phase_rad[i]) : 0.0) +
               (o->parts != NULL ? fabs(o->parts[i] * l->angle_rad[i]) : 0.0);
    }
    return sum;
}

static void define(const drawn_list *l, double least, double part, double *error) {
    for (int i = 0; i < l->list->count; i++) {
        const op *o = &l->list->ops[i];
        const double x = takes_one(o) ? l->value[o->a] : 0.0;
        const double y = takes_two(o) ? l->value[o->b] : 0.0;
        error[i] = takes_one(o) ? slope(l, o, x, y, false, part) * error[o->a] : 0.0;
        error[i] += takes_two(o) ? slope(l, o, x, y, true, part) * error[o->b] : 0.0;
        if (o->code == OP_CONSTANT) { /* a constant that float represents is exact */
            error[i] = (double)(float)o->value == o->value ? 0.0 : fabs(o->value);
        } else if (o->code == OP_PHASE) {
            error[i] = phase_error(l, o, error);
        } else if (o->code == OP_SIN || o->code == OP_COS) {
            /* an error of one unit relative to 1, not to the result, as for a sine from a table */
            error[i] += 1.0;
        } else if (!is_exact(o->code)) {
            error[i] += fmax(fabs(l->value[i]), least);
        }
    }
}

static int draw_leaf(dice *d, op_list *t) {
    static const op_code leaves[] = {OP_LINEAR, OP_RATE, OP_INPUT, OP_ACCEL};
    switch (dice_one_of(d, 8)) {
    /* float does not represent this constant */
    case 0: return op_list_constant(t, dice_between(d, -2.0, 2.0));
    case 1: return op_list_constant(t, 0.25 * (1.0 + dice_one_of(d, 9)));
    case 2: return op_list_leaf(t, OP_TIME, 0);
    case 3: return op_list_leaf(t, OP_RADIANS, (int)dice_one_of(d, ANGLES));
    default: return op_list_leaf(t, leaves[dice_one_of(d, 4)], (int)dice_one_of(d, LEAVES));
    }
}

static int draw_wave(dice *d, op_list *t, int radians) {
    static const double multiples[] = {0.0, 1.0, -2.0, 3.0, 0.5, -1.25};
    const double multiple[ANGLES] = {multiples[dice_one_of(d, 6)], multiples[dice_one_of(d, 6)]};
    const double offset_rad = dice_one_of(d, 2) == 0 ? 0.0 : dice_between(d, -1.0, 1.0);
    const int phase = op_list_phase(t, multiple, offset_rad, dice_one_of(d, 2) == 0 ? radians : -1);
    return op_list_unary(t, dice_one_of(d, 2) == 0 ? OP_SIN : OP_COS, phase);
}

static int draw_op(dice *d, op_list *t, int a, int b) {
    static const op_code unary[] = {OP_SQRT, OP_ABS, OP_SIGN, OP_NEG};
    const function_id function = (function_id)dice_one_of(d, FUNCTIONS);
    switch (dice_one_of(d, 9)) {
    case 0: return op_list_add(t, a, b);
    case 1: return op_list_sub(t, a, b);
    case 2: return op_list_mul(t, a, b);
    case 3: return op_list_div(t, a, b);
    case 4: return op_list_unary(t, unary[dice_one_of(d, 4)], a);
    case 5: return op_list_pow(t, a, b);
    case 6: return draw_wave(d, t, a);
    default: return op_list_call(t, function, a, function_arguments(function) == 2 ? b : -1);
    }
}

/* Draws a list. Its results are its last operations and some others. */
static void draw_list(dice *d, drawn_list *l) {
    int made[LEAVES + DRAWN];
    l->list = op_list_new(ANGLES, 4);
    for (int i = 0; i < LEAVES; i++) {
        l->leaf[i] = dice_between(d, 0.2, 0.95) * (dice_one_of(d, 3) == 0 ? 3.0 : 1.0);
        made[i] = draw_leaf(d, l->list);
    }
    for (int i = 0; i < ANGLES; i++) {
        l->angle_rad[i] = dice_between(d, -20.0, 20.0);
        l->phase_rad[i] = remainder(l->angle_rad[i], 2.0 * acos(-1.0));
    }
    for (int i = 0; i < DRAWN; i++) {
        const unsigned known = LEAVES + (unsigned)i;
        made[known] = draw_op(d, l->list, made[dice_one_of(d, known)], made[dice_one_of(d, known)]);
    }
    for (int i = 0; i < 4; i++) {
        l->list->result[i] = made[LEAVES + DRAWN - 1 - i];
    }
    TEST_ASSERT_TRUE(l->list->count <= MOST_OPS);
}

TEST(running_error, drawn_lists) {
    dice d = dice_of("running_error", 2315);
    unsigned of_code[OPS] = {0};
    unsigned held = 0;
    for (unsigned n = few_or_all(3000, 60000); n > 0; n--) {
        drawn_list l;
        draw_list(&d, &l);
        const double least = dice_one_of(&d, 2) == 0 ? 0.0 : dice_between(&d, 0.1, 2.0);
        if (compute(&l)) {
            double wanted[MOST_OPS];
            double coarser[MOST_OPS];
            double got[4];
            const rounding_values at = {l.value, l.sine, l.cosine, l.phase_rad, l.angle_rad, least};
            define(&l, least, 1e-6, wanted);
            define(&l, least, 1e-5, coarser);
            rounding_of(l.list, &at, got);
            for (int i = 0; i < 4; i++) {
                const double error = wanted[l.list->result[i]];
                /* not compared if the difference reaches a sharp bend or the end of a function's range */
                if (fabs(coarser[l.list->result[i]] - error) < 1e-4 * error) {
                    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * error, error, got[i]);
                    held++;
                }
            }
            for (int i = 0; i < l.list->count; i++) {
                of_code[l.list->ops[i].code]++;
            }
        }
        op_list_free(l.list);
    }
    printf("  %u results\n", held);
    TEST_ASSERT_TRUE(held > 1000);
    for (int code = 0; code < OPS; code++) {
        const bool drawn =
            code != OP_NOISE && code != OP_CELL && code != OP_LINE && code != OP_CUBIC;
        TEST_ASSERT_TRUE(!drawn || of_code[code] > 20);
    }
}

/* A sum or a root of operands that are zero is exact, so its bound must be zero, except for underflow. */
TEST(running_error, bound_of_exact_zero_is_zero) {
    op_list *t = op_list_new(0, 2);
    const int x = op_list_leaf(t, OP_LINEAR, 0);
    const int y = op_list_leaf(t, OP_LINEAR, 1);
    t->result[0] = op_list_unary(t, OP_SQRT, op_list_mul(t, x, x));
    t->result[1] = op_list_add(t, x, y);
    const double value[8] = {0.0};
    const rounding_values at = {value, value, value, NULL, NULL, 0.0};
    double error[2] = {1.0, 1.0};
    rounding_of(t, &at, error);
    TEST_ASSERT_TRUE(error[0] == 0.0 && error[1] == 0.0);
    const rounding_values small = {value, value, value, NULL, NULL, 1e-38};
    rounding_of(t, &small, error);
    TEST_ASSERT_EQUAL_DOUBLE(1e-38, error[1]);
    TEST_ASSERT_TRUE(error[0] > 1e-38); /* at 0 the slope of the root is infinite */
    op_list_free(t);
}

/* In z/(x*y), the product exceeds float's largest number, so the quotient is lost in float, but not in double. */
TEST(running_error, float_overflow) {
    dice d = dice_of("running_error", 2316);
    op_list *t = op_list_new(0, 1);
    const int x = op_list_leaf(t, OP_LINEAR, 0);
    const int y = op_list_leaf(t, OP_LINEAR, 1);
    const int z = op_list_leaf(t, OP_LINEAR, 2);
    const int xy = op_list_mul(t, x, y);
    t->result[0] = op_list_div(t, z, xy);
    for (int k = 0; k < 100; k++) {
        double value[8] = {0.0};
        double error;
        value[x] = pow(10.0, dice_between(&d, 10.0, 30.0));
        value[y] = 3.4e38 / value[x] * exp(dice_between(&d, -20.0, 20.0));
        value[z] = pow(10.0, dice_between(&d, -30.0, 30.0));
        value[xy] = value[x] * value[y];
        value[t->result[0]] = value[z] / value[xy];
        const double v = value[t->result[0]];
        const bool beyond = value[xy] > 3.4028235677973366e38;
        const bool small = v < 0x1p-126;
        rounding_of(t, &(rounding_values){value, value, value, NULL, NULL, 0.0}, &error);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * v, 2.0 * v, error);
        rounding_of(t, &(rounding_values){value, value, value, NULL, NULL, 0x1p-126}, &error);
        const double wanted = (beyond ? 0x1p24 * v : v) + (small ? 0x1p-126 : v);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * wanted, wanted, error);
    }
    op_list_free(t);
}

/* A bound that is infinite must stay infinite after a division: z/(y + sqrt(x*w - y)), in which x*w - y is zero. */
TEST(running_error, infinite_bound_stays_infinite) {
    dice d = dice_of("running_error", 2317);
    op_list *t = op_list_new(0, 1);
    const int x = op_list_leaf(t, OP_LINEAR, 0);
    const int w = op_list_leaf(t, OP_LINEAR, 1);
    const int y = op_list_leaf(t, OP_LINEAR, 2);
    const int z = op_list_leaf(t, OP_LINEAR, 3);
    const int twice = op_list_mul(t, x, w);
    const int root = op_list_unary(t, OP_SQRT, op_list_sub(t, twice, y));
    const int divisor = op_list_add(t, y, root);
    t->result[0] = op_list_div(t, z, divisor);
    for (int k = 0; k < 50; k++) {
        double value[16] = {0.0};
        double error;
        value[x] = dice_between(&d, 1.0, 2.0);
        value[w] = dice_between(&d, 1.0, 2.0);
        value[twice] = value[y] = value[divisor] = value[x] * value[w];
        value[z] = dice_between(&d, 1.0, 2.0);
        value[t->result[0]] = value[z] / value[divisor];
        rounding_of(
            t, &(rounding_values){value, value, value, NULL, NULL, k % 2 == 0 ? 0.0 : 0x1p-126},
            &error);
        TEST_ASSERT_TRUE(isinf(error));
    }
    op_list_free(t);
}
