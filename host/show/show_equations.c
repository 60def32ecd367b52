/* show_equations.c: the equations of motion, events and derivation, for screen and paper. */
#include "host/show/show.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/value.h"
#include "host/number/functions.h"

static void show_equation(const show *s, const equations *e, int i);

/* === show break =============================================================================== */
/* Breaks long LaTeX formulas into rows of amsmath's environment `aligned`. */

/* Widths in points, in 10 pt type. LINE_WIDTH: a line of LaTeX's article, less 25 for the equation's number. */
enum { LINE_WIDTH = 320, NARROWEST = 100, LEFT_WIDTH = 150, EQUALS = 14, SIGN = 13, QUAD = 10 };

typedef struct span {
    const char *from;
    const char *end;
} span;

static bool begins(span s, const char *word) {
    const size_t length = strlen(word);
    return *s.from == *word && (size_t)(s.end - s.from) >= length &&
           strncmp(s.from, word, length) == 0;
}

/* +1 for an opening bracket, -1 for a closing one. */
static int opens(span s) {
    return *s.from == '{' || begins(s, "\\left") || begins(s, "\\begin")  ? 1
           : *s.from == '}' || begins(s, "\\right") || begins(s, "\\end") ? -1
                                                                          : 0;
}

/* The end of the group that opens at s.from. */
static const char *behind_group(span s) {
    int depth = 0;
    do {
        depth += opens(s);
        s.from++;
    } while (depth > 0 && s.from < s.end);
    return s.from;
}

static int larger(int a, int b) { return a > b ? a : b; }

static span span_of(const char *text) { return (span){text, text + strlen(text)}; }

static int width_of(span s);

/* The width of the widest row of amsmath's aligned. */
static int width_of_rows(span s) {
    int widest = 0;
    int depth = 0;
    const char *row = s.from;
    for (; s.from < s.end; s.from++) {
        depth += opens(s);
        if (depth == 0 && begins(s, "\\\\")) {
            widest = larger(widest, width_of((span){row, s.from}));
            s.from++;
            row = s.from + 1;
        }
    }
    return larger(widest, width_of((span){row, s.end}));
}

/* The width of the command at *s, including the contents of \frac and aligned. Advances *s past it. */
static int width_of_command(span *s) {
    static const char aligned[] = "\\begin{aligned}";
    static const char behind[] = "\\end{aligned}";
    if (begins(*s, aligned)) {
        const span all = {s->from, behind_group(*s)};
        int depth = 0;
        do { /* up to the \end of this environment */
            depth += begins(*s, "\\begin") ? 1 : begins(*s, "\\end") ? -1 : 0;
            s->from++;
        } while (depth > 0 && s->from < s->end);
        const char *end = s->from - 1;
        s->from = end + strlen(behind);
        const char *inside = all.from + strlen(aligned);
        inside += strncmp(inside, "[t]", 3) == 0 ? 3 : 0;
        return width_of_rows((span){inside, end});
    }
    const char *name = s->from + 1;
    size_t length = 0;
    while (name + length < s->end && isalpha((unsigned char)name[length])) {
        length++;
    }
    const span of = {name, name + length};
    if (length == 0) { /* such as a thin space or an underscore */
        const int width = *name == ',' ? 2 : 5;
        s->from = name + 1;
        return width;
    }
    s->from = name + length;
    if (begins(of, "frac")) {
        const char *middle = behind_group(*s);
        const char *end = behind_group((span){middle, s->end});
        const int width =
            3 + larger(width_of((span){s->from, middle}), width_of((span){middle, end}));
        s->from = end;
        return width;
    }
    static const char *const named[] = {"sin", "cos", "tan", "exp", "min", "max"};
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        if (begins(of, named[i])) {
            return 6 * (int)length + 2;
        }
    }
    if (begins(of, "quad")) {
        return QUAD;
    }
    static const char *const empty[] = {"left", "right", "mathrm", "operatorname", "dot", "ddot"};
    for (size_t i = 0; i < sizeof empty / sizeof empty[0]; i++) {
        if (length == strlen(empty[i]) && begins(of, empty[i])) {
            return 0;
        }
    }
    return begins(of, "sqrt") ? 9 : begins(of, "times") ? SIGN : 7;
}

