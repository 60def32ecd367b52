/* influence.c: the search of forces, losses and contacts for one coordinate. */
#include "influence.h"

#include <stdio.h>
#include <string.h>

/* Influences listed by name, at most. */
enum { TOLD_MAX = 4 };

static void tell(char text[INFLUENCE_TEXT_SIZE], int *count, const char *what, place at) {
    const size_t used = strlen(text);
    if (*count < TOLD_MAX) {
        snprintf(text + used, INFLUENCE_TEXT_SIZE - used, "%s%s in line %d", *count > 0 ? ", " : "",
                 what, at.line);
    } else if (*count == TOLD_MAX) {
        snprintf(text + used, INFLUENCE_TEXT_SIZE - used, " and more");
    }
    ++*count;
}

const char *influence_on(const equations *e, int i, char text[INFLUENCE_TEXT_SIZE], int *count) {
    algebra *a = e->algebra;
    const mechanism *m = e->instance->mechanism;
    const symbol *q = e->unknowns[i].symbol;
    text[0] = '\0';
    *count = 0;
    for (int k = 0; k < m->term_count; k++) {
        const term *each = &m->terms[k];
        if (!instance_has_term(e->instance, each)) {
            continue;
        }
        const poly *value = poly_from_expr(a, each->value);
        if (each->kind == TERM_Q && each->coordinate == q && !poly_is_zero(value)) {
            tell(text, count, "the Q", each->at);
        } else if (each->kind == TERM_F && !poly_is_zero(poly_derivative(a, value, q, 1))) {
            tell(text, count, "the F", each->at);
        }
    }
    for (int k = 0; k < (e->contacts != NULL ? e->contacts->count : 0); k++) {
        const contact_law *law = &e->contacts->law[k];
        if (contact_law_pushes(law, i)) {
            tell(text, count, contact_called(law->from->kind), law->from->at);
        }
    }
    return text;
}

static bool names(const poly *p, const symbol *q) { return p != NULL && poly_contains(p, q, 0); }

static bool contact_names(const equations *e, const contact_law *law, const contact_set *set,
                          const symbol *q) {
    bool found = names(law->value, q) || names(law->speed, q) || names(law->first, q) ||
                 names(law->second, q) || names(law->bias, q);
    for (int i = 0; i < e->count && law->row != NULL; i++) {
        found = found || names(law->row[i], q);
    }
    for (int i = 0; i < law->from->set_count && set->value != NULL; i++) {
        found = found || names(set->value[i], q);
    }
    return found;
}

bool influence_of(const equations *e, const symbol *q) {
    const mechanism *m = e->instance->mechanism;
    bool found = false;
    for (int k = 0; k < m->term_count && !found; k++) {
        const term *each = &m->terms[k];
        found = instance_has_term(e->instance, each) &&
                (each->kind == TERM_Q || each->kind == TERM_F) &&
                names(poly_from_expr(e->algebra, each->value), q);
    }
    for (int k = 0; k < (e->contacts != NULL ? e->contacts->count : 0) && !found; k++) {
        found = contact_names(e, &e->contacts->law[k], &e->contacts->sets[k], q);
    }
    return found;
}
