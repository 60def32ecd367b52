#include "show_events.h"

static void show_crossing(const show *s, const contact_law *law, const contact_set *set) {
    const contact_statement *from = law->from;
    fputs(contact_loosens(from) ? "normal force that comes and goes: when " : "when ", s->out);
    show_poly(s, law->value);
    fputs(" crosses 0", s->out);
    fputs(from->direction > 0 ? " rising" : from->direction < 0 ? " falling" : "", s->out);
    for (int i = 0; i < from->set_count; i++) {
        fputs(i == 0 ? ": " : ", ", s->out);
        show_symbol(s, from->sets[i].symbol, from->sets[i].primes);
        fputs(" = ", s->out);
        show_poly(s, set->value[i]);
    }
}

static void show_friction(const show *s, const contact_law *law) {
    fputs("friction on ", s->out);
    show_symbol(s, law->from->coordinate, 0);
    fputs(": sticks up to ", s->out);
    show_poly(s, law->first);
    fputs(", slides with ", s->out);
    show_poly(s, law->second);
}

static void show_lines(const show *s, const equations *e, const char *prefix) {
    const contact_laws *laws = e->contacts;
    for (int k = 0; k < laws->count; k++) {
        const contact_law *law = &laws->law[k];
        fprintf(s->out, "%s  ", prefix);
        switch (law->from->kind) {
        case CONTACT_STOP:
            fputs("stop ", s->out);
            show_poly(s, law->value);
            fputs(" >= 0, restitution ", s->out);
            show_poly(s, law->first);
            break;
        case CONTACT_FRICTION: show_friction(s, law); break;
        case CONTACT_HOLD:
            fputs("hold ", s->out);
            show_poly(s, law->speed);
            fputs(" = 0 while ", s->out);
            show_poly(s, law->value);
            fputs(" > 0", s->out);
            break;
        case CONTACT_WHEN: show_crossing(s, law, &laws->sets[k]); break;
        }
        fputc('\n', s->out);
    }
}

void show_events(FILE *out, const equations *e, const char *prefix, const char *heading) {
    const show s = show_start(out, SHOW_TEXT, e->algebra);
    if (e->contacts != NULL) {
        fprintf(out, "%s%s\n", prefix, heading);
        show_lines(&s, e, prefix);
    }
}

/* --- LaTeX: rows "LEFT &= RIGHT" of an align* ----------------------------------------------------*/

static void latex_row(const show *s, bool *first, const char *before, const poly *left,
                      const char *behind, const poly *right, const char *end) {
    show_row row;
    fputs(*first ? "" : " \\\\\n", s->out);
    *first = false;
    const show *to = show_row_begin(&row, s);
    fprintf(to->out, "  \\text{%s } ", before);
    show_poly(to, left);
    fputs(behind, to->out);
    show_poly(to, right);
    fputs(end, to->out);
    show_row_end(&row);
}

static void latex_rows(const show *s, const contact_law *law, const contact_set *set, bool *first) {
    algebra *a = s->algebra;
    const contact_statement *from = law->from;
    const poly *zero = poly_number(a, 0.0);
    switch (from->kind) {
    case CONTACT_STOP:
        latex_row(s, first, "stop, restitution", law->first, " \\text{: } 0 &= ", law->value, "");
        break;
    case CONTACT_FRICTION: {
        const poly *on = poly_symbol(a, from->coordinate, 0);
        latex_row(s, first, "friction on", on, " \\text{, static} &= ", law->first, "");
        latex_row(s, first, "friction on", on, " \\text{, kinetic} &= ", law->second, "");
        break;
    }
    case CONTACT_HOLD:
        latex_row(s, first, "hold", law->speed, " &= 0 \\text{ while } ", law->value, " > 0");
        break;
    case CONTACT_WHEN:
        if (!contact_loosens(from)) {
            latex_row(s, first, "when", law->value, " &= ", zero,
                      from->direction > 0   ? " \\text{ rising}"
                      : from->direction < 0 ? " \\text{ falling}"
                                            : "");
        }
        for (int i = 0; i < from->set_count; i++) {
            latex_row(s, first, "set", poly_symbol(a, from->sets[i].symbol, from->sets[i].primes),
                      " &= ", set->value[i], "");
        }
        break;
    }
}

void show_contacts(const show *s, const equations *e) {
    const contact_laws *laws = e->contacts;
    const bool latex = s->style == SHOW_LATEX;
    bool first = true;
    if (laws == NULL) {
        return;
    }
    fputs(
        latex
            ? "\\noindent Contacts add their forces and impulses to these equations while they "
              "act:\n\\begin{align*}\n"
            : "\ncontacts, which add their forces and impulses while they act, in this order:\n\n",
        s->out);
    if (!latex) {
        show_lines(s, e, "");
        return;
    }
    for (int k = 0; k < laws->count; k++) {
        latex_rows(s, &laws->law[k], &laws->sets[k], &first);
    }
    fputs("\n\\end{align*}\n", s->out);
}
