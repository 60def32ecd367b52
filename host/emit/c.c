/* c.c: a scene as C. Every operation of the list becomes one statement, so that the compiler has the
 * same operations in the same order as the interpreter. Constants are written in hexadecimal: the
 * float build rounds the double exactly as the interpreter does. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "emit.h"

static const char *const method_names[] = {"WH_EULER", "WH_SEMI_IMPLICIT_EULER", "WH_HEUN",
                                           "WH_RK4"};

/* An operand: constants stand in place. */
static const char *operand(const tape *t, int a, char text[static 48]) {
    if (t->ops[a].code == OP_CONSTANT) {
        const double value = t->ops[a].value;
        snprintf(text, 48, value < 0.0 ? "(-WH_R(%a))" : "WH_R(%a)", fabs(value));
    } else {
        snprintf(text, 48, "x%d", a);
    }
    return text;
}

static void write_phase(FILE *out, const tape *t, int i) {
    const op *o = &t->ops[i];
    char b[48];
    const char *plus = "";
    fprintf(out, "    wh_real s%d;\n    wh_real c%d;\n    wh_sincos(", i, i);
    if (o->value != 0.0) {
        fprintf(out, "WH_TURN(%a, %" PRIu32 "U)", o->value, engine_phase_of_constant(o->value));
        plus = " + ";
    }
    for (int k = 0; k < t->angles && o->turns != NULL; k++) {
        if (o->turns[k] == 1) {
            fprintf(out, "%sphase[%d]", plus, k);
        } else if (o->turns[k] != 0) {
            fprintf(out, "%s(wh_phase)%d * phase[%d]", plus, o->turns[k], k);
        }
        plus = o->turns[k] != 0 ? " + " : plus;
    }
    if (o->b >= 0) {
        fprintf(out, "%swh_phase_from_rad(%s)", plus, operand(t, o->b, b));
    }
    fprintf(out, ", &s%d, &c%d);\n", i, i);
}

static void write_operation(FILE *out, const tape *t, int i) {
    const op *o = &t->ops[i];
    char a[48];
    char b[48];
    if (o->code == OP_CONSTANT) {
        return;
    }
    if (o->code == OP_PHASE) {
        write_phase(out, t, i);
        return;
    }
    if (o->code >= OP_ADD) {
        operand(t, o->a, a);
        if (o->b >= 0) {
            operand(t, o->b, b);
        }
    }
    fprintf(out, "    const wh_real x%d = ", i);
    switch (o->code) {
    case OP_LINEAR: fprintf(out, "linear[%d]", o->a); break;
    case OP_RATE: fprintf(out, "rate[%d]", o->a); break;
    case OP_INPUT: fprintf(out, "input[%d]", o->a); break;
    case OP_TIME: fprintf(out, "wh_scene_time_s(scene, state)"); break;
    case OP_RADIANS: fprintf(out, "wh_angle_to_rad(angle[%d])", o->a); break;
    case OP_SIN: fprintf(out, "s%d", o->a); break;
    case OP_COS: fprintf(out, "c%d", o->a); break;
    case OP_ADD: fprintf(out, "%s + %s", a, b); break;
    case OP_SUB: fprintf(out, "%s - %s", a, b); break;
    case OP_MUL: fprintf(out, "%s * %s", a, b); break;
    case OP_DIV: fprintf(out, "%s / %s", a, b); break;
    case OP_NEG: fprintf(out, "-%s", a); break;
    case OP_SQRT: fprintf(out, "WH_SQRT(%s)", a); break;
    case OP_ABS: fprintf(out, "WH_ABS(%s)", a); break;
    case OP_SIGN: fprintf(out, "(wh_real)((%s > WH_R(0.0)) - (%s < WH_R(0.0)))", a, a); break;
    case OP_MIN: fprintf(out, "%s < %s ? %s : %s", b, a, b, a); break;
    case OP_MAX: fprintf(out, "%s > %s ? %s : %s", b, a, b, a); break;
    default: fprintf(out, "WH_R(0.0) /* not offered by the core */"); break;
    }
    fprintf(out, ";\n");
}

static bool uses(const tape *t, op_code code) {
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == code) {
            return true;
        }
    }
    return false;
}

static bool uses_phase(const tape *t) {
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == OP_PHASE && t->ops[i].turns != NULL) {
            return true;
        }
    }
    return false;
}

static void write_body(FILE *out, const tape *t, const char *result) {
    char text[48];
    for (int i = 0; i < t->count; i++) {
        write_operation(out, t, i);
    }
    for (int i = 0; i < t->results; i++) {
        fprintf(out, "    %s[%d] = %s;\n", result, i, operand(t, t->result[i], text));
    }
    fprintf(out, "}\n\n");
}

