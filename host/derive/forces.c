/* forces.c: see forces.h. */
#include "forces.h"

#include <stdlib.h>

#include "host/base/room.h"

static statement_force force_of(algebra *a, const mechanism *m, const term *t) {
    statement_force made = {t, room(m->coordinate_count, sizeof(const poly *)),
                            poly_number(a, 0.0)};
    const poly *value = poly_from_expr(a, t->value);
    for (int i = 0; i < m->coordinate_count; i++) {
        const symbol *q = m->coordinates[i];
        made.force[i] = poly_number(a, 0.0);
        if (t->kind == TERM_F) {
            made.force[i] = poly_scale(a, poly_derivative(a, value, q, 1), -1.0);
        } else if (t->coordinate == q) {
            made.force[i] = value;
        }
        made.power = poly_add(a, made.power, poly_mul(a, made.force[i], poly_symbol(a, q, 1)));
    }
    return made;
}

statement_force *forces_derive(algebra *a, const instance *inst, int *count) {
    const mechanism *m = inst->mechanism;
    statement_force *forces = room(m->term_count, sizeof *forces);
    *count = 0;
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        if ((t->kind == TERM_Q || t->kind == TERM_F) && instance_has_term(inst, t)) {
            forces[(*count)++] = force_of(a, m, t);
        }
    }
    return forces;
}

void forces_free(statement_force *forces, int count) {
    for (int i = 0; i < count; i++) {
        free(forces[i].force);
    }
    free(forces);
}

const poly *forces_on(algebra *a, const statement_force *forces, int count, int i) {
    const poly *sum = poly_number(a, 0.0);
    for (int k = 0; k < count; k++) {
        sum = poly_add(a, sum, forces[k].force[i]);
    }
    return sum;
}

const poly *forces_power(algebra *a, const statement_force *forces, int count, term_kind kind) {
    const poly *sum = poly_number(a, 0.0);
    for (int k = 0; k < count; k++) {
        sum = forces[k].from->kind == kind ? poly_add(a, sum, forces[k].power) : sum;
    }
    return sum;
}
