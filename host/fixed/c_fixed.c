/* c_fixed.c: C code of a scene in fixed point, with the step of engine_fixed.c. */
#include "host/fixed/c_fixed.h"

#include <inttypes.h>

#include "host/emit/c_header.h"
#include "host/emit/emit.h"
#include "host/fixed/fixed_list.h"

/* === a list in fixed point as C =============================================================== */

enum { INLINED_MOST = 80 }; /* a list with more operations is called at each stage, not inlined */

/* Writes a number in C. INT32_C() accepts no sign, so -5 becomes -INT32_C(5). */
static void c_fixed_number(FILE *out, int32_t number) {
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
    if (o->spread == 1) { /* the top bit decides between shifts by 0 and by 1 */
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
    case FIXED_QUOTIENT: break; /* written as several statements */
    }
}

static void body(FILE *out, const fixed_list *l) {
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        if (!o->used || (o->code == FIXED_CONSTANT && !fixed_is_result(l, i))) {
            continue; /* a constant gets a variable only if it is a result */
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

static void c_fixed_list(FILE *out, const fixed_list *l, bool second) {
    int operations = 0;
    for (int i = 0; i < l->count; i++) {
        operations += l->op[i].used && l->op[i].code != FIXED_CONSTANT;
    }
    fprintf(out,
            "%s void accelerations(const uint32_t *phase, const int32_t *linear,%s\n"
            "    const int32_t *input, int32_t *result) {\n"
            "    (void)phase;\n    (void)linear;\n%s    (void)input;\n",
            operations > INLINED_MOST ? "static WH_FIXED_CALLED" : "WH_FIXED_LIST",
            second ? " const int32_t *rate," : "", second ? "    (void)rate;\n" : "");
    body(out, l);
    fputs("}\n\n", out);
}

/* === the file around the list ================================================================= */

static void gained(FILE *out, fixed_gain g, const char *x) {
    if (g.shift > 0) {
        fprintf(out, "wh_fixed_mul(wh_fixed_left(%s, %d), ", x, g.shift);
    } else {
        fprintf(out, "wh_fixed_mul(%s, ", x);
    }
    c_fixed_number(out, g.number);
    fprintf(out, ", %d)", g.by);
}

/* Ends a statement that limits a component to its range. */
static void put_limits(FILE *out, const fixed_plan *p, int at) {
    fputs("), ", out);
    c_fixed_number(out, p->format[at].low);
    fputs(", ", out);
    c_fixed_number(out, p->format[at].high);
    fputs(", &saturated);\n", out);
}

/* Writes the expression for the increment of component i at a stage. */
static void put_more(FILE *out, const fixed_plan *p, int i, int stage) {
    const fixed_mover *m = &p->mover[i];
    if (!p->second) {
        fprintf(out, "wh_fixed_round(k%d[%d], %d)", stage - 1, i, m->to_kept - (stage == 3));
        return;
    }
    fputs("wh_fixed_round(", out);
    if (stage == 1) {
        fprintf(out, "half[%d]", i);
    } else {
        fprintf(out, "wh_fixed_add(half[%d], ", i);
        fprintf(out, "wh_fixed_mul_short(k%d[%d], %" PRId32 ", %d))", stage - 2, i,
                m->half_accel.number, m->half_accel.by);
    }
    fprintf(out, ", %d)", m->guard - (stage == 3));
}

static void put_stage(FILE *out, const fixed_plan *p, int stage) {
    const int angles = p->image->angles;
    for (int i = 0; i < p->coordinates; i++) {
        if (i < angles) {
            fprintf(out, "    phase[%d] = (uint32_t)state->angle[%d] + (uint32_t)", i, i);
        } else {
            fprintf(out, "    linear[%d] = wh_fixed_add(state->real[%d], ", i - angles, i - angles);
        }
        put_more(out, p, i, stage);
        fputs(i < angles ? ";\n" : ");\n", out);
        if (p->second) {
            fprintf(out,
                    "    rate[%d] = wh_fixed_add(old_rate[%d], wh_fixed_round(k%d[%d], %d));\n", i,
                    i, stage - 1, i, p->mover[i].to_kept - (stage == 3));
        }
    }
}

static void put_sixths(FILE *out, const fixed_mover *m, int i) {
    char x[80];
    snprintf(x, sizeof x, "k0[%d] + k3[%d] + 2 * (k1[%d] + k2[%d])", i, i, i, i);
    gained(out, m->third, x);
}

static void put_end(FILE *out, const fixed_plan *p) {
    const int angles = p->image->angles;
    char x[80];
    for (int i = 0; i < p->coordinates; i++) {
        const fixed_mover *m = &p->mover[i];
        if (i < angles) {
            fprintf(out, "    state->angle[%d] += ", i);
        } else {
            fprintf(out, "    state->real[%d] = wh_fixed_limit(wh_fixed_add(state->real[%d], ",
                    i - angles, i - angles);
        }
        if (p->second) {
            snprintf(x, sizeof x, "k0[%d] + k1[%d] + k2[%d]", i, i, i);
            fprintf(out, "wh_fixed_round(wh_fixed_add(2 * half[%d], ", i);
            gained(out, m->third_accel, x);
            fprintf(out, "), %d)", m->guard);
        } else {
            put_sixths(out, m, i);
        }
        if (i < angles) {
            fputs(";\n", out);
        } else {
            put_limits(out, p, i - angles);
        }
        if (p->second) {
            fprintf(out, "    state->real[%d] = wh_fixed_limit(wh_fixed_add(old_rate[%d], ",
                    p->linears + i, i);
            put_sixths(out, m, i);
            put_limits(out, p, p->linears + i);
        }
    }
}

static int at_least_one(int count) { return count > 0 ? count : 1; } /* C allows no empty arrays */

static void begin_step(FILE *out, const fixed_plan *p) {
    const int angles = p->image->angles;
    fprintf(out, "    uint32_t phase[%d];\n    int32_t linear[%d];\n", at_least_one(angles),
            at_least_one(p->linears));
    if (p->second) {
        fprintf(out, "    int32_t rate[%d];\n    int32_t half[%d];\n", p->coordinates,
                p->coordinates);
        fprintf(out, "    const int32_t *old_rate = state->real + %d;\n", p->linears);
    }
    for (int stage = 0; stage < 4; stage++) {
        fprintf(out, "    int32_t k%d[%d];\n", stage, p->coordinates);
    }
    fputs("    (void)scene;\n    (void)linear;\n    (void)phase;\n", out);
    for (int i = 0; i < angles; i++) {
        fprintf(out, "    phase[%d] = (uint32_t)state->angle[%d];\n", i, i);
    }
    for (int i = 0; i < p->coordinates && p->second; i++) {
        char x[40];
        snprintf(x, sizeof x, "old_rate[%d]", i);
        fprintf(out, "    half[%d] = ", i);
        gained(out, p->mover[i].half_rate, x);
        fputs(";\n", out);
    }
}

static void put_advance(FILE *out, const fixed_plan *p) {
    fputs("static wh_status advance(const wh_fixed_scene *scene, wh_fixed_state *state) {\n"
          "    const int32_t *input = state->input;\n"
          "    uint32_t saturated = state->saturated;\n",
          out);
    begin_step(out, p);
    fprintf(out, "    accelerations(phase, state->real, %sinput, k0);\n",
            p->second ? "old_rate, " : "");
    for (int stage = 1; stage < 4; stage++) {
        put_stage(out, p, stage);
        fprintf(out, "    accelerations(phase, linear, %sinput, k%d);\n", p->second ? "rate, " : "",
                stage);
    }
    put_end(out, p);
    fputs("    state->saturated = saturated;\n    state->steps++;\n    return WH_OK;\n}\n\n", out);
}

static void put_numbers(FILE *out, const char *name, const int32_t *number, int count) {
    if (count > 0) {
        fprintf(out, "static const int32_t %s[%d] = {", name, count);
        for (int i = 0; i < count; i++) {
            fputs(i > 0 ? ", " : "", out);
            c_fixed_number(out, number[i]);
        }
        fputs("};\n", out);
    }
}

static void put_starts(FILE *out, const fixed_plan *p) {
    const image *im = p->image;
    if (im->angles > 0) {
        fprintf(out, "static const int64_t start_angle[%d] = {", im->angles);
        for (int i = 0; i < im->angles; i++) {
            fprintf(out, "%sINT64_C(%" PRId64 ")", i > 0 ? ", " : "", p->start_angle[i]);
        }
        fputs("};\n", out);
    }
    put_numbers(out, "start_real", p->start_real, im->reals);
    put_numbers(out, "start_input", p->start_input, im->inputs);
    if (im->reals + im->inputs > 0) {
        fprintf(out, "static const wh_fixed_format formats[%d] = {\n", im->reals + im->inputs);
        for (int i = 0; i < im->reals + im->inputs; i++) {
            fprintf(out, "    {%d, ", p->format[i].bits);
            c_fixed_number(out, p->format[i].low);
            fputs(", ", out);
            c_fixed_number(out, p->format[i].high);
            fputs("}, /* ", out);
            c_comment(out, im->range[i].name);
            fprintf(out, ": %.6g to %.6g */\n", p->range[i].low, p->range[i].high);
        }
        fputs("};\n", out);
    }
    fputc('\n', out);
}

static void put_banner(FILE *out, const fixed_plan *p, const char *file) {
    fputs("/* " EMIT_BANNER " from ", out);
    c_comment(out, file);
    fprintf(out,
            ": do not edit.\n *\n * scene        %s, in fixed point\n * model hash   0x%016" PRIx64
            "\n",
            p->image->name, p->image->hash);
    fixed_plan_say(p, out, " * ");
    fputs(" */\n", out);
}

static void header_body(FILE *out, const void *of) {
    const fixed_plan *p = of;
    const image *im = p->image;
    fprintf(out,
            "/* Memory of wh_fixed_start(): in bytes, and in words of a uint64_t array. */\n"
            "#define %s_MEMORY_BYTES WH_FIXED_BYTES(%d, %d)\n"
            "#define %s_MEMORY_WORDS ((%s_MEMORY_BYTES + 7U) / 8U)\n\n",
            im->name, im->angles, im->reals + im->inputs, im->name, im->name);
    fputs("/* Indices for wh_fixed_angle(), wh_fixed_real(), wh_fixed_set_input(). */\nenum {\n",
          out);
    c_header_fixed_state(out, im);
    fprintf(out, "    %s_FIXED = 1\n};\n\n", im->name);
    c_header_strings(out, im);
    c_header_values(out, im);
    fputs(
        "/* The ranges. A value beyond its range is set to the range's end and counted in state.saturated. */\n",
        out);
    for (int i = 0; i < im->reals + im->inputs; i++) {
        c_header_range(out, im, i, p->range[i].low, p->range[i].high);
    }
    fputs("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n", out);
}

void c_fixed(FILE *out, const fixed_plan *p, const char *file) {
    const image *im = p->image;
    put_banner(out, p, file);
    fputs("#include \"core/fixed_scene.h\"\n\n", out);
    put_starts(out, p);
    c_fixed_list(out, p->list, p->second);
    put_advance(out, p);
    c_header_link(out, "fixed_scene", im->name, header_body, p);
    fprintf(out,
            "const wh_fixed_scene %s = {\n    .name = \"%s\",\n"
            "    .angles = %d,\n    .reals = %d,\n    .inputs = %d,\n"
            "    .steps = UINT64_C(%" PRIu64 "),\n",
            im->name, im->name, im->angles, im->reals, im->inputs, im->steps);
    fprintf(out, "    .format = %s,\n    .start_angle = %s,\n    .start_real = %s,\n",
            im->reals + im->inputs > 0 ? "formats" : "NULL",
            im->angles > 0 ? "start_angle" : "NULL", im->reals > 0 ? "start_real" : "NULL");
    fprintf(out,
            "    .start_input = %s,\n    .model = NULL,\n"
            "    .model_hash = UINT64_C(0x%016" PRIx64 "),\n    .advance = advance,\n};\n",
            im->inputs > 0 ? "start_input" : "NULL", im->hash);
}

void c_fixed_header(FILE *out, const fixed_plan *p, const char *file) {
    c_header_write(out, p->image, file, ", in fixed point", "fixed_scene", header_body, p);
}
