/* show_octave.c: the equations as a function file for Octave and Matlab, with the names of the scene file. Parameters,
 * inputs and state come first, as in the listings of the dissertation's appendices. */
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/lexer.h"
#include "host/lang/value.h"
#include "host/show/show.h"

/* A variable of the generated file: a symbol or its derivative, or (symbol NULL) A, b or x of A x = b. */
typedef struct variable {
    const symbol *symbol;
    int primes;
    char *name;
} variable;

typedef struct variables {
    bool (*is_free)(const char *name);
    variable *row;
    int count;
} variables;

/* Adds a variable ("ddX" for X''). If its name is taken, appends "_", or prepends "v" if the name begins with "_". */
static const char *add(variables *all, const symbol *sym, int primes, const char *name) {
    char *made = alloc_words("%.*s%s", primes, "ddddddddddddddd", name);
    bool taken = true;
    while (taken) {
        taken = !all->is_free(made);
        for (int i = 0; i < all->count && !taken; i++) {
            taken = strcmp(all->row[i].name, made) == 0;
        }
        if (taken) {
            char *longer = alloc_words(made[0] == '_' ? "v%s" : "%s_", made);
            free(made);
            made = longer;
        }
    }
    all->row = alloc_more(all->row, all->count + 1, sizeof *all->row);
    all->row[all->count++] = (variable){sym, primes, made};
    return made;
}

static const char *find(const void *names, const symbol *sym, int primes) {
    const variables *all = names;
    for (int i = 0; i < all->count; i++) {
        if (all->row[i].symbol == sym && all->row[i].primes == primes) {
            return all->row[i].name;
        }
    }
    return sym->name;
}

/* Writes lines such as "  K1 = 8756.3; % [kg/s^2] = 50 [lbf/in]: the first spring". */
static void write_constants(const show *s, const equations *e, const symbol *const *list, int count,
                            const double *value, const expr *const *given) {
    for (int i = 0; i < count; i++) {
        if (instance_has(e->instance, list[i]->effect)) {
            char *unit = shown_si_name(list[i], 0);
            char *written =
                unit_is_si(list[i]->declared) ? shown_formula(given[i]) : shown_written(given[i]);
            fprintf(s->out, "  %s = ", find(s->names, list[i], 0));
            show_number(s, value[i]);
            fprintf(s->out, "; %% [%s]%s%s%s%s\n", unit, written != NULL ? " = " : "",
                    written != NULL ? written : "",
                    list[i]->text[0] == '\0' ? ""
                    : written != NULL        ? ": "
                                             : " ",
                    list[i]->text);
            free(written);
            free(unit);
        }
    }
}

/* Writes a formula for each highest derivative, or the solution of A x = b. */
static void write_highest(const show *s, const equations *e, variables *all) {
    const int n = e->count;
    const poly *top[2];
    const poly *bottom;
    if (show_closed_form(e, top, &bottom)) {
        for (int i = 0; i < n; i++) {
            fprintf(s->out, "  %s = ", find(all, e->unknowns[i].symbol, e->unknowns[i].order));
            show_fraction(s, top[i], bottom);
            fputs(";\n", s->out);
        }
        return;
    }
    const char *A = add(all, NULL, 0, "A");
    const char *b = add(all, NULL, 0, "b");
    const char *x = add(all, NULL, 0, "x");
    fprintf(s->out, "  %s = zeros(%d, %d);\n  %s = zeros(%d, 1);\n", A, n, n, b, n);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            if (!poly_is_zero(e->mass[i * n + j])) {
                fprintf(s->out, "  %s(%d, %d) = ", A, i + 1, j + 1);
                show_poly(s, e->mass[i * n + j]);
                fputs(";\n", s->out);
            }
        }
        fprintf(s->out, "  %s(%d) = ", b, i + 1);
        show_poly(s, equations_force(e, i));
        fputs(";\n", s->out);
    }
    fprintf(s->out, "  %s = %s \\ %s;\n", x, A, b);
    for (int i = 0; i < n; i++) {
        fprintf(s->out, "  %s = %s(%d);\n", find(all, e->unknowns[i].symbol, e->unknowns[i].order),
                x, i + 1);
    }
}

static void name_all(variables *all, const equations *e) {
    const mechanism *m = e->instance->mechanism;
    const symbol *const *const list[] = {m->parameters, m->inputs, m->lets};
    const int count[] = {m->parameter_count, m->input_count, m->let_count};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < count[k]; i++) {
            add(all, list[k][i], 0, list[k][i]->name);
        }
    }
    for (int primes = 0; primes <= PRIMES_MAX; primes++) {
        for (int i = 0; i < e->count; i++) {
            if (primes <= e->unknowns[i].order) {
                add(all, e->unknowns[i].symbol, primes, e->unknowns[i].symbol->name);
            }
        }
    }
}

/* In Octave's state y, all values come before all rates. */
static void write_state(const show *s, const equations *e, bool slopes) {
    int number = 1;
    for (int level = 0; level < PRIMES_MAX; level++) {
        for (int i = 0; i < e->count; i++) {
            const symbol *q = e->unknowns[i].symbol;
            if (e->unknowns[i].order <= level) {
                continue;
            }
            if (slopes) {
                fprintf(s->out, "%s%s", number > 1 ? "; " : "", find(s->names, q, level + 1));
            } else {
                char *unit = shown_si_name(q, level);
                fprintf(s->out, "  %s = y(%d); %% [%s]%s%s\n", find(s->names, q, level), number,
                        unit, level == 0 && q->text[0] != '\0' ? " " : "",
                        level == 0 ? q->text : "");
                free(unit);
            }
            number++;
        }
    }
}

void show_octave(FILE *out, const equations *e, bool (*is_free)(const char *name)) {
    const mechanism *m = e->instance->mechanism;
    variables all = {.is_free = is_free};
    show s = show_start(out, SHOW_TEXT, e->algebra);
    name_all(&all, e);
    s.name = find;
    s.names = &all;
    write_constants(&s, e, m->parameters, m->parameter_count, e->instance->parameter,
                    e->instance->parameter_given);
    write_constants(&s, e, m->inputs, m->input_count, e->instance->input, e->instance->input_given);
    write_state(&s, e, false);
    char *text;
    size_t length;
    s.out = alloc_text(&text, &length); /* printed after the definitions that it uses */
    show_lets_begin(&s, e);
    write_highest(&s, e, &all);
    alloc_text_end(s.out);
    s.out = out;
    show_lets_end(&s, "", ";\n", ";\n");
    fputs(text, out);
    free(text);
    fputs("  dy = [", out);
    write_state(&s, e, true);
    fputs("];\n", out);
    for (int i = 0; i < all.count; i++) {
        free(all.row[i].name);
    }
    free(all.row);
}
