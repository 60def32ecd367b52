/* examine.c: `whirl examine`: the conserved momenta of a mechanism, and the forces that change other momenta. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/cli/load.h"
#include "host/derive/symmetry.h"
#include "host/emit/emit.h"
#include "host/show/show.h"
#include "options.h"

static const command_usage usage = {
    .head =
        "usage: whirl examine FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--as text|latex] [options]\n"
        "\n"
        "Finds every symmetry q -> q + e*(A q + b) of the kinetic energy, with constant A and b: the\n"
        "directions and rotations of the mechanism. Prints the momentum of each as a formula, and the forces\n"
        "that change it, with line numbers. If no force changes a momentum, it is conserved: nothing inside\n"
        "the mechanism can push the mechanism that way.\n"
        "\n"
        "Whirl reports other symmetries as not decided. The answer holds for the current values of the\n"
        "parameters. If a symmetry shifts two lengths by different amounts, a remark says that its momentum\n"
        "may not be the total momentum.\n"
        "\n"
        "  --as text            for readers (default)\n"
        "  --as latex           for a paper (with amsmath)\n",
    .groups = OPTIONS_CHANGE};

typedef struct examine_options {
    common_options common;
    const char *target;
    const char *form;
} examine_options;

static void say_where(FILE *out, const equations *e, int within, place at) {
    fprintf(out, ", line %d", at.line);
    if (within >= 0) {
        fprintf(out, " (effect %s)", e->instance->mechanism->effects[within].name);
    }
}

/* Longer formulas are printed as a count of terms. */
#define READABLE_TERMS 40

static void print_formula(const show *s, const poly *value) {
    if (value->count > READABLE_TERMS) {
        fprintf(s->out, s->style == SHOW_LATEX ? "\\text{%d terms}" : "(%d terms)", value->count);
    } else {
        show_poly(s, value);
    }
}

static void print_source(const show *s, const poly *value) {
    fputs(": ", s->out);
    print_formula(s, value);
    fputc('\n', s->out);
}

/* All forces along the symmetry, except those of contacts. */
static const poly *force_along(const equations *e, const symmetry *of) {
    const poly *sum = symmetry_along(e, of, e->applied);
    return poly_expanded(e->algebra, poly_sub(e->algebra, sum, of->stored));
}

/* Does a crossing set a symbol that the momentum contains? */
static bool crossing_acts(const equations *e, const symmetry *of, const contact_law *law) {
    for (int k = 0; k < law->from->set_count; k++) {
        const assignment *set = &law->from->sets[k];
        const poly *change = poly_derivative(e->algebra, of->momentum, set->symbol, set->primes);
        if (!poly_is_zero(poly_expanded(e->algebra, change))) {
            return true;
        }
    }
    return false;
}

static bool contact_acts(const equations *e, const symmetry *of, int k) {
    const contact_law *law = &e->contacts->law[k];
    if (of->conserved) {
        return false;
    }
    return law->row == NULL
               ? crossing_acts(e, of, law)
               : !poly_is_zero(poly_expanded(e->algebra, symmetry_along(e, of, law->row)));
}

static bool any_contact_acts(const equations *e, const symmetry *of) {
    bool any = false;
    for (int k = 0; e->contacts != NULL && k < e->contacts->count; k++) {
        any = any || contact_acts(e, of, k);
    }
    return any;
}

/* For each potential energy V, prints its force along the symmetry: minus the derivative of V. */
static void print_stored(const show *s, const equations *e, const symmetry *of,
                         const char *prefix) {
    algebra *a = e->algebra;
    const mechanism *m = e->instance->mechanism;
    const poly **row = alloc(e->count, sizeof *row);
    for (int k = 0; k < m->term_count; k++) {
        const term *from = &m->terms[k];
        if (from->kind != TERM_V || !instance_has(e->instance, from->effect)) {
            continue;
        }
        const poly *stored = poly_from_expr(a, from->value);
        for (int i = 0; i < e->count; i++) {
            row[i] = poly_scale(a, poly_derivative(a, stored, e->unknowns[i].symbol, 0), -1.0);
        }
        const poly *value = symmetry_along(e, of, row);
        if (!poly_is_zero(value)) {
            fprintf(s->out, "%spotential energy V", prefix);
            say_where(s->out, e, from->effect, from->at);
            print_source(s, value);
        }
    }
    free(row);
}

