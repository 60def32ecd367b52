/* matrix.c: a whole step as one matrix, for readers, for LaTeX and for Octave. */

#include "emit.h"

/* BESIDE: most columns in a row of the print. Widths are in characters. */
enum { BESIDE = 5, NAME_WIDTH = 14, NUMBER_WIDTH = 17 };

/* Writes the label of column or row k, a state or an input: its name with primes. */
static const char *name_of(const image *im, int k, char *text, size_t size) {
    const int states = im->matrix.states;
    if (k >= states + im->inputs) {
        return "";
    }
    if (k >= states) {
        snprintf(text, size, "%s", im->input[k - states].name);
    } else {
        const component c = image_component(im, k);
        snprintf(text, size, "%s%.*s", im->unknown[c.unknown].name, c.primes, "''''''''''''''''");
    }
    return text;
}

static const char *unit_of(const image *im, int k) {
    const int states = im->matrix.states;
    if (k >= states) {
        return im->input[k - states].unit.si;
    }
    const component c = image_component(im, k);
    return im->unknown[c.unknown].unit[c.primes].si;
}

static double entry(const image *im, int i, int k) {
    return im->matrix.entry[i * im->matrix.columns + k];
}

/* Writes the names of columns `first` to `end` - 1, as "(X, X')" or, with `units`, as "(X [m], X' [m/s])". */
static void put_names(FILE *out, const image *im, int first, int end, bool units) {
    char name[256];
    fputc('(', out);
    for (int k = first; k < end; k++) {
        fprintf(out, "%s%s", k > first ? ", " : "", name_of(im, k, name, sizeof name));
        if (units) {
            fprintf(out, " [%s]", unit_of(im, k));
        }
    }
    fputc(')', out);
}

static void put_table(FILE *out, const image *im, const char *title, int first, int end) {
    char name[256];
    for (int from = first; from < end; from += BESIDE) {
        const int to = from + BESIDE < end ? from + BESIDE : end;
        fprintf(out, "\n  %-*s", NAME_WIDTH, from == first ? title : "");
        for (int k = from; k < to; k++) {
            fprintf(out, "%*s", NUMBER_WIDTH, name_of(im, k, name, sizeof name));
        }
        fputc('\n', out);
        for (int i = 0; i < im->matrix.states; i++) {
            fprintf(out, "    %-*s", NAME_WIDTH - 2, name_of(im, i, name, sizeof name));
            for (int k = from; k < to; k++) {
                fprintf(out, " %*.10g", NUMBER_WIDTH - 1, entry(im, i, k));
            }
            fputc('\n', out);
        }
    }
}

/* Does the step add a constant to a state? */
static bool has_offset(const image *im) {
    bool has = false;
    for (int i = 0; i < im->matrix.states; i++) {
        has = has || entry(im, i, im->matrix.columns - 1) != 0.0;
    }
    return has;
}

static const char *motion(const image *im) {
    return im->settings.matrix == MATRIX_EXACT
               ? "the exact motion, with inputs constant over the step"
               : "the step of Runge-Kutta 4";
}

void matrix_text(FILE *out, const image *im) {
    const int states = im->matrix.states;
    fprintf(out, "\na step of %.9g s as one matrix: %s\n\n  x+ = Phi x%s%s\n  x = ", im->step_s,
            motion(im), im->inputs > 0 ? " + Gamma u" : "", has_offset(im) ? " + g" : "");
    put_names(out, im, 0, states, true);
    if (im->inputs > 0) {
        fputs("\n  u = ", out);
        put_names(out, im, states, states + im->inputs, true);
    }
    fputc('\n', out);
    put_table(out, im, "Phi", 0, states);
    put_table(out, im, "Gamma", states, states + im->inputs);
    if (has_offset(im)) {
        put_table(out, im, "g", states + im->inputs, im->matrix.columns);
    }
}

static void put_latex(FILE *out, const image *im, const char *title, int first, int end) {
    fprintf(out, "%s = \\begin{bmatrix}\n", title);
    for (int i = 0; i < im->matrix.states; i++) {
        for (int k = first; k < end; k++) {
            fprintf(out, "%s%.10g", k > first ? " & " : "  ", entry(im, i, k));
        }
        fprintf(out, "%s\n", i + 1 < im->matrix.states ? " \\\\" : "");
    }
    fprintf(out, "\\end{bmatrix}");
}

void matrix_latex(FILE *out, const image *im) {
    const int states = im->matrix.states;
    fprintf(out, "\n%% a step of %.9g s: %s; x = ", im->step_s, motion(im));
    put_names(out, im, 0, states, false);
    fprintf(out, "\n\\[\n  x_{+} = \\Phi x%s%s, \\quad\n", im->inputs > 0 ? " + \\Gamma u" : "",
            has_offset(im) ? " + g" : "");
    put_latex(out, im, "\\Phi", 0, states);
    if (im->inputs > 0) {
        fputs(", \\quad\n", out);
        put_latex(out, im, "\\Gamma", states, states + im->inputs);
    }
    if (has_offset(im)) {
        fputs(", \\quad\n", out);
        put_latex(out, im, "g", states + im->inputs, im->matrix.columns);
    }
    fputs("\n\\]\n", out);
}

static void put_octave(FILE *out, const image *im, const char *name, int first, int end) {
    if (first == end) {
        fprintf(out, "  %s = zeros(%d, 0);\n", name, im->matrix.states);
        return;
    }
    fprintf(out, "  %s = [\n", name);
    for (int i = 0; i < im->matrix.states; i++) {
        fputs("   ", out);
        for (int k = first; k < end; k++) {
            fprintf(out, " %.17g%s", entry(im, i, k), k + 1 < end ? "," : ";\n");
        }
    }
    fputs("  ];\n", out);
}

void matrix_octave(FILE *out, const image *im, const char *file) {
    const int states = im->matrix.states;
    fprintf(out,
            "function [Phi, Gamma, g0] = %s()\n"
            "%% " EMIT_BANNER " from %s: do not edit. SI units.\n%%\n"
            "%% A step of %.17g s: %s.\n%% x+ = Phi*x + Gamma*u + g0\n%% x = ",
            im->name, file, im->step_s, motion(im));
    put_names(out, im, 0, states, true);
    fputs("\n% u = ", out);
    put_names(out, im, states, states + im->inputs, true);
    fprintf(out, "\n%%\n%% [Phi, Gamma, g0] = %s;\n%% x = [", im->name);
    for (int i = 0; i < states; i++) {
        fprintf(out, "%s%.17g", i > 0 ? "; " : "", image_start(im, i));
    }
    fputs("];\n% u = [", out);
    for (int i = 0; i < im->inputs; i++) {
        fprintf(out, "%s%.17g", i > 0 ? "; " : "", im->input[i].value);
    }
    fprintf(out, im->inputs > 0 ? "];\n" : "zeros(0, 1)];\n");
    fprintf(out, "%% for k = 1:%.0f, x = Phi*x + Gamma*u + g0; end\n", (double)im->steps);
    put_octave(out, im, "Phi", 0, states);
    put_octave(out, im, "Gamma", states, states + im->inputs);
    put_octave(out, im, "g0", states + im->inputs, im->matrix.columns);
    fputs("end\n", out);
}
