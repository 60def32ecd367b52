/* c_list.c: an operation list as C. Each operation is one statement, as in the interpreter. */
#include "host/emit/c_list.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "host/number/decimal.h"
#include "host/number/phase.h"

void op_text(FILE *out, const op_list *t, const op *o, const char *form, const op_style *style) {
    for (const char *at = form; *at != '\0'; at++) {
        if (*at != '$') {
            fputc(*at, out);
            continue;
        }
        at++;
        switch (*at) {
        case 'a': style->operand(out, t, o->a); break;
        case 'b': style->operand(out, t, o->b); break;
        case 'f': fputs(function_name(o->function), out); break;
        case 'o':
            style->operand(out, t, o->a);
            if (o->b >= 0) {
                fputs(", ", out);
                style->operand(out, t, o->b);
            }
            break;
        case 'n': /* "|| b != b", which is true if b is NaN */
            if (t->ops[o->b].code != OP_CONSTANT) {
                fputs(" || ", out);
                style->operand(out, t, o->b);
                fputs(" != ", out);
                style->operand(out, t, o->b);
            }
            break;
        case 'i': fprintf(out, "%d", o->a); break;
        case 'v': fprintf(out, "%.0f", o->value); break;
        default:
            if (style->leaf != NULL) {
                style->leaf(out, style->context, *at, o->a);
            }
            break;
        }
    }
}

/* === the list ================================================================================= */

/* Largest number of operations of an inlined list. Calls of longer lists save flash on the Cortex-M4F. */
enum { INLINED_MOST = 150 };

/* In lists of at least this length, the compiler should keep the operations' order (core/step/unroll.h). On the
 * Cortex-M4F, a list of 131 operations then takes 2 % fewer cycles, but a list of 67 would take 2 % more. */
enum { LONG_LEAST = 100 };

bool c_list_is_long(const op_list *t) { return op_list_operations(t) >= LONG_LEAST; }

static void write_operand(FILE *out, const op_list *t, int a) {
    if (t->ops[a].code == OP_CONSTANT) {
        const double value = t->ops[a].value;
        char hex[HEX_SIZE];
        fprintf(out, value < 0.0 ? "(-WH_R(%s))" : "WH_R(%s)", hex_write(fabs(value), hex));
    } else {
        fprintf(out, "x%d", a);
    }
}