/* If the symmetry shifts two lengths by different amounts, warns that its momentum may not be the total momentum. */
static void print_uncommon(const show *s, const equations *e, const symmetry *of,
                           const char *prefix) {
    const symbol *moved[2] = {NULL, NULL};
    double by[2];
    for (int i = 0; i < e->count && moved[1] == NULL && of->conserved; i++) {
        const symbol *q = e->unknowns[i].symbol;
        const int k = moved[0] != NULL;
        if (q->dim.twelfths[DIM_LENGTH] == DIM_DENOMINATOR && !poly_is_zero(of->shift[i]) &&
            poly_is_number(of->shift[i], &by[k]) && (k == 0 || by[0] < by[1] || by[0] > by[1])) {
            moved[k] = q;
        }
    }
    if (moved[1] != NULL) {
        fprintf(
            s->out,
            "%sthis symmetry shifts %s and %s by different amounts: if both are positions along the same fixed direction, its momentum is not the total momentum\n",
            prefix, moved[0]->name, moved[1]->name);
    }
}

static void print_sources(const show *s, const equations *e, const symmetry *of,
                          const char *prefix) {
    print_uncommon(s, e, of, prefix);
    if (!poly_is_zero(of->stored)) {
        print_stored(s, e, of, prefix);
    }
    for (int k = 0; k < e->forces; k++) {
        const term *from = e->force[k].from;
        const poly *value = symmetry_along(e, of, e->force[k].force);
        if (!poly_is_zero(value)) {
            fprintf(s->out, "%s%s", prefix, from->kind == TERM_F ? "dissipation F" : "force Q");
            say_where(s->out, e, from->effect, from->at);
            print_source(s, value);
        }
    }
    for (int k = 0; e->contacts != NULL && k < e->contacts->count; k++) {
        const contact_statement *from = e->contacts->law[k].from;
        if (contact_acts(e, of, k)) {
            fprintf(s->out, "%s%s", prefix, contact_called(from->kind));
            say_where(s->out, e, from->effect, from->at);
            fputc('\n', s->out);
        }
    }
}

static void print_motion(const show *s, const equations *e, const symmetry *of) {
    bool first = true;
    for (int i = 0; i < e->count; i++) {
        double number;
        if (poly_is_zero(of->shift[i])) {
            continue;
        }
        fputs(first ? "" : ", ", s->out);
        first = false;
        show_symbol(s, e->unknowns[i].symbol, 0);
        fputs(s->style == SHOW_LATEX ? " \\to " : " -> ", s->out);
        show_symbol(s, e->unknowns[i].symbol, 0);
        fputs(s->style == SHOW_LATEX ? " + \\varepsilon" : " + e", s->out);
        if (!poly_is_number(of->shift[i], &number) || number < 1.0 || number > 1.0) {
            fputs(s->style == SHOW_LATEX ? "\\left(" : "*(", s->out);
            show_poly(s, of->shift[i]);
            fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out);
        }
    }
}

static void print_text(const show *s, const equations *e, const symmetry *of, int number) {
    fprintf(s->out, "\n%d  ", number);
    print_motion(s, e, of);
    fprintf(s->out, "\n   P%d = ", number);
    print_formula(s, of->momentum);
    fprintf(s->out, "\n   dP%d/dt = ", number);
    print_formula(s, force_along(e, of));
    fprintf(s->out, "%s%s\n", any_contact_acts(e, of) ? " + contacts" : "",
            of->conserved ? ": conserved" : "");
    print_sources(s, e, of, "     ");
}

static void print_latex(const show *s, const equations *e, const symmetry *of, int number) {
    fprintf(s->out, "%% ");
    show plain = *s;
    plain.style = SHOW_TEXT;
    print_motion(&plain, e, of);
    fputs("\n\\begin{align}\n", s->out);
    const poly *const side[2] = {of->momentum, force_along(e, of)};
    for (int i = 0; i < 2; i++) {
        show_row row;
        const show *to = show_row_begin(&row, s);
        fprintf(to->out, i == 0 ? "  P_{%d} &= " : "  \\dot{P}_{%d} &= ", number);
        print_formula(to, side[i]);
        fputs(i == 1 && any_contact_acts(e, of) ? " + \\text{contacts}" : "", to->out);
        show_row_end(&row);
        fputs(i == 0 ? " \\\\\n" : "\n\\end{align}\n", s->out);
    }
    print_sources(&plain, e, of, "% ");
}

