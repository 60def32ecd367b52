/* c.c: a scene as C for the core. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "c_contacts.h"
#include "c_header.h"
#include "c_ledger.h"
#include "c_list.h"
#include "emit.h"
#include "host/base/room.h"
#include "host/number/hex.h"
#include "host/number/phase.h"

static void write_observer(FILE *out, const program *p) {
    const tape *t = p->observe;
    fprintf(out, "static void observe(const wh_scene *scene, const wh_state *state, "
                 "wh_real *output) {\n");
    c_list_ignore(out, c_list_uses(t, OP_TIME), "scene");
    if (c_list_uses_phase(t)) {
        fprintf(out,
                "    wh_phase phase[%d];\n    for (int i = 0; i < %d; i++) {\n"
                "        phase[i] = wh_phase_of(state->angle[i]);\n    }\n",
                p->angles, p->angles);
    }
    if (tape_reads_turns(t)) {
        fprintf(out, "    const wh_angle *angle = state->angle;\n");
    }
    if (c_list_uses(t, OP_LINEAR)) {
        fprintf(out, "    const wh_real *linear = state->real;\n");
    }
    if (c_list_uses(t, OP_RATE)) {
        fprintf(out, "    const wh_real *rate = state->real + %d;\n", p->coordinates - p->angles);
    }
    if (c_list_uses(t, OP_INPUT)) {
        fprintf(out, "    const wh_real *input = state->input;\n");
    }
    if (c_list_uses(t, OP_ACCEL)) {
        fprintf(out, "    wh_real accel[%d];\n    wh_contact_observe(&contacts, state, accel);\n",
                p->coordinates);
    }
    if (!c_list_uses_phase(t) && !tape_reads_turns(t) && !c_list_uses(t, OP_LINEAR) &&
        !c_list_uses(t, OP_RATE) && !c_list_uses(t, OP_INPUT) && !c_list_uses(t, OP_TIME) &&
        !c_list_uses(t, OP_ACCEL) && !c_list_uses(t, OP_NOISE)) {
        fprintf(out, "    (void)state;\n");
    }
    c_list_body(out, t, "output");
}

static void write_starts(FILE *out, const program *p, const instance *inst) {
    char hex[HEX_SIZE];
    double *angle_rad = room(p->angles, sizeof *angle_rad);
    double *real = room(p->reals, sizeof *real);
    program_start(p, inst, angle_rad, real);
    if (p->angles > 0) {
        fprintf(out, "static const wh_angle start_angle[%d] = {", p->angles);
        for (int i = 0; i < p->angles; i++) {
            fprintf(out, "%sWH_TURN(%s, INT64_C(%" PRId64 "))", i > 0 ? ", " : "",
                    hex_write(angle_rad[i], hex), phase_of_start(angle_rad[i]));
        }
        fprintf(out, "};\n");
    }
    if (p->reals > 0) {
        fprintf(out, "static const wh_real start_real[%d] = {", p->reals);
        for (int i = 0; i < p->reals; i++) {
            fprintf(out, "%sWH_R(%s)", i > 0 ? ", " : "", hex_write(real[i], hex));
        }
        fprintf(out, "};\n");
    }
    if (p->inputs > 0) {
        fprintf(out, "static const wh_real start_input[%d] = {", p->inputs);
        for (int i = 0; i < p->inputs; i++) {
            fprintf(out, "%sWH_R(%s)", i > 0 ? ", " : "", hex_write(inst->input[p->input[i]], hex));
        }
        fprintf(out, "};\n");
    }
    fprintf(out, "\n");
    free(angle_rad);
    free(real);
}

static void write_scene(FILE *out, const program *p, const instance *inst,
                        const engine_settings *settings) {
    char hex[HEX_SIZE];
    fprintf(out, "const wh_scene %s = {\n    .name = \"%s\",\n    .form = %s,\n    .method = %s,\n",
            inst->name, inst->name,
            p->form == WH_SECOND_ORDER ? "WH_SECOND_ORDER" : "WH_FIRST_ORDER",
            wh_methods[settings->method].name);
    fprintf(out, "    .angles = %d,\n    .reals = %d,\n    .inputs = %d,\n    .outputs = %d,\n",
            p->angles, p->reals, p->inputs, p->outputs);
    if (p->contacts != NULL) {
        fprintf(out, "    .contacts = %d,\n    .held = %d,\n", p->contacts->count,
                p->contacts->held);
    }
    if (p->ledger != NULL) {
        fprintf(out, "    .ledger = &ledger,\n");
    }
    fprintf(out,
            "    .compensated = %s,\n    .step_s = WH_R(%s),\n"
            "    .step = {UINT64_C(%" PRIu64 "), UINT64_C(%" PRIu64 ")},\n"
            "    .steps = UINT64_C(%" PRIu64 "),\n",
            settings->compensated ? "true" : "false", hex_write(inst->step_s, hex),
            inst->step.numerator, inst->step.denominator, inst->steps);
    fprintf(out, "    .start_angle = %s,\n", p->angles > 0 ? "start_angle" : "NULL");
    fprintf(out, "    .start_real = %s,\n", p->reals > 0 ? "start_real" : "NULL");
    fprintf(out, "    .start_input = %s,\n", p->inputs > 0 ? "start_input" : "NULL");
    fprintf(out, "    .model = NULL,\n    .model_hash = UINT64_C(0x%016" PRIx64 "),\n",
            program_hash(p));
    fprintf(out,
            "    .advance = advance,\n    .observe = %s,\n    .arithmetic = wh_arithmetic,\n};\n",
            p->outputs > 0 ? "observe" : "NULL");
}

bool emit_c_name_is_free(const char *name) {
    static const char *const taken[] = {
        "auto", "break", "case", "char", "const", "continue", "default", "do", "double", "else",
        "enum", "extern", "float", "for", "goto", "if", "inline", "int", "long", "register",
        "restrict", "return", "short", "signed", "sizeof", "static", "struct", "switch", "typedef",
        "union", "unsigned", "void", "volatile", "while", "bool", "true", "false", "main", "NULL",
        "accelerations", "slopes", "advance", "observe", "start_angle", "start_real", "start_input",
        "contacts", "contact_signals", "contact_forces", "contact_sets", "contact_table",
        "contact_target", "ledger", "ledger_powers", "ledger_levels", "ledger_accounts",
        "ledger_inputs",
        /* types of the headers that core/scene.h includes, and macros of the GNU dialects */
        "int8_t", "int16_t", "int32_t", "int64_t", "uint8_t", "uint16_t", "uint32_t", "uint64_t",
        "intptr_t", "uintptr_t", "intmax_t", "uintmax_t", "size_t", "ptrdiff_t", "wchar_t",
        "max_align_t", "offsetof", "typeof", "asm", "unix", "linux", "i386",
        /* functions that compilers know by their names: no variable may have those */
        "abort", "abs", "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "calloc",
        "cbrt", "ceil", "copysign", "cos", "cosh", "erf", "erfc", "exit", "exp", "exp2", "expm1",
        "fabs", "fdim", "floor", "fma", "fmax", "fmin", "fmod", "fprintf", "fputc", "fputs", "free",
        "frexp", "fscanf", "fwrite", "gamma", "hypot", "ilogb", "index", "isalnum", "isalpha",
        "isdigit", "isinf", "islower", "isnan", "isprint", "isspace", "isupper", "j0", "j1", "jn",
        "labs", "ldexp", "lgamma", "llabs", "log", "log10", "log1p", "log2", "logb", "lrint",
        "lround", "malloc", "memchr", "memcmp", "memcpy", "memmove", "memset", "modf", "nan",
        "nearbyint", "nextafter", "pow", "pow10", "printf", "putchar", "puts", "realloc",
        "remainder", "remquo", "rindex", "rint", "round", "scalb", "scalbln", "scalbn", "scanf",
        "significand", "signbit", "sin", "sincos", "sinh", "snprintf", "sprintf", "sqrt", "sscanf",
        "strcat", "strchr", "strcmp", "strcpy", "strcspn", "strdup", "strlen", "strncat", "strncmp",
        "strncpy", "strpbrk", "strrchr", "strspn", "strstr", "tan", "tanh", "tgamma", "tolower",
        "toupper", "trunc", "vprintf", "y0", "y1", "yn"};
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++) {
        if (strcmp(name, taken[i]) == 0) {
            return false;
        }
    }
    return strncmp(name, "wh_", 3) != 0 && strncmp(name, "WH_", 3) != 0 && name[0] != '_';
}

