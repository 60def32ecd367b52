/* equations.c: what is asked of equations that stand, or nearly so. */
#include "equations.h"

#include <stdio.h>
#include <stdlib.h>

place equations_kinetic_place(const instance *inst) {
    const mechanism *m = inst->mechanism;
    for (int i = 0; i < m->term_count; i++) {
        if (m->terms[i].kind == TERM_T && instance_has_term(inst, &m->terms[i])) {
            return m->terms[i].at;
        }
    }
    return m->at;
}

const poly *equations_force(const equations *e, int i) {
    algebra *a = e->algebra;
    return poly_sub(a, poly_sub(a, e->applied[i], e->velocity[i]), e->potential[i]);
}

static const poly *parameter_value(void *context, algebra *a, const symbol *s, int primes) {
    const instance *inst = context;
    (void)primes;
    return s->kind == SYM_PARAMETER ? poly_number(a, inst->parameter[s->index]) : NULL;
}

const poly *equations_fold(const equations *e, const poly *p) {
    /* poly_substitute() does not write through its context */
    return poly_substitute(e->algebra, p, parameter_value, (void *)(uintptr_t)e->instance);
}

void equations_report_growth(const equations *e, diags *errors) {
    const mechanism *m = e->instance->mechanism;
    char *limit = algebra_limit(e->algebra);
    char hint[200] = "smaller powers of sums, or coordinates nearer to the joints, help";
    if (m->parameter_count >
        0) { /* products of parameters are terms of their own, those of numbers none */
        snprintf(hint, sizeof hint,
                 "write let in place of parameter: %d of them become numbers; smaller powers of "
                 "sums, or coordinates nearer to the joints, help too",
                 m->parameter_count);
    }
    diag_error(errors, m->at, hint, "the equations of '%s' grow beyond what can be handled: %s",
               m->name, limit);
    free(limit);
}

void equations_free(equations *e) {
    if (e == NULL) {
        return;
    }
    forces_free(e->force, e->forces);
    free(e->unknowns);
    free(e->mass);
    free(e->velocity);
    free(e->potential);
    free(e->applied);
    free(e->momentum);
    free(e->conserved);
    free(e->output);
    contact_laws_free(e->contacts);
    algebra_free(e->algebra);
    free(e);
}
