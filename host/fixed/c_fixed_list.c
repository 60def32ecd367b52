/* c_fixed_list.c: each operation one statement. What engine_fixed.c computes of numbers and shifts stands here with them in
 * place, so that a compiler folds them. */
#include "c_fixed_list.h"

/* A list of more operations than this is called at each stage and not inlined there. */
enum { INLINED_MOST = 80 };

void c_fixed_number(FILE *out, int32_t number) {
    fprintf(out, number < 0 ? "(-INT32_C(%" PRIu32 "))" : "INT32_C(%" PRIu32 ")",
            number < 0 ? 0U - (uint32_t)number : (uint32_t)number);
}

static bool is_constant(const fixed_list *l, fixed_operand from) {
    return l->op[from.op].code == FIXED_CONSTANT;
}

static void taken(FILE *out, const fixed_list *l, fixed_operand from) {
    if (is_constant(l, from)) {
        c_fixed_number(out, from.number);
    } else if (from.shift == 0) {
        fprintf(out, "x%d", from.op);
    } else {
        fprintf(out, "wh_fixed_round(x%d, %d)", from.op, from.shift);
    }
}

static void factor(FILE *out, const fixed_list *l, fixed_operand from) {
    if (is_constant(l, from)) {
        c_fixed_number(out, (int32_t)((uint32_t)from.number << (unsigned)from.shift));
    } else if (from.shift == 0) {
        fprintf(out, "x%d", from.op);
    } else {
        fprintf(out, "wh_fixed_left(x%d, %d)", from.op, from.shift);
    }
}

static void pair(FILE *out, const fixed_list *l, const fixed_op *o, const char *function) {
    fprintf(out, "%s(", function);
    taken(out, l, o->a);
    fputs(", ", out);
    taken(out, l, o->b);
    fputc(')', out);
}

static int waves(const fixed_list *l) {
    int count = 0;
    for (int i = 0; i < l->count; i++) {
        count += l->op[i].used && l->op[i].code == FIXED_PHASE;
    }
    return count;
}

static void phase(FILE *out, const fixed_list *l, int i) {
    const fixed_op *o = &l->op[i];
    fprintf(out, "    int32_t s%d;\n    int32_t c%d;\n    wh_fixed_sincos%s(UINT32_C(%" PRIu32 ")",
            i, i, waves(l) > 1 ? "_shared" : "", o->offset);
    for (int k = 0; k < l->angles && o->turns != NULL; k++) {
        if (o->turns[k] == 1) {
            fprintf(out, " + phase[%d]", k);
        } else if (o->turns[k] != 0) {
            fprintf(out, " + (uint32_t)INT32_C(%d) * phase[%d]", o->turns[k], k);
        }
    }
    fprintf(out, ", &s%d, &c%d);\n    (void)s%d;\n    (void)c%d;\n", i, i, i, i);
}

static void quotient(FILE *out, const fixed_list *l, int i) {
    const fixed_op *o = &l->op[i];
    fprintf(out, "    const uint32_t %c%d = (%s(uint32_t)x%d) << %d;\n", o->spread > 0 ? 'u' : 'd',
            i, o->negated ? "0U - " : "", o->b.op, o->zeros);
    if (o->spread == 1) { /* none or one */
        fprintf(out, "    const int z%d = (int)(~u%d >> 31);\n", i, i);
    } else if (o->spread > 1) {
        fprintf(out, "    const int z%d = wh_fixed_zeros(u%d);\n", i, i);
    }
    if (o->spread > 0) {
        fprintf(out, "    const uint32_t d%d = u%d << z%d;\n", i, i, i);
    }
    const bool shifts = o->spread > 0 && o->follows;
    fprintf(out, "    const int32_t x%d = %swh_fixed_mul(%s", i, o->negated ? "-" : "",
            shifts ? "wh_fixed_left(" : "");
    factor(out, l, o->a);
    if (shifts) {
        fprintf(out, ", z%d)", i);
    }
    fprintf(out, ", wh_fixed_reciprocal(d%d), %d", i, o->by);
    if (o->spread > 0 && !o->follows) {
        fprintf(out, " - z%d", i);
    }
    fputs(");\n", out);
}

static void value(FILE *out, const fixed_list *l, const fixed_op *o) {
    switch (o->code) {
    case FIXED_CONSTANT: c_fixed_number(out, o->a.number); break;
    case FIXED_LINEAR: fprintf(out, "linear[%d]", o->index); break;
    case FIXED_RATE: fprintf(out, "rate[%d]", o->index); break;
    case FIXED_INPUT: fprintf(out, "input[%d]", o->index); break;
    case FIXED_SINE: fprintf(out, "s%d", o->a.op); break;
    case FIXED_COSINE: fprintf(out, "c%d", o->a.op); break;
    case FIXED_SUM: pair(out, l, o, "wh_fixed_add"); break;
    case FIXED_DIFFERENCE: pair(out, l, o, "wh_fixed_sub"); break;
    case FIXED_LEAST: pair(out, l, o, "wh_fixed_least"); break;
    case FIXED_MOST: pair(out, l, o, "wh_fixed_most"); break;
    case FIXED_PRODUCT:
        fputs("wh_fixed_mul(", out);
        factor(out, l, o->a);
        fputs(", ", out);
        factor(out, l, o->b);
        fprintf(out, ", %d)", o->by);
        break;
    case FIXED_SAME:
        fputs(o->negated ? "-" : "", out);
        taken(out, l, o->a);
        break;
    case FIXED_ABS:
        fputs("wh_fixed_size(", out);
        taken(out, l, o->a);
        fputc(')', out);
        break;
    case FIXED_SIGN: fprintf(out, "wh_fixed_sign(x%d, %d)", o->a.op, o->bits); break;
    case FIXED_PHASE:
    case FIXED_QUOTIENT: break; /* not in one expression */
    }
}

/* A constant stands in place, but where it is a result. */
static bool is_stated(const fixed_list *l, int i) {
    bool result = false;
    for (int k = 0; k < l->results; k++) {
        result = result || l->result[k] == i;
    }
    return l->op[i].used && (l->op[i].code != FIXED_CONSTANT || result);
}

static void body(FILE *out, const fixed_list *l) {
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        if (!is_stated(l, i)) {
            continue;
        }
        if (o->code == FIXED_PHASE) {
            phase(out, l, i);
        } else if (o->code == FIXED_QUOTIENT) {
            quotient(out, l, i);
        } else {
            fprintf(out, "    const int32_t x%d = ", i);
            value(out, l, o);
            fputs(";\n", out);
        }
    }
    for (int i = 0; i < l->results; i++) {
        fprintf(out, "    result[%d] = x%d;\n", i, l->result[i]);
    }
}

static int operations(const fixed_list *l) {
    int count = 0;
    for (int i = 0; i < l->count; i++) {
        count += l->op[i].used && l->op[i].code != FIXED_CONSTANT;
    }
    return count;
}

void c_fixed_list(FILE *out, const fixed_list *l, bool second) {
    fprintf(out,
            "%s void accelerations(const uint32_t *phase, const int32_t *linear,%s\n"
            "    const int32_t *input, int32_t *result) {\n"
            "    (void)phase;\n    (void)linear;\n%s    (void)input;\n",
            operations(l) > INLINED_MOST ? "static WH_FIXED_CALLED" : "WH_FIXED_LIST",
            second ? " const int32_t *rate," : "", second ? "    (void)rate;\n" : "");
    body(out, l);
    fputs("}\n\n", out);
}