/* Returns the width, rounded up. Subscripts and superscripts count as full-sized. */
static int width_of(span s) {
    int width = 0;
    while (s.from < s.end) {
        if (*s.from == '\\') {
            width += width_of_command(&s);
            continue;
        }
        const char c = *s.from++;
        width += strchr("+-", c) != NULL         ? SIGN
                 : c == '='                      ? EQUALS
                 : strchr(" {}&\n^_", c) != NULL ? 0
                 : strchr("mMwW", c) != NULL     ? 10
                 : isupper((unsigned char)c)     ? 9
                 : isdigit((unsigned char)c)     ? 5
                                                 : 6;
    }
    return width;
}

/* The next plus or minus outside brackets, or, with `factors`, the next sign between factors; else s.end. */
static const char *next_break(span s, bool factors) {
    int depth = 0;
    for (span at = {s.from, s.end}; at.from < s.end; at.from++) {
        depth += opens(at);
        if (depth == 0 && at.from > s.from &&
            (factors ? begins(at, " \\, ") : begins(at, " + ") || begins(at, " - "))) {
            return at.from;
        }
    }
    return s.end;
}

static char *broken(span s, int limit);

/* Returns the contents of the widest group in s that is neither part of a name nor already broken. */
static span widest_group(span s) {
    span widest = {s.from, s.from};
    int most = 0;
    for (span at = s; at.from < s.end;) {
        if (begins(at, "\\mathrm") || begins(at, "\\operatorname") || begins(at, "\\dot") ||
            begins(at, "\\ddot") || begins(at, "_{") || begins(at, "\\begin")) {
            at.from = strchr(at.from, begins(at, "\\begin") ? '\n' : '{');
            at.from = *at.from == '{' ? behind_group(at) : at.from;
        } else if (opens(at) > 0) {
            const char *end = behind_group(at);
            const bool brace = *at.from == '{';
            const span inside = {at.from + (brace ? 1 : strlen("\\left(")), end - 1};
            const int width = width_of(inside);
            if (width > most && !begins(inside, "\\begin")) {
                most = width;
                widest = inside;
            }
            at.from = end;
        } else {
            at.from++;
        }
    }
    return widest;
}

/* Breaks the widest groups, until s fits the limit or no group is wide enough. */
static char *narrowed(span s, int limit) {
    char *text = alloc_copy(s.from, (size_t)(s.end - s.from));
    for (;;) {
        const span all = span_of(text);
        const int excess = width_of(all) - limit;
        const span group = widest_group(all);
        const int width = width_of(group);
        if (excess <= 0 || width <= NARROWEST) {
            return text;
        }
        char *inside = broken(group, larger(width - excess, NARROWEST));
        if (width_of(span_of(inside)) >= width) {
            free(inside);
            return text;
        }
        char *longer = alloc_words("%.*s%s%s", (int)(group.from - text), text, inside, group.end);
        free(inside);
        free(text);
        text = longer;
    }
}

/* Returns s broken into rows: "first \\ &\quad + next". */
static char *rows_of(span s, int limit, bool factors) {
    char *text;
    size_t length;
    FILE *out = alloc_text(&text, &length);
    const int indent = factors ? QUAD + SIGN : QUAD;
    int width = 0;
    for (const char *at = s.from; at < s.end;) {
        const char *next = next_break((span){at, s.end}, factors);
        char *part = broken((span){at, next}, limit - indent);
        const int more = width_of(span_of(part));
        if (width > 0 && width + more > limit) {
            fputs(factors ? " \\\\\n    &\\quad \\times" : " \\\\\n    &\\quad", out);
            width = indent;
            fputs(part + (factors ? strlen(" \\,") : 0), out);
        } else {
            fputs(part, out);
        }
        width += more;
        free(part);
        at = next;
    }
    alloc_text_end(out);
    return text;
}