static void write_ignored(FILE *out, bool used, const char *name) {
    if (!used) {
        fprintf(out, "    (void)%s;\n", name);
    }
}

static void write_right_hand_side(FILE *out, const program *p) {
    const tape *t = p->step;
    const bool second = p->form == WH_SECOND_ORDER;
    if (second) {
        fprintf(out, "WH_INLINE void accelerations(const void *model, const wh_phase *phase,\n"
                     "                             const wh_real *linear, const wh_real *rate,\n"
                     "                             const wh_real *input, wh_real *result) {\n");
    } else {
        fprintf(out, "WH_INLINE void slopes(const void *model, const wh_phase *phase,\n"
                     "                      const wh_real *linear, const wh_real *input,\n"
                     "                      wh_real *result) {\n");
    }
    fprintf(out, "    (void)model;\n");
    write_ignored(out, uses_phase(t), "phase");
    write_ignored(out, uses(t, OP_LINEAR), "linear");
    if (second) {
        write_ignored(out, uses(t, OP_RATE), "rate");
    }
    write_ignored(out, uses(t, OP_INPUT), "input");
    write_body(out, t, "result");
}

static void write_observer(FILE *out, const program *p) {
    const tape *t = p->observe;
    fprintf(out, "static void observe(const wh_scene *scene, const wh_state *state, "
                 "wh_real *output) {\n");
    write_ignored(out, uses(t, OP_TIME), "scene");
    if (uses_phase(t)) {
        fprintf(out,
                "    wh_phase phase[%d];\n    for (int i = 0; i < %d; i++) {\n"
                "        phase[i] = wh_phase_of(state->angle[i]);\n    }\n",
                p->angles, p->angles);
    }
    if (uses(t, OP_RADIANS)) {
        fprintf(out, "    const wh_angle *angle = state->angle;\n");
    }
    if (uses(t, OP_LINEAR)) {
        fprintf(out, "    const wh_real *linear = state->real;\n");
    }
    if (uses(t, OP_RATE)) {
        fprintf(out, "    const wh_real *rate = state->real + %d;\n", p->coordinates - p->angles);
    }
    if (uses(t, OP_INPUT)) {
        fprintf(out, "    const wh_real *input = state->input;\n");
    }
    if (!uses_phase(t) && !uses(t, OP_RADIANS) && !uses(t, OP_LINEAR) && !uses(t, OP_RATE) &&
        !uses(t, OP_INPUT) && !uses(t, OP_TIME)) {
        fprintf(out, "    (void)state;\n");
    }
    write_body(out, t, "output");
}

static void write_starts(FILE *out, const program *p, const instance *inst) {
    double *angle_rad = calloc((size_t)p->angles + 1, sizeof *angle_rad);
    double *real = calloc((size_t)p->reals + 1, sizeof *real);
    if (angle_rad == NULL || real == NULL) {
        abort();
    }
    program_start(p, inst, angle_rad, real);
    if (p->angles > 0) {
        fprintf(out, "static const wh_angle start_angle[%d] = {", p->angles);
        for (int i = 0; i < p->angles; i++) {
            fprintf(out, "%sWH_TURN(%a, INT64_C(%" PRId64 "))", i > 0 ? ", " : "", angle_rad[i],
                    engine_angle_of_start(angle_rad[i]));
        }
        fprintf(out, "};\n");
    }
    if (p->reals > 0) {
        fprintf(out, "static const wh_real start_real[%d] = {", p->reals);
        for (int i = 0; i < p->reals; i++) {
            fprintf(out, "%sWH_R(%a)", i > 0 ? ", " : "", real[i]);
        }
        fprintf(out, "};\n");
    }
    if (p->inputs > 0) {
        fprintf(out, "static const wh_real start_input[%d] = {", p->inputs);
        for (int i = 0; i < p->inputs; i++) {
            fprintf(out, "%sWH_R(%a)", i > 0 ? ", " : "", inst->input[i]);
        }
        fprintf(out, "};\n");
    }
    fprintf(out, "\n");
    free(angle_rad);
    free(real);
}

