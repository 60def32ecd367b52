#include "evaluated.h"
#include "test.h"

double evaluated_leaf(op_code code, int which) { return 0.6 + 0.3 * which + 0.11 * (int)code; }

static double operation_value(const op_list *t, const op *o, const double *v) {
    const double a = op_rows[o->code].values > 0 ? v[o->a] : 0.0;
    const double b = o->b >= 0 ? v[o->b] : 0.0;
    double phase = o->value + b;
    if (o->code == OP_PHASE) {
        for (int k = 0; k < t->angles; k++) {
            phase += (o->turns != NULL ? o->turns[k] : 0) * evaluated_leaf(OP_PHASE, k);
            phase += (o->parts != NULL ? o->parts[k] : 0.0) * evaluated_leaf(OP_PHASE, k);
        }
        return phase;
    }
    const op_kind kind = op_rows[o->code].kind;
    if (kind == OP_IS_CONSTANT) {
        return o->value;
    }
    if (kind == OP_IS_LEAF) {
        return o->code == OP_NOISE ? o->value / 9.0 : evaluated_leaf(o->code, o->a);
    }
    return o->code == OP_SIN    ? sin(a)
           : o->code == OP_COS  ? cos(a)
           : o->code == OP_ADD  ? a + b
           : o->code == OP_SUB  ? a - b
           : o->code == OP_MUL  ? a * b
           : o->code == OP_DIV  ? a / b
           : o->code == OP_NEG  ? -a
           : o->code == OP_SQRT ? sqrt(a)
           : o->code == OP_ABS  ? fabs(a)
           : o->code == OP_SIGN ? (double)((a > 0.0) - (a < 0.0))
           : o->code == OP_MIN  ? fmin(a, b)
           : o->code == OP_MAX  ? fmax(a, b)
           : o->code == OP_POW  ? pow(a, b)
           : o->code == OP_CALL ? number_call(o->function, a, b)
                                : (double)NAN;
}

void evaluated(const op_list *t, double *v) {
    TEST_ASSERT_TRUE(t->count < EVALUATED_MOST);
    for (int i = 0; i < t->count; i++) {
        int operand[2];
        for (int k = op_list_operands(&t->ops[i], operand); k > 0; k--) {
            TEST_ASSERT_TRUE(operand[k - 1] >= 0 && operand[k - 1] < i);
        }
        v[i] = operation_value(t, &t->ops[i], v);
    }
}