/* Returns s, with line breaks if it is wider than the limit. */
static char *broken(span s, int limit) {
    if (width_of(s) <= limit) {
        return alloc_copy(s.from, (size_t)(s.end - s.from));
    }
    const bool factors = next_break(s, false) == s.end;
    if (factors) {
        char *line = narrowed(s, limit);
        if (width_of(span_of(line)) <= limit || next_break(s, true) == s.end) {
            return line;
        }
        free(line);
    }
    char *rows = rows_of(s, limit, factors);
    char *all = alloc_words("\\begin{aligned}\n    & %s\n  \\end{aligned}", rows);
    free(rows);
    return all;
}

static void put_row(FILE *out, const char *row) {
    const char *sign = strstr(row, " &= ");
    const span left = {row, sign};
    const span right = span_of(sign + strlen(" &= "));
    if (width_of(left) + width_of(right) + EQUALS <= LINE_WIDTH) {
        fputs(row, out);
        return;
    }
    if (width_of(left) <= LEFT_WIDTH) {
        char *lines = broken(right, LINE_WIDTH - width_of(left) - EQUALS);
        fprintf(out, "%.*s &= %s", (int)(sign - row), row, lines);
        free(lines);
        return;
    }
    const bool sums[2] = {next_break(left, false) == left.end,
                          next_break(right, false) == right.end};
    char *lines[2] = {rows_of(left, LINE_WIDTH - EQUALS, sums[0]),
                      rows_of(right, LINE_WIDTH - EQUALS, sums[1])};
    const char *first = lines[0] + strspn(lines[0], " ");
    fprintf(out, "  &\\begin{aligned}\n    & %s \\\\\n    &= %s\n  \\end{aligned}", first,
            lines[1]);
    free(lines[0]);
    free(lines[1]);
}

show *show_row_begin(show_row *row, const show *s) {
    row->out = s->out;
    row->inner = *s;
    if (s->style == SHOW_LATEX) {
        row->inner.out = alloc_text(&row->text, &row->length);
    }
    return &row->inner;
}

void show_row_end(show_row *row) {
    if (row->inner.style == SHOW_LATEX) {
        alloc_text_end(row->inner.out);
        put_row(row->out, row->text);
        free(row->text);
    }
}

/* === show events ============================================================================== */

/* Forms of contacts, as text and LaTeX. $v, $s: the law's value and speed; $a, $b: expressions; $q: coordinate. */
static const struct {
    const char *text;
    const char *latex[2];
} forms[CONTACT_KINDS] = {
    [CONTACT_STOP] = {"stop $v >= 0, restitution $a",
                      {"  \\text{stop, restitution } $a \\text{: } 0 &= $v"}},
    [CONTACT_FRICTION] = {"friction on $q: sticks up to $a, slides with $b",
                          {"  \\text{friction on } $q \\text{, static} &= $a",
                           "  \\text{friction on } $q \\text{, kinetic} &= $b"}},
    [CONTACT_HOLD] = {"hold $s = 0 while $v > 0",
                      {"  \\text{hold } $s &= 0 \\text{ while } $v > 0"}},
    [CONTACT_WHEN] = {"when $v crosses 0", {"  \\text{when } $v &= 0"}},
};

static void show_form(const show *s, const contact_law *law, const char *form) {
    for (; *form != '\0'; form++) {
        if (*form != '$') {
            fputc(*form, s->out);
            continue;
        }
        switch (*++form) {
        case 'v': show_poly(s, law->value); break;
        case 's': show_poly(s, law->speed); break;
        case 'a': show_poly(s, law->first); break;
        case 'b': show_poly(s, law->second); break;
        case 'q': show_symbol(s, law->from->coordinate, 0); break;
        }
    }
}

