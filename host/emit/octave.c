/* octave.c: a function file for Octave and Matlab, from the operation list. */
#include <string.h>

#include "emit.h"
#include "host/emit/c_list.h"

/* Returns the component's index in y, from 1. First in y are the unknowns' values, then their rates, and so on. */
static int y_number(const image *im, component of) {
    int number = 1;
    for (int i = 0; i < im->count; i++) {
        const int before = of.primes + (i < of.unknown);
        number += before < im->unknown[i].order ? before : im->unknown[i].order;
    }
    return number;
}

static void write_operand(FILE *out, const op_list *t, int a) {
    if (t->ops[a].code == OP_CONSTANT) {
        fprintf(out, t->ops[a].value < 0.0 ? "(%.17g)" : "%.17g", t->ops[a].value);
    } else {
        fprintf(out, "x%d", a);
    }
}

static void write_phase(FILE *out, const image *im, const op *o) {
    const op_list *t = im->list[IMAGE_STEP];
    const char *plus = "";
    if (o->value != 0.0) {
        fprintf(out, "%.17g", o->value);
        plus = " + ";
    }
    for (int k = 0; k < t->angles && o->turns != NULL; k++) {
        if (o->turns[k] != 0) {
            fputs(plus, out);
            if (o->turns[k] != 1) {
                fprintf(out, "%d*", o->turns[k]);
            }
            fprintf(out, "y(%d)", y_number(im, im->angle[k]));
            plus = " + ";
        }
    }
    if (o->b >= 0) {
        fputs(plus, out);
        write_operand(out, t, o->b);
    }
}

static void write_leaf(FILE *out, const void *context, char what, int a) {
    const image *im = context;
    if (what == 'u') {
        fputs(im->input[a].name, out);
    } else {
        const int real = what == 'r' ? im->coordinates - im->angles + a : a;
        fprintf(out, "%d", y_number(im, im->real[real]));
    }
}

static void write_operation(FILE *out, const image *im, int i) {
    const op_style style = {write_operand, write_leaf, im};
    const op_list *t = im->list[IMAGE_STEP];
    const op *o = &t->ops[i];
    const op_row *row = &op_rows[o->code];
    if (row->kind == OP_IS_CONSTANT) {
        return;
    }
    fprintf(out, "  x%d = ", i);
    if (row->kind == OP_IS_PHASE) {
        write_phase(out, im, o);
    } else {
        op_text(out, t, o, row->octave, &style);
    }
    fputs(";\n", out);
}

/* Writes the start values of y's components if `start`, else their names. */
static void write_y(FILE *out, const image *im, bool start) {
    for (int level = 0, number = 1; number <= im->angles + im->reals; level++) {
        for (int i = 0; i < im->count; i++) {
            if (im->unknown[i].order <= level) {
                continue;
            }
            if (start) {
                fprintf(out, "%s%.17g", number > 1 ? "; " : "",
                        image_start(im, image_find_component(im, i, level)));
            } else {
                fprintf(out, "%s%s%.*s", number > 1 ? ", " : "", im->unknown[i].name, level,
                        "''''''''''");
            }
            number++;
        }
    }
}

void emit_octave_head(FILE *out, const image *im, const char *file, const char *contacts) {
    fprintf(out, "function dy = %s(t, y)\n", im->name);
    fprintf(out, "%% " EMIT_BANNER " from %s: do not edit. SI units.\n%%\n%% y = (", file);
    write_y(out, im, false);
    fprintf(out,
            ")\n%%\n%% options = odeset('RelTol', 1e-7, 'AbsTol', 1e-9);\n"
            "%% [T, Y] = ode45(@%s, [0 %.17g], [",
            im->name, im->until_s);
    write_y(out, im, true);
    fprintf(out, "], options);\n%% K = [T Y]; save('%s.txt', 'K', '-ascii')\n%s", im->name,
            contacts);
}

void emit_octave_end(FILE *out, const image *im) {
    const op_list *t = im->list[IMAGE_STEP];
    bool may_be_complex = false;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        may_be_complex = may_be_complex || o->code == OP_SQRT || o->code == OP_POW ||
                         (o->code == OP_CALL && !function_is_real(o->function));
    }
    if (may_be_complex) {
        fprintf(out, "  if ~isreal(dy), dy(:) = NaN; end %% outside a function's real values\n");
    }
    fprintf(out, "end\n");
}

void emit_octave(FILE *out, const image *im, const char *file, const char *contacts) {
    const op_list *t = im->list[IMAGE_STEP];
    emit_octave_head(out, im, file, contacts);
    for (int i = 0; i < im->inputs; i++) {
        const image_quantity *u = &im->input[i];
        fprintf(out, "  u_%s = %.17g; %% %s\n", u->name, u->value, u->text);
    }
    for (int i = 0; i < t->count; i++) {
        write_operation(out, im, i);
    }
    fprintf(out, "  dy = zeros(%d, 1);\n", im->angles + im->reals);
    for (int i = 0; i < im->count; i++) {
        const int top = im->unknown[i].order - 1;
        for (int primes = 0; primes < top; primes++) {
            fprintf(out, "  dy(%d) = y(%d);\n", y_number(im, (component){i, primes}),
                    y_number(im, (component){i, primes + 1}));
        }
        fprintf(out, "  dy(%d) = ", y_number(im, (component){i, top}));
        write_operand(out, t,
                      t->result[im->form == WH_SECOND_ORDER ? im->place[i]
                                                            : image_find_component(im, i, top)]);
        fputs(";\n", out);
    }
    emit_octave_end(out, im);
}

bool emit_octave_variable_is_free(const char *name) {
    static const char taken[] =
        "arguments break case catch classdef continue do else elseif end end_try_catch "
        "end_unwind_protect endarguments endclassdef endenumeration endevents endfor endfunction "
        "endif endmethods endparfor endproperties endspmd endswitch endwhile enumeration events "
        "for function global if methods otherwise parfor persistent properties return spmd switch "
        "try until unwind_protect unwind_protect_cleanup while "
        "t y dy Phi Gamma g0 zeros isreal ode45 odeset save NaN";
    function_id called;
    /* Matlab's names begin with a letter */
    return name[0] != '_' && !function_find(name, strlen(name), &called) &&
           !emit_is_among(taken, name, strlen(name));
}

bool emit_octave_name_is_free(const char *name) {
    static const char constants[] =
        "ans e eps false i I inf Inf j J NA nan nargin nargout pi realmax realmin true varargin "
        "varargout flintmax intmax intmin";
    return emit_octave_variable_is_free(name) && !emit_is_among(constants, name, strlen(name));
}
