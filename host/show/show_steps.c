/* show_steps.c: Lagrange's equations step by step, one coordinate after another: what a student writes by hand. */
#include "host/derive/forces.h"
#include "show.h"
#include "show_equations.h"
#include "show_events.h"

/* d/dt of the momentum: the mass matrix times the accelerations, and what the rates do to it. equations.h keeps the latter
 * together with -dT/dq. */
static const poly *momentum_rate(const equations *e, int i) {
    algebra *a = e->algebra;
    const poly *sum =
        poly_add(a, e->velocity[i], poly_derivative(a, e->kinetic, e->unknowns[i].symbol, 0));
    for (int j = 0; j < e->count; j++) {
        const poly *acceleration = poly_symbol(a, e->unknowns[j].symbol, 2);
        sum = poly_add(a, sum, poly_mul(a, e->mass[i * e->count + j], acceleration));
    }
    return sum;
}

/* What the statements of a kind do to coordinate i: Q, or -dF/dq'. */
static const poly *force_of_kind(const equations *e, term_kind kind, int i) {
    const poly *sum = poly_number(e->algebra, 0.0);
    for (int k = 0; k < e->forces; k++) {
        if (e->force[k].from->kind == kind) {
            sum = poly_add(e->algebra, sum, e->force[k].force[i]);
        }
    }
    return sum;
}

/* "  dL/dx' = FORMULA". */
static void write_slope(const show *s, const char *before, const char *of, const symbol *by,
                        int primes, const char *behind, const poly *value) {
    const bool latex = s->style == SHOW_LATEX;
    show_row row;
    const show *to = show_row_begin(&row, s);
    fprintf(to->out, latex ? "  %s\\frac{\\partial %s}{\\partial " : "  %sd%s/d", before, of);
    show_symbol(to, by, primes);
    fprintf(to->out, latex ? "}%s &= " : "%s = ", behind);
    show_poly(to, value);
    show_row_end(&row);
    fputs(latex ? " \\\\\n" : "\n", s->out);
}

static void write_coordinate(const show *s, const equations *e, int i) {
    const bool latex = s->style == SHOW_LATEX;
    algebra *a = e->algebra;
    const symbol *q = e->unknowns[i].symbol;
    const poly *slope =
        poly_sub(a, poly_derivative(a, e->kinetic, q, 0), poly_derivative(a, e->stored, q, 0));
    const poly *loss = poly_scale(a, force_of_kind(e, TERM_F, i), -1.0);
    const poly *outside = force_of_kind(e, TERM_Q, i);
    fputs(latex ? "% " : "\n", s->out);
    fprintf(s->out, "%s\n", q->name);
    fputs(latex ? "\\begin{align}\n" : "", s->out);
    write_slope(s, "", "L", q, 1, "", e->momentum[i]);
    write_slope(s, latex ? "\\frac{d}{dt}" : "d/dt(", "L", q, 1, latex ? "" : ")",
                momentum_rate(e, i));
    write_slope(s, "", "L", q, 0, "", slope);
    if (!poly_is_zero(loss)) {
        write_slope(s, "", "F", q, 1, "", loss);
    }
    if (!poly_is_zero(outside)) {
        show_row row;
        const show *to = show_row_begin(&row, s);
        fputs(latex ? "  Q_{" : "  Q(", to->out);
        show_symbol(to, q, 0);
        fputs(latex ? "} &= " : ") = ", to->out);
        show_poly(to, outside);
        show_row_end(&row);
        fputs(latex ? " \\\\\n" : "\n", s->out);
    }
    show_equation(s, e, i);
    fputs(latex ? "\n\\end{align}\n" : "\n", s->out);
}

void show_steps(FILE *out, const equations *e, show_style style) {
    show s = show_start(out, style, e->algebra);
    show_lets_begin(&s, e);
    const bool latex = style == SHOW_LATEX;
    const poly *lagrangian = poly_sub(e->algebra, e->kinetic, e->stored);
    const char *prefix = latex ? "% " : "";
    fprintf(out, "%s%s: Lagrange's equations, d/dt(dL/dq') - dL/dq = -dF/dq' + Q\n", prefix,
            e->instance->mechanism->name);
    fputs(latex ? "\\begin{align}\n" : "\n", out);
    show_row row;
    const show *to = show_row_begin(&row, &s);
    fputs(latex ? "  L = T - V &= " : "  L = T - V = ", to->out);
    show_poly(to, lagrangian);
    show_row_end(&row);
    fputs(latex ? "\n\\end{align}\n" : "\n", out);
    for (int i = 0; i < e->count; i++) {
        write_coordinate(&s, e, i);
    }
    show_contacts(&s, e);
    show_lets_end(&s, latex ? "% with\n\\begin{align}\n" : "\nwith\n\n", latex ? " \\\\\n" : "\n",
                  latex ? "\n\\end{align}\n" : "\n");
}