/* Returns the sign before the phase's next term: " + " or "". */
static const char *write_turns(FILE *out, const op_list *t, const op *o) {
    const char *plus = "";
    if (o->value != 0.0 || (o->turns == NULL && o->parts == NULL && o->b < 0)) {
        char hex[HEX_SIZE];
        fprintf(out, "WH_TURN(%s, %" PRIu32 "U)", hex_write(o->value, hex),
                phase_of_constant(o->value));
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
    return plus;
}

static void write_phase(FILE *out, const op_list *t, int i) {
    const op *o = &t->ops[i];
    fprintf(out, "    wh_real s%d;\n    wh_real c%d;\n    wh_sincos(", i, i);
    const char *plus = write_turns(out, t, o);
    for (int k = 0; k < t->angles && o->parts != NULL; k++) {
        if (o->parts[k] != 0.0) {
            uint32_t whole;
            uint64_t part;
            char hex[HEX_SIZE];
            phase_factor(o->parts[k], &whole, &part);
            fprintf(out,
                    "%swh_phase_times(angle[%d], WH_FACTOR(%s, %" PRIu32 "U,\n"
                    "        UINT64_C(%" PRIu64 ")))",
                    plus, k, hex_write(o->parts[k], hex), whole, part);
            plus = " + ";
        }
    }
    if (o->b >= 0) {
        fprintf(out, "%swh_phase_from_rad(", plus);
        write_operand(out, t, o->b);
        fputc(')', out);
    }
    fprintf(out, ", &s%d, &c%d);\n", i, i);
    if (o->b >= 0) {
        fputs("    wh_sincos_of_range(", out);
        write_operand(out, t, o->b);
        fprintf(out, ", &s%d, &c%d);\n", i, i);
    }
}

static bool takes(const op_list *t, op_code code, int i) {
    bool found = false;
    for (int k = i + 1; k < t->count; k++) {
        found = found || (t->ops[k].code == code && t->ops[k].a == i);
    }
    return found;
}

static void write_cell(FILE *out, const op_list *t, int i) {
    const op_list_tables *of = &t->tables;
    fprintf(out, "    wh_real y%d;\n", i);
    if (of->folds) {
        fprintf(out, "    bool back%d;\n", i);
    }
    fprintf(out, "    const wh_real *row%d = wh_table_%s(cells, %dU, %dU, ", i,
            of->folds ? "half" : "cell", of->bits, of->count * of->terms);
    write_turns(out, t, &t->ops[i]);
    fprintf(out, ", &y%d", i);
    if (of->folds) {
        fprintf(out, ", &back%d", i);
    }
    fprintf(out, ");\n");
}

void c_list_cells(FILE *out, const op_list *t) {
    const char *const scales[] = {"WH_R", "WH_TABLE_B(WH_R", "WH_TABLE_C(WH_R", "WH_TABLE_D(WH_R"};
    const op_list_tables *of = &t->tables;
    const int width = of->count * of->terms;
    const int64_t numbers = (int64_t)width * ((int64_t)1 << of->bits);
    char hex[HEX_SIZE];
    if (of->count == 0) {
        return;
    }
    if (of->folds) {
        fprintf(out, "static const wh_real cells[WH_TABLE_HALF(%dU) * %d] WH_FLASH = {", of->bits,
                width);
    } else {
        fprintf(out, "static const wh_real cells[%" PRId64 "] WH_FLASH = {", numbers);
    }
    for (int64_t i = 0; i < numbers; i++) {
        const int term = (int)(i % of->terms);
        if (of->folds && i == numbers / 2 + width) {
            fprintf(out, "\n#if !WH_TABLE_FOLD");
        }
        fprintf(out, "%s%s(%s)%s", i % width == 0 ? "\n    " : " ", scales[term],
                hex_write(of->number[i], hex), term > 0 ? ")," : ",");
    }
    fprintf(out, "%s\n};\n\n", of->folds ? "\n#endif" : "");
}

static void write_operation(FILE *out, const op_list *t, int i) {
    static const op_style style = {write_operand, NULL, NULL};
    const op *o = &t->ops[i];
    const op_row *row = &op_rows[o->code];
    if (row->kind == OP_IS_CELL) {
        write_cell(out, t, i);
    } else if (row->kind == OP_IS_PHASE) {
        write_phase(out, t, i);
    } else if (row->kind != OP_IS_CONSTANT) {
        /* If tables.folds, only half of a table is stored. In the other half, an odd function has the opposite sign. */
        const bool mirrored = row->kind == OP_IS_LOOKUP && t->tables.folds &&
                              t->tables.odd[(int)o->value / t->tables.terms];
        fprintf(out, "    const wh_real x%d = %s", i, mirrored ? "wh_table_back(" : "");
        op_text(out, t, o, row->c, &style);
        if (mirrored) {
            fprintf(out, ", back%d)", o->a);
        }
        fprintf(out, ";\n");
    }
}

bool c_list_uses_phase(const op_list *t) { return op_list_waves(t) > 0 || op_list_has(t, OP_CELL); }

void c_list_body(FILE *out, const op_list *t, c_angles angles, const char *result) {
    int wave = 0;
    for (int i = 0; i < t->count; i++) {
        if (angles != C_WAVES || !op_list_is_wave(&t->ops[i])) {
            write_operation(out, t, i);
            continue;
        }
        if (takes(t, OP_SIN, i)) {
            fprintf(out, "    const wh_real s%d = wave[%d].sine;\n", i, wave);
        }
        if (takes(t, OP_COS, i)) {
            fprintf(out, "    const wh_real c%d = wave[%d].cosine;\n", i, wave);
        }
        wave++;
    }
    for (int i = 0; i < t->results; i++) {
        fprintf(out, "    %s[%d] = ", result, i);
        write_operand(out, t, t->result[i]);
        fputs(";\n", out);
    }
    fprintf(out, "}\n\n");
}

void c_list_ignore(FILE *out, bool used, const char *name) {
    if (!used) {
        fprintf(out, "    (void)%s;\n", name);
    }
}

void c_list_function(FILE *out, const op_list *t, c_angles angles, const char *name, bool second,
                     const char *linkage) {
    linkage = op_list_operations(t) > INLINED_MOST ? "static" : linkage;
    const int indent = (int)(strlen(linkage) + sizeof " void (" - 1 + strlen(name));
    fprintf(out, "%s void %s(const void *model, const wh_%s,\n", linkage, name,
            angles == C_WAVES ? "wave *wave" : "phase *phase");
    fprintf(out, "%*sconst wh_real *linear, ", indent, "");
    if (second) {
        fprintf(out, "const wh_real *rate,\n%*s", indent, "");
    }
    fprintf(out, "const wh_real *input,");
    fprintf(out, second ? " wh_real *result) {\n" : "\n%*swh_real *result) {\n", indent, "");
    fprintf(out, "    (void)model;\n");
    c_list_ignore(out, c_list_uses_phase(t), angles == C_WAVES ? "wave" : "phase");
    c_list_ignore(out, op_list_has(t, OP_LINEAR), "linear");
    if (second) {
        c_list_ignore(out, op_list_has(t, OP_RATE), "rate");
    }
    c_list_ignore(out, op_list_has(t, OP_INPUT), "input");
    c_list_ignore(out, t->results > 0, "result");
    c_list_body(out, t, angles, "result");
}

/* Writes a wave's rate times `scale`. The order of operations is the same as in the interpreter. */
static void write_rate(FILE *out, const op_list *t, const op *o) {
    const char *plus = "";
    int terms = 0;
    for (int k = 0; k < t->angles; k++) {
        terms += o->turns[k] != 0;
    }
    fputs(terms > 1 ? "scale * (" : "", out);
    for (int k = 0; k < t->angles; k++) {
        if (o->turns[k] != 0 && terms == 1) {
            fprintf(out, "(WH_R(%d.0) * scale) * rate[%d]", o->turns[k], k);
        } else if (o->turns[k] == 1) {
            fprintf(out, "%srate[%d]", plus, k);
        } else if (o->turns[k] != 0) {
            fprintf(out, "%sWH_R(%d.0) * rate[%d]", plus, o->turns[k], k);
        }
        plus = o->turns[k] != 0 ? " + " : plus;
    }
    fputs(terms > 1 ? ")" : "", out);
}

void c_list_waves(FILE *out, const op_list *t) {
    const char *const names[] = {"wave_sines", "wave_rates"};
    const char *const from[] = {"const wh_phase *phase, wh_sine_parts *parts",
                                "wh_real scale, const wh_real *rate, wh_real *result"};
    for (int f = 0; f < 2; f++) {
        int wave = 0;
        fprintf(out, "static inline void %s(const void *model, %s) {\n    (void)model;\n", names[f],
                from[f]);
        c_list_ignore(out, op_list_waves(t) > 0, f == 0 ? "phase" : "rate");
        c_list_ignore(out, op_list_waves(t) > 0, f == 0 ? "parts" : "result");
        c_list_ignore(out, op_list_waves(t) > 0 || f == 0, "scale");
        for (int i = 0; i < t->count; i++) {
            if (op_list_is_wave(&t->ops[i])) {
                fprintf(out, f == 0 ? "    wh_sincos_parts(" : "    result[%d] = ", wave);
                if (f == 0) {
                    write_turns(out, t, &t->ops[i]);
                    fprintf(out, ", &parts[%d])", wave);
                } else {
                    write_rate(out, t, &t->ops[i]);
                }
                fputs(";\n", out);
                wave++;
            }
        }
        fputs("}\n\n", out);
    }
    fprintf(out, "static const wh_waves waves = {NULL, wave_sines, wave_rates, %dU};\n\n",
            op_list_waves(t));
}