static void write_banner(FILE *out, const equations *e, const program *p, const char *file) {
    const tape_cost cost = tape_count(p->step);
    fputs("/* Generated by whirl from ", out);
    c_comment(out, file);
    fputs(": do not edit.\n *\n", out);
    fprintf(out, " * scene        %s\n * model hash   0x%016" PRIx64 "\n", e->instance->name,
            program_hash(p));
    fprintf(out,
            " * a right-hand side: %d additions and products, %d divisions, %d square roots,\n"
            " *                    %d pairs of sine and cosine",
            cost.arithmetic, cost.divisions, cost.roots, cost.waves);
    if (cost.calls > 0) {
        fprintf(out, ", %d functions of core/function.h", cost.calls);
    }
    fprintf(out, "\n *\n");
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
    for (int i = 0; i < p->inputs; i++) {
        fprintf(out, " *   input[%d]  %s\n", i, m->inputs[p->input[i]]->name);
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
    char hex[HEX_SIZE];
    const int components = second ? p->coordinates : p->angles + p->reals;
    write_banner(out, e, p, file);
    fprintf(out, "#define WH_COORDS %d\n", components);
    if (p->ledger != NULL) {
        c_ledger_bounds(out, p->ledger);
    }
    if (p->contacts != NULL) {
        c_contacts_include(out, p->contacts);
    } else {
        fprintf(out, "#include \"core/%s.h\"\n", p->ledger != NULL ? "ledger_step" : "step");
    }
    if (program_calls(p)) {
        fprintf(out, "#include \"core/function.h\"\n");
    }
    if (c_list_uses(p->observe, OP_NOISE)) {
        fprintf(out, "#include \"core/noise.h\"\n");
    }
    fprintf(out, "\nextern const wh_scene %s;\n\n", e->instance->name);
    write_starts(out, p, e->instance);
    c_list_function(out, p->step, second ? "accelerations" : "slopes", second,
                    p->contacts != NULL || p->ledger_asked);
    if (p->ledger != NULL) {
        c_ledger_write(out, p);
    }
    if (p->contacts != NULL) {
        c_contacts_write(out, p, settings, e->instance->step_s);
    } else if (p->ledger != NULL) {
        fprintf(
            out,
            "static wh_status advance(const wh_scene *scene, wh_state *state) {\n"
            "    (void)scene;\n    return wh_step_ledger(&ledger, NULL, accelerations, %s, %s,\n"
            "                          WH_R(%s), state);\n}\n\n",
            wh_methods[settings->method].name, settings->compensated ? "true" : "false",
            hex_write(e->instance->step_s, hex));
    } else {
        fprintf(out,
                "static wh_status advance(const wh_scene *scene, wh_state *state) {\n"
                "    (void)scene;\n    return %s(NULL, %s, %s, %s, %dU, %dU,\n"
                "                          WH_R(%s), state);\n}\n\n",
                second ? "wh_step_second" : "wh_step_first", second ? "accelerations" : "slopes",
                wh_methods[settings->method].name, settings->compensated ? "true" : "false",
                p->angles, second ? p->coordinates : p->reals, hex_write(e->instance->step_s, hex));
    }
    if (p->outputs > 0) {
        write_observer(out, p);
    }
    write_scene(out, p, e->instance, settings);
}