static void write_scene(FILE *out, const program *p, const instance *inst,
                        const engine_settings *settings) {
    const double steps = floor(inst->until_s / inst->step_s + 0.5);
    fprintf(out, "const wh_scene %s = {\n    .name = \"%s\",\n    .form = %s,\n    .method = %s,\n",
            inst->name, inst->name,
            p->form == WH_SECOND_ORDER ? "WH_SECOND_ORDER" : "WH_FIRST_ORDER",
            method_names[settings->method]);
    fprintf(out, "    .angles = %d,\n    .reals = %d,\n    .inputs = %d,\n    .outputs = %d,\n",
            p->angles, p->reals, p->inputs, p->outputs);
    fprintf(out, "    .compensated = %s,\n    .step_s = WH_R(%a),\n    .steps = %.0fU,\n",
            settings->compensated ? "true" : "false", inst->step_s,
            steps < 4294967295.0 ? steps : 4294967295.0);
    fprintf(out, "    .start_angle = %s,\n", p->angles > 0 ? "start_angle" : "NULL");
    fprintf(out, "    .start_real = %s,\n", p->reals > 0 ? "start_real" : "NULL");
    fprintf(out, "    .start_input = %s,\n", p->inputs > 0 ? "start_input" : "NULL");
    fprintf(out, "    .model = NULL,\n    .model_hash = UINT64_C(0x%016" PRIx64 "),\n",
            program_hash(p));
    fprintf(out, "    .advance = advance,\n    .observe = %s,\n};\n",
            p->outputs > 0 ? "observe" : "NULL");
}

bool emit_c_name_is_free(const char *name) {
    static const char *const taken[] = {
        "auto",       "break",   "case",     "char",        "const",
        "continue",   "default", "do",       "double",      "else",
        "enum",       "extern",  "float",    "for",         "goto",
        "if",         "inline",  "int",      "long",        "register",
        "restrict",   "return",  "short",    "signed",      "sizeof",
        "static",     "struct",  "switch",   "typedef",     "union",
        "unsigned",   "void",    "volatile", "while",       "bool",
        "true",       "false",   "main",     "NULL",        "accelerations",
        "slopes",     "advance", "observe",  "start_angle", "start_real",
        "start_input"};
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++) {
        if (strcmp(name, taken[i]) == 0) {
            return false;
        }
    }
    return strncmp(name, "wh_", 3) != 0 && strncmp(name, "WH_", 3) != 0 && name[0] != '_';
}

static void write_banner(FILE *out, const equations *e, const program *p, const char *file) {
    const tape_cost cost = tape_count(p->step);
    fprintf(out, "/* Generated by whirl from %s: do not edit.\n *\n", file);
    fprintf(out, " * scene        %s\n * model hash   0x%016" PRIx64 "\n", e->instance->name,
            program_hash(p));
    fprintf(out,
            " * a right-hand side: %d additions and products, %d divisions, %d square roots,\n"
            " *                    %d pairs of sine and cosine\n *\n",
            cost.arithmetic, cost.divisions, cost.roots, cost.waves);
    fprintf(out, " * Components of the state, SI units, angles in turns (2^32 steps each):\n");
    for (int i = 0; i < p->angles; i++) {
        fprintf(out, " *   angle[%d]  %s\n", i, e->unknowns[p->angle[i].unknown].symbol->name);
    }
    for (int i = 0; i < p->reals; i++) {
        fprintf(out, " *   real[%d]   %s", i, e->unknowns[p->real[i].unknown].symbol->name);
        for (int k = 0; k < p->real[i].primes; k++) {
            fputc('\'', out);
        }
        fputc('\n', out);
    }
    const mechanism *m = e->instance->mechanism;
    for (int i = 0; i < m->input_count; i++) {
        fprintf(out, " *   input[%d]  %s\n", i, m->inputs[i]->name);
    }
    for (int i = 0; i < m->output_count; i++) {
        fprintf(out, " *   output[%d] %s\n", i, m->outputs[i]->name);
    }
    for (int i = m->output_count; i < p->outputs; i++) {
        const int k = (i - m->output_count) / 2;
        fprintf(out, " *   output[%d] %s%s, from its momentum\n", i,
                e->unknowns[p->conserved->unknown[k]].symbol->name,
                (i - m->output_count) % 2 == 0 ? "" : "'");
    }
    fprintf(out, " */\n");
}

void emit_c(FILE *out, const equations *e, const program *p, const engine_settings *settings,
            const char *file) {
    const bool second = p->form == WH_SECOND_ORDER;
    const int components = second ? p->coordinates : p->angles + p->reals;
    write_banner(out, e, p, file);
    fprintf(out, "#define WH_COORDS %d\n#include \"core/step.h\"\n\nextern const wh_scene %s;\n\n",
            components, e->instance->name);
    write_starts(out, p, e->instance);
    write_right_hand_side(out, p);
    fprintf(out,
            "static wh_status advance(const wh_scene *scene, wh_state *state) {\n"
            "    (void)scene;\n    return %s(NULL, %s, %s, %s, %dU, %dU,\n"
            "                          WH_R(%a), state);\n}\n\n",
            second ? "wh_step_second" : "wh_step_first", second ? "accelerations" : "slopes",
            method_names[settings->method], settings->compensated ? "true" : "false", p->angles,
            second ? p->coordinates : p->reals, e->instance->step_s);
    if (p->outputs > 0) {
        write_observer(out, p);
    }
    write_scene(out, p, e->instance, settings);
}