static void show_lines(const show *s, const equations *e, const char *prefix) {
    const contact_laws *laws = e->contacts;
    for (int k = 0; k < laws->count; k++) {
        const contact_law *law = &laws->law[k];
        const contact_statement *from = law->from;
        fprintf(s->out, "%s  %s", prefix,
                contact_loosens(from) ? "normal force that comes and goes: " : "");
        show_form(s, law, forms[from->kind].text);
        fputs(from->direction > 0 ? " rising" : from->direction < 0 ? " falling" : "", s->out);
        for (int i = 0; i < from->set_count; i++) {
            fputs(i == 0 ? ": " : ", ", s->out);
            show_symbol(s, from->sets[i].symbol, from->sets[i].primes);
            fputs(" = ", s->out);
            show_poly(s, law->set[i]);
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

/* Writes `before`, the symbol `of`, `behind`, the formula `value`, and `end`. */
static void write_row(const show *s, const char *before, const symbol *of, int primes,
                      const char *behind, const poly *value, const char *end) {
    show_row row;
    const show *to = show_row_begin(&row, s);
    fputs(before, to->out);
    if (of != NULL) {
        show_symbol(to, of, primes);
    }
    fputs(behind, to->out);
    show_poly(to, value);
    show_row_end(&row);
    fputs(end, s->out);
}

/* Prints the contacts in the style of `s`. Sums that `s` has names for are printed as names. */
static void show_contacts(const show *s, const equations *e) {
    const contact_laws *laws = e->contacts;
    const bool latex = s->style == SHOW_LATEX;
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
    const char *between = ""; /* the text before the next row */
    for (int k = 0; k < laws->count; k++) {
        const contact_law *law = &laws->law[k];
        const contact_statement *from = law->from;
        const char *const *form = forms[from->kind].latex;
        for (int i = 0; i < 2 && form[i] != NULL && !contact_loosens(from); i++) {
            show_row row;
            fputs(between, s->out);
            between = " \\\\\n";
            const show *to = show_row_begin(&row, s);
            show_form(to, law, form[i]);
            fputs(from->direction > 0   ? " \\text{ rising}"
                  : from->direction < 0 ? " \\text{ falling}"
                                        : "",
                  to->out);
            show_row_end(&row);
        }
        for (int i = 0; i < from->set_count; i++) {
            fputs(between, s->out);
            between = " \\\\\n";
            write_row(s, "  \\text{set } ", from->sets[i].symbol, from->sets[i].primes,
                      " &= ", law->set[i], "");
        }
    }
    fputs("\n\\end{align*}\n", s->out);
}

/* === the derivation, step by step ============================================================= */

/* Returns `rest` plus row i of the mass matrix times the highest derivatives. */
static const poly *add_inertia(const equations *e, int i, const poly *rest) {
    algebra *a = e->algebra;
    for (int j = 0; j < e->count; j++) {
        const unknown *u = &e->unknowns[j];
        const poly *highest = poly_symbol(a, u->symbol, u->order);
        rest = poly_add(a, rest, poly_mul(a, e->mass[i * e->count + j], highest));
    }
    return rest;
}

/* The force on coordinate i: Q (TERM_Q) or -dF/dq' (TERM_F). */
static const poly *force_of_kind(const equations *e, term_kind kind, int i) {
    const poly *sum = poly_number(e->algebra, 0.0);
    for (int k = 0; k < e->forces; k++) {
        if (e->force[k].from->kind == kind) {
            sum = poly_add(e->algebra, sum, e->force[k].force[i]);
        }
    }
    return sum;
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
    const char *by = latex ? "  \\frac{\\partial L}{\\partial " : "  dL/d";
    const char *equals = latex ? "} &= " : " = ";
    const char *end = latex ? " \\\\\n" : "\n";
    write_row(s, by, q, 1, equals, e->momentum[i], end);
    /* e->velocity[i] includes -dT/dq, which is no part of d/dt(dL/dq'): cancel it */
    const poly *velocity = poly_add(a, e->velocity[i], poly_derivative(a, e->kinetic, q, 0));
    write_row(s, latex ? "  \\frac{d}{dt}\\frac{\\partial L}{\\partial " : "  d/dt(dL/d", q, 1,
              latex ? equals : ") = ", add_inertia(e, i, velocity), end);
    write_row(s, by, q, 0, equals, slope, end);
    if (!poly_is_zero(loss)) {
        write_row(s, latex ? "  \\frac{\\partial F}{\\partial " : "  dF/d", q, 1, equals, loss,
                  end);
    }
    if (!poly_is_zero(outside)) {
        write_row(s, latex ? "  Q_{" : "  Q(", q, 0, latex ? equals : ") = ", outside, end);
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
    write_row(&s, latex ? "  L = T - V &= " : "  L = T - V = ", NULL, 0, "", lagrangian,
              latex ? "\n\\end{align}\n" : "\n");
    for (int i = 0; i < e->count; i++) {
        write_coordinate(&s, e, i);
    }
    show_contacts(&s, e);
    show_lets_end(&s, latex ? "% with\n\\begin{align}\n" : "\nwith\n\n", latex ? " \\\\\n" : "\n",
                  latex ? "\n\\end{align}\n" : "\n");
}

/* === the equations of motion ================================================================== */

#define READABLE_TERMS 24 /* most terms in a numerator or denominator of a printed closed form */

/* Writes the inertia, centrifugal and potential terms of equation i. */
static void write_left_side(const show *s, const equations *e, int i) {
    algebra *a = s->algebra;
    const poly *rest = poly_add(a, e->velocity[i], e->potential[i]);
    const poly *sum = add_inertia(e, i, rest);
    if (!algebra_overflow(a)) {
        show_poly(s, sum);
        return;
    }
    /* after an overflow, print A q'' + rest */
    bool leading = true;
    for (int j = 0; j < e->count; j++) {
        if (!poly_is_zero(e->mass[i * e->count + j])) {
            fputs(leading ? "" : " + ", s->out);
            show_grouped(s, e->mass[i * e->count + j]);
            show_times(s);
            show_symbol(s, e->unknowns[j].symbol, e->unknowns[j].order);
            leading = false;
        }
    }
    if (!poly_is_zero(rest) || leading) {
        fputs(leading ? "" : " + ", s->out);
        show_poly(s, rest);
    }
}

/* Prints "LEFT = RIGHT", in LaTeX "LEFT &= RIGHT". */
static void show_equation(const show *s, const equations *e, int i) {
    show_row row;
    const show *to = show_row_begin(&row, s);
    fputs("  ", to->out);
    write_left_side(to, e, i);
    fputs(s->style == SHOW_LATEX ? " &= " : " = ", to->out);
    show_poly(to, e->applied[i]);
    show_row_end(&row);
}

static void write_shown(const show *s, const char *kind, const symbol *what) {
    char *unit_name = shown_unit_name(what, 0);
    fprintf(s->out, "  %-10s %-10s [%s]%s%s\n", kind, what->name, unit_name,
            what->text[0] != '\0' ? "  " : "", what->text);
    free(unit_name);
}

static void write_values(const show *s, const equations *e, const char *kind,
                         const symbol *const *list, int count, const double *value,
                         const expr *const *given) {
    for (int i = 0; i < count; i++) {
        if (instance_has(e->instance, list[i]->effect)) {
            const unit_scale unit = shown_unit(list[i]);
            char *unit_name = shown_unit_name(list[i], 0);
            char *formula = shown_formula(given[i]);
            fprintf(s->out, "  %-10s %-10s = %.10g [%s]%s%s%s%s\n", kind, list[i]->name,
                    number_shown(value[i] / unit.scale * unit.divisor), unit_name,
                    formula != NULL ? " = " : "", formula != NULL ? formula : "",
                    list[i]->text[0] != '\0' ? "  " : "", list[i]->text);
            free(formula);
            free(unit_name);
        }
    }
}

static void write_names(const show *s, const equations *e) {
    const mechanism *m = e->instance->mechanism;
    fprintf(s->out, "%s %s%s%s\n\n", m->is_system ? "system" : "mechanism", m->name,
            m->title[0] != '\0' ? ": " : "", m->title);
    for (int i = 0; i < e->count; i++) {
        const bool driven = m->coordinates[i]->driven != NULL;
        write_shown(s,
                    driven         ? "driven"
                    : m->is_system ? "state"
                                   : "coordinate",
                    m->coordinates[i]);
    }
    write_values(s, e, "parameter", m->parameters, m->parameter_count, e->instance->parameter,
                 e->instance->parameter_given);
    write_values(s, e, "input", m->inputs, m->input_count, e->instance->input,
                 e->instance->input_given);
    for (int i = 0; i < m->effect_count; i++) {
        if (e->instance->with[i]) {
            fprintf(s->out, "  with       %-10s %s\n", m->effects[i].name, m->effects[i].text);
        }
    }
    for (int i = 0; i < m->output_count; i++) {
        write_shown(s, "output", m->outputs[i]);
    }
}

/* Generated names are a letter and a number. */
static bool is_numbered(const char *name, const char *letter) {
    const size_t length = strlen(letter);
    return strncmp(name, letter, length) == 0 && name[length] != '\0' &&
           strspn(name + length, "0123456789") == strlen(name + length);
}

/* Returns the first free letter, else the last. A letter y is taken if the mechanism has a name such as y1. */
static const char *free_letter(const mechanism *m, const char *const *letters) {
    const symbol *const *const list[] = {m->coordinates, m->parameters, m->inputs};
    const int count[] = {m->coordinate_count, m->parameter_count, m->input_count};
    for (bool taken = true; letters[1] != NULL && taken; letters += taken ? 1 : 0) {
        taken = false;
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < count[k]; i++) {
                taken = taken || is_numbered(list[k][i]->name, *letters);
            }
        }
    }
    return *letters;
}

/* Returns the number of a component of the state: values come first, then rates, and so on, as in the dissertation. */
static int show_y_number(const equations *e, int unknown_index, int primes) {
    int number = 1;
    for (int i = 0; i < e->count; i++) {
        const int before = primes + (i < unknown_index);
        number += before < e->unknowns[i].order ? before : e->unknowns[i].order;
    }
    return number;
}

bool show_closed_form(const equations *e, const poly **top, const poly **bottom) {
    algebra *a = e->algebra;
    const int n = e->count;
    int terms = 0;
    for (int i = 0; i < n && n <= 2; i++) {
        terms += equations_force(e, i)->count;
        for (int j = 0; j < n; j++) {
            terms += e->mass[i * n + j]->count;
        }
    }
    if (n > 2 || terms > 4 * READABLE_TERMS) {
        return false;
    }
    const poly *m[4];
    *bottom = poly_determinant(a, e->mass, n, (1U << n) - 1, (1U << n) - 1);
    int size = (*bottom)->count;
    for (int c = 0; c < n; c++) {
        for (int i = 0; i < n * n; i++) {
            m[i] = i % n == c ? equations_force(e, i / n) : e->mass[i];
        }
        top[c] = poly_determinant(a, m, n, (1U << n) - 1, (1U << n) - 1);
        size = top[c]->count > size ? top[c]->count : size;
    }
    return size <= READABLE_TERMS && !algebra_overflow(a);
}

/* The factor 0.739... prevents terms of *top and *bottom from cancelling in `both`. */
static void reduce(algebra *a, const poly **top, const poly **bottom) {
    const poly *both = poly_add(a, *top, poly_scale(a, *bottom, 0.7390851332151607));
    const poly *inverse = poly_pow(a, show_common(a, both), -1.0);
    piece *pieces = alloc((*top)->count + (*bottom)->count, sizeof *pieces);
    int count = pieces_of(a, *top, pieces);
    count += pieces_of(a, *bottom, pieces + count);
    const double number = show_common_number(pieces, count, true);
    free(pieces);
    *top = poly_scale(a, poly_mul(a, *top, inverse), 1.0 / number);
    *bottom = poly_scale(a, poly_mul(a, *bottom, inverse), 1.0 / number);
}

void show_fraction(const show *s, const poly *top, const poly *bottom) {
    algebra *a = s->algebra;
    const poly *shorter[2] = {top, bottom};
    if (!poly_is_zero(top) && bottom->count > 1) {
        reduce(a, &shorter[0], &shorter[1]);
    } else { /* divide each term */
        shorter[0] = poly_mul(a, top, poly_pow(a, bottom, -1.0));
        shorter[1] = poly_number(a, 1.0);
    }
    if (!algebra_overflow(a)) {
        top = shorter[0];
        bottom = shorter[1];
    }
    double value;
    if (poly_is_number(bottom, &value) && value == 1.0) {
        show_poly(s, top);
    } else if (s->style == SHOW_LATEX) {
        fputs("\\frac{", s->out);
        show_poly(s, top);
        fputs("}{", s->out);
        show_poly(s, bottom);
        fputs("}", s->out);
    } else {
        show_grouped(s, top);
        fputs("/", s->out);
        show_grouped(s, bottom);
    }
}

static void write_highest(const show *s, const equations *e, int i) {
    show_symbol(s, e->unknowns[i].symbol, e->unknowns[i].order);
}

static void write_first_order(const show *s, const equations *e) {
    const poly *top[2];
    const poly *bottom;
    const bool readable = show_closed_form(e, top, &bottom);
    int highest_order = 0;
    for (int i = 0; i < e->count; i++) {
        highest_order = e->unknowns[i].order > highest_order ? e->unknowns[i].order : highest_order;
    }
    static const char *const states[] = {"y", "s", "w", "state", NULL};
    static const char *const matrices[] = {"A", "M", "matrix", NULL};
    static const char *const forces[] = {"b", "f", "right", NULL};
    const char *y = free_letter(e->instance->mechanism, states);
    const char *A = free_letter(e->instance->mechanism, matrices);
    const char *b = free_letter(e->instance->mechanism, forces);
    fprintf(s->out, "\nfirst-order form, %s = (", y);
    for (int level = 0; level < highest_order; level++) {
        for (int i = 0; i < e->count; i++) {
            if (e->unknowns[i].order > level) {
                fputs(show_y_number(e, i, level) > 1 ? ", " : "", s->out);
                show_symbol(s, e->unknowns[i].symbol, level);
            }
        }
    }
    fprintf(s->out, ")\n\n");
    for (int level = 1; level <= highest_order; level++) {
        for (int i = 0; i < e->count; i++) {
            if (e->unknowns[i].order > level) {
                fprintf(s->out, "  %s%d' = %s%d\n", y, show_y_number(e, i, level - 1), y,
                        show_y_number(e, i, level));
            }
        }
    }
    for (int i = 0; i < e->count; i++) {
        fprintf(s->out, "  %s%d' = ", y, show_y_number(e, i, e->unknowns[i].order - 1));
        write_highest(s, e, i);
        if (readable) {
            fputs(" = ", s->out);
            show_fraction(s, top[i], bottom);
        }
        fputc('\n', s->out);
    }
    if (readable) {
        return;
    }
    fprintf(s->out, "\n  with the highest derivatives from %s x = %s, x = (", A, b);
    for (int i = 0; i < e->count; i++) {
        fputs(i > 0 ? ", " : "", s->out);
        write_highest(s, e, i);
    }
    fprintf(s->out, "):\n\n");
    /* a comma if an index may have two digits: A12, but A1,12 */
    const char *between = e->count > 9 ? "," : "";
    for (int i = 0; i < e->count; i++) {
        const bool symmetric = !e->instance->mechanism->is_system;
        for (int j = symmetric ? i : 0; j < e->count; j++) {
            fprintf(s->out, "  %s%d%s%d = ", A, i + 1, between, j + 1);
            if (symmetric && j > i) {
                fprintf(s->out, "%s%d%s%d = ", A, j + 1, between, i + 1);
            }
            show_poly(s, e->mass[i * e->count + j]);
            fputc('\n', s->out);
        }
    }
    for (int i = 0; i < e->count; i++) {
        fprintf(s->out, "  %s%d = ", b, i + 1);
        show_poly(s, equations_force(e, i));
        fputc('\n', s->out);
    }
}

void show_lets_end(show *s, const char *heading, const char *behind, const char *footing) {
    show_lets *lets = s->lets;
    char **text = alloc(lets->count, sizeof *text);
    size_t length;
    int used = 0;
    FILE *out = s->out;
    for (int i = lets->count - 1; i >= 0;
         i--) { /* backwards: writing row i marks earlier rows as used */
        lets->below = i;
        if (lets->row[i].used) {
            s->out = alloc_text(&text[i], &length);
            write_row(s, "  ", lets->row[i].let, 0, s->style == SHOW_LATEX ? " &= " : " = ",
                      lets->row[i].value, "");
            alloc_text_end(s->out);
            used++;
        }
    }
    s->out = out;
    fputs(used > 0 ? heading : "", out);
    for (int i = 0; i < lets->count; i++) {
        if (text[i] != NULL) {
            used--;
            fprintf(out, "%s%s", text[i], used > 0 ? behind : footing);
            free(text[i]);
        }
    }
    free(text);
    free(lets);
    s->lets = NULL;
}

void show_text(FILE *out, const equations *e) {
    show s = show_start(out, SHOW_TEXT, e->algebra);
    const bool system = e->instance->mechanism->is_system;
    show_lets_begin(&s, e);
    write_names(&s, e);
    fprintf(out, system ? "\nequations\n\n"
                        : "\nequations of motion, d/dt(dL/dq') - dL/dq = -dF/dq' + Q\n\n");
    for (int i = 0; i < e->count; i++) {
        if (!system) {
            fprintf(out, "  %s:", e->unknowns[i].symbol->name);
        }
        show_equation(&s, e, i);
        fputc('\n', out);
    }
    show_contacts(&s, e);
    write_first_order(&s, e);
    show_lets_end(&s, "\nwith\n\n", "\n", "\n");
}

static void write_solved(const show *s, const equations *e, const poly *const *top,
                         const poly *bottom) {
    fprintf(s->out, "%% solved for the highest derivatives\n\\begin{align}\n");
    for (int i = 0; i < e->count; i++) {
        show_row row;
        const show *to = show_row_begin(&row, s);
        fputs("  ", to->out);
        write_highest(to, e, i);
        fputs(" &= ", to->out);
        show_fraction(to, top[i], bottom);
        show_row_end(&row);
        fputs(i + 1 < e->count ? " \\\\\n" : "\n", s->out);
    }
    fprintf(s->out, "\\end{align}\n");
}

void show_latex(FILE *out, const equations *e) {
    show s = show_start(out, SHOW_LATEX, e->algebra);
    const poly *top[2];
    const poly *bottom;
    show_lets_begin(&s, e);
    fprintf(out, "%% %s: equations of motion\n", e->instance->mechanism->name);
    fprintf(out, "\\begin{align}\n");
    for (int i = 0; i < e->count; i++) {
        show_equation(&s, e, i);
        fputs(i + 1 < e->count ? " \\\\\n" : "\n", out);
    }
    fprintf(out, "\\end{align}\n");
    show_contacts(&s, e);
    if (show_closed_form(e, top, &bottom)) {
        write_solved(&s, e, top, bottom);
    }
    show_lets_end(&s, "% with\n\\begin{align}\n", " \\\\\n", "\n\\end{align}\n");
}