/* Prints dT/dq for each coordinate q whose shift changes the kinetic energy T. */
static void print_broken(const show *s, const equations *e, const char *prefix) {
    for (int i = 0; i < e->count; i++) {
        const symbol *q = e->unknowns[i].symbol;
        const poly *change =
            poly_expanded(e->algebra, poly_derivative(e->algebra, e->kinetic, q, 0));
        if (!poly_is_zero(change)) {
            fprintf(
                s->out,
                "%sa shift of %s alone is no symmetry: T depends on this coordinate, with the derivative ",
                prefix, q->name);
            print_formula(s, change);
            fputc('\n', s->out);
        }
    }
}

static void print_all(const equations *e, const symmetries *found, bool latex) {
    show s = show_start(stdout, latex ? SHOW_LATEX : SHOW_TEXT, e->algebra);
    show_lets_begin(&s, e);
    show plain = s;
    plain.style = SHOW_TEXT;
    const char *prefix = latex ? "% " : "";
    const mechanism *m = e->instance->mechanism;
    printf("%s", latex ? "% " EMIT_BANNER "\n" : "");
    printf("%s%s%s%s\n", prefix, m->name, m->title[0] != '\0' ? ": " : "", m->title);
    for (int i = 0; i < m->effect_count; i++) {
        if (e->instance->with[i]) {
            printf("%swith %s: %s\n", prefix, m->effects[i].name, m->effects[i].text);
        }
    }
    int left_out = 0;
    for (int i = 0; i < m->effect_count; i++) {
        if (!e->instance->with[i]) {
            printf("%s%s%s", left_out > 0 ? "" : prefix,
                   left_out > 0 ? ", " : "left out: ", m->effects[i].name);
            left_out++;
        }
    }
    fputs(left_out > 0 ? "\n" : "", stdout);
    int conserved = 0;
    for (int i = 0; i < found->count; i++) {
        (latex ? print_latex : print_text)(&s, e, &found->each[i], i + 1);
        conserved += found->each[i].conserved ? 1 : 0;
    }
    fputs(latex ? "" : "\n", stdout);
    print_broken(&plain, e, prefix);
    printf("%sdirections and rotations found: %d, conserved momenta: %d\n", prefix, found->count,
           conserved);
    if (found->broken > 0) {
        printf("%srotations that T permits but V does not: %d\n", prefix, found->broken);
    }
    if (!found->complete) {
        printf(
            "%snot decided: a symmetry that holds at random states, but that Whirl cannot derive from the formulas\n",
            prefix);
    }
    if (!found->flat) {
        printf("%snot decided: a direction or rotation that is not affine in these coordinates\n",
               prefix);
    }
    show_lets_end(&s, latex ? "% with\n\\begin{align}\n" : "with\n", latex ? " \\\\\n" : "\n",
                  latex ? "\n\\end{align}\n" : "\n");
}

static int examine_source(source_model *from, void *options) {
    static const char *const forms[] = {"text", "latex"};
    const examine_options *o = options;
    const int form = options_choose("examine", "form", o->form, forms, sizeof forms[0], 2);
    if (form < 0) {
        return EXIT_BAD_INPUT;
    }
    loaded made;
    int code = target_load(&made, from, &o->common, (load_request){.use = IMAGE_TO_RUN});
    if (code == EXIT_DONE && made.equations->kinetic == NULL) {
        const mechanism *of = made.equations->instance->mechanism;
        fprintf(stderr,
                "%s:%d:%d: error: whirl examine needs energies, but '%s' is given by "
                "equations\nhint: write the mechanism with T and V instead\n",
                from->file, of->at.line, of->at.column, of->name);
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        symmetries *found = symmetries_find(made.equations);
        if (found == NULL) {
            equations_report_growth(made.equations, from->errors);
            diags_flush(from->errors, stderr);
            code = EXIT_BAD_INPUT;
        } else {
            print_all(made.equations, found, form == 1);
        }
    }
    unload(&made);
    return code;
}

int command_examine(int count, char **words) {
    examine_options o = {.common = options_defaults(), .form = "text"};
    const own_option own[] = {{.word = "--as", .text = &o.form}, {.word = NULL}};
    const target_reader reader = {.command = "examine",
                                  .usage = &usage,
                                  .table = own,
                                  .one = "scene or mechanism",
                                  .work_on = examine_source};
    return target_command(&reader, count, words, &o.common, &o, &o.target);
}
