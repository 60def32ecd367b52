/* contacts.c: the symbolic contacts of an instance, and their derivatives. */
#include "contacts.h"

#include <stdlib.h>

#include "host/base/alloc.h"

/* sum_i d(value)/dq_i q_i'. */
static const poly *rate_of(algebra *a, const mechanism *m, const poly *value) {
    const poly *sum = poly_number(a, 0.0);
    for (int i = 0; i < m->coordinate_count; i++) {
        const symbol *q = m->coordinates[i];
        const poly *slope = poly_derivative(a, value, q, 0);
        sum = poly_add(a, sum, poly_mul(a, slope, poly_symbol(a, q, 1)));
    }
    return sum;
}

static void make_constraint(algebra *a, const mechanism *m, const poly *held, contact_law *law) {
    const poly *zero = poly_number(a, 0.0);
    law->row = alloc(m->coordinate_count, sizeof(const poly *));
    law->speed = rate_of(a, m, held);
    law->bias = zero;
    law->straight = true;
    for (int i = 0; i < m->coordinate_count; i++) {
        const symbol *q = m->coordinates[i];
        law->row[i] = poly_derivative(a, held, q, 0);
        const poly *turning = rate_of(a, m, law->row[i]);
        law->bias = poly_add(a, law->bias, poly_mul(a, turning, poly_symbol(a, q, 1)));
        double number;
        const bool driven = q->driven != NULL && !poly_is_zero(law->row[i]);
        law->driven = law->driven || driven;
        law->straight = law->straight && !driven && poly_is_number(law->row[i], &number);
    }
}

static void make_law(algebra *a, const mechanism *m, const contact_statement *from,
                     contact_law *law, contact_set *set) {
    const poly *zero = poly_number(a, 0.0);
    law->from = from;
    law->first = law->second = law->bias = law->speed = zero;
    switch (from->kind) {
    case CONTACT_STOP:
        law->value = poly_from_expr(a, from->value);
        law->first = poly_from_expr(a, from->restitution);
        make_constraint(a, m, law->value, law);
        break;
    case CONTACT_HOLD:
        law->value = poly_from_expr(a, from->condition);
        make_constraint(a, m, poly_from_expr(a, from->value), law);
        law->first = law->straight ? zero : poly_from_expr(a, from->value);
        break;
    case CONTACT_FRICTION: {
        const poly *normal = poly_call(a, FN_MAX, poly_from_expr(a, from->normal), zero);
        law->first = poly_mul(a, poly_from_expr(a, from->static_friction), normal);
        law->second = poly_mul(a, poly_from_expr(a, from->kinetic_friction), normal);
        law->value = poly_symbol(a, from->coordinate, 1);
        make_constraint(a, m, poly_symbol(a, from->coordinate, 0), law);
        law->speed = zero;
        break;
    }
    case CONTACT_WHEN:
        law->value = poly_from_expr(a, from->value);
        set->value = alloc(from->set_count, sizeof(const poly *));
        for (int i = 0; i < from->set_count; i++) {
            set->value[i] = poly_from_expr(a, from->sets[i].value);
        }
        break;
    }
}

bool contact_loosens(const contact_statement *h) {
    return h->kind == CONTACT_WHEN && h->normal != NULL;
}

/* Does the motion change it? Inputs change it only between steps. */
static bool moves(algebra *a, const mechanism *m, const poly *value) {
    for (int i = 0; i < m->coordinate_count; i++) {
        for (int primes = 0; primes < 2; primes++) {
            if (!poly_is_zero(poly_derivative(a, value, m->coordinates[i], primes))) {
                return true;
            }
        }
    }
    return false;
}

/* After all others, a crossing for every friction whose normal force may vanish, as long as there is space. */
static void make_loosening(algebra *a, const mechanism *m, contact_laws *laws) {
    const int written = laws->count;
    laws->loose = alloc(written, sizeof *laws->loose);
    for (int k = 0; k < written && laws->count < CONTACTS_MAX; k++) {
        const contact_statement *of = laws->law[k].from;
        if (of->kind == CONTACT_FRICTION && moves(a, m, poly_from_expr(a, of->normal))) {
            contact_statement *h = &laws->loose[laws->loosening++];
            *h = (contact_statement){.kind = CONTACT_WHEN,
                                     .value = of->normal,
                                     .normal = of->normal,
                                     .effect = of->effect,
                                     .at = of->at};
            make_law(a, m, h, &laws->law[laws->count], &laws->sets[laws->count]);
            laws->count++;
        }
    }
}

contact_laws *contact_laws_make(algebra *a, const instance *inst) {
    const mechanism *m = inst->mechanism;
    const int own = inst->scene != NULL ? inst->scene->when_count : 0;
    const int most = 2 * m->contact_count + own; /* a crossing for each friction */
    contact_laws *laws = alloc(1, sizeof *laws);
    laws->law = alloc(most, sizeof *laws->law);
    laws->sets = alloc(most, sizeof *laws->sets);
    for (int k = 0; k < CONTACT_KINDS; k++) {
        for (int i = 0; i < m->contact_count + own; i++) {
            const contact_statement *h =
                i < m->contact_count ? &m->contacts[i] : &inst->scene->whens[i - m->contact_count];
            if (h->kind != (contact_kind)k ||
                (i < m->contact_count && !instance_has_contact(inst, h))) {
                continue;
            }
            make_law(a, m, h, &laws->law[laws->count], &laws->sets[laws->count]);
            laws->count++;
            laws->forced += h->kind != CONTACT_WHEN;
            laws->set_count += h->kind == CONTACT_WHEN ? h->set_count : 0;
        }
    }
    if (laws->count == 0) {
        contact_laws_free(laws);
        return NULL;
    }
    make_loosening(a, m, laws);
    return laws;
}

void contact_laws_free(contact_laws *laws) {
    if (laws == NULL) {
        return;
    }
    for (int k = 0; k < laws->count; k++) {
        free(laws->law[k].row);
        free(laws->sets[k].value);
    }
    free(laws->loose);
    free(laws->law);
    free(laws->sets);
    free(laws);
}

bool contact_law_pushes(const contact_law *law, int i) {
    return law->row == NULL ? law->from->set_count > 0 : !poly_is_zero(law->row[i]);
}

bool contact_laws_push(const contact_laws *laws, int i) {
    for (int k = 0; k < (laws != NULL ? laws->count : 0); k++) {
        if (contact_law_pushes(&laws->law[k], i)) {
            return true;
        }
    }
    return false;
}
