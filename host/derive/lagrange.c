/* lagrange.c: Lagrange's equations, and systems given by their equations. */
#include "lagrange.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "singular.h"

/* --- energies ------------------------------------------------------------------------------------*/

static const poly *sum_of_terms(algebra *a, const instance *inst, term_kind kind) {
    const mechanism *m = inst->mechanism;
    const poly *sum = poly_number(a, 0.0);
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        if (t->kind == kind && instance_has_term(inst, t)) {
            sum = poly_add(a, sum, poly_from_expr(a, t->value));
        }
    }
    return sum;
}

/* An input without a rate must not occur in a momentum. */
static bool momentum_free_of_inputs(const equations *e, const poly *momentum, diags *errors) {
    const mechanism *m = e->instance->mechanism;
    char hint[RATE_HINT_SIZE];
    for (int i = 0; i < m->input_count; i++) {
        if (poly_contains(momentum, m->inputs[i], 0)) {
            diag_error(errors, equations_kinetic_place(e->instance),
                       input_rate_hint(m->inputs[i], hint),
                       "the kinetic energy depends on input '%s', whose rate is not known",
                       m->inputs[i]->name);
            return false;
        }
    }
    return true;
}

/* The acceleration of an input with a rate. */
static const poly *acceleration_of(algebra *a, const symbol *driven) {
    const symbol *input = symbol_acceleration(driven);
    return input != NULL ? poly_symbol(a, input, 0) : poly_number(a, 0.0);
}

/* Its equation: q'' = that. It has no momentum, and no force moves it. */
static void drive(equations *e, int i) {
    algebra *a = e->algebra;
    e->momentum[i] = e->velocity[i] = e->potential[i] = poly_number(a, 0.0);
    for (int j = 0; j < e->count; j++) {
        e->mass[i * e->count + j] = poly_number(a, i == j ? 1.0 : 0.0);
    }
    e->applied[i] = acceleration_of(a, e->unknowns[i].symbol);
}

static bool derive_lagrange(equations *e, diags *errors) {
    algebra *a = e->algebra;
    const int n = e->count;
    e->kinetic = sum_of_terms(a, e->instance, TERM_T);
    e->stored = sum_of_terms(a, e->instance, TERM_V);
    e->force = forces_derive(a, e->instance, &e->forces);
    const poly *lagrangian = poly_sub(a, e->kinetic, e->stored);

    for (int i = 0; i < n && !algebra_overflow(a); i++) {
        const symbol *q = e->unknowns[i].symbol;
        if (q->driven != NULL) {
            drive(e, i);
            continue;
        }
        const poly *momentum = poly_derivative(a, lagrangian, q, 1);
        if (!momentum_free_of_inputs(e, momentum, errors)) {
            return false;
        }
        e->momentum[i] = momentum;
        e->velocity[i] = poly_scale(a, poly_derivative(a, e->kinetic, q, 0), -1.0);
        e->potential[i] = poly_derivative(a, e->stored, q, 0);
        for (int j = 0; j < n; j++) {
            const symbol *other = e->unknowns[j].symbol;
            e->mass[i * n + j] = poly_derivative(a, momentum, other, 1);
            const poly *drift =
                poly_mul(a, poly_derivative(a, momentum, other, 0), poly_symbol(a, other, 1));
            e->velocity[i] = poly_add(a, e->velocity[i], drift);
            if (other->driven != NULL) { /* its acceleration is known */
                const poly *push = poly_mul(a, e->mass[i * n + j], acceleration_of(a, other));
                e->velocity[i] = poly_add(a, e->velocity[i], push);
                e->mass[i * n + j] = poly_number(a, 0.0);
            }
        }
        e->applied[i] = forces_on(a, e->force, e->forces, i);
        const poly *slope = poly_expanded(a, poly_derivative(a, lagrangian, q, 0));
        e->conserved[i] = poly_is_zero(slope) && poly_is_zero(e->applied[i]) &&
                          !poly_is_zero(momentum) && !contact_laws_push(e->contacts, i);
    }
    return true;
}

/* --- systems given outright ----------------------------------------------------------------------*/

static int highest_order(const poly *p, const symbol *s) {
    for (int order = 8; order > 0; order--) {
        if (poly_contains(p, s, order)) {
            return order;
        }
    }
    return 0;
}

static const poly *drop_highest(void *context, algebra *a, const symbol *sym, int primes) {
    const equations *e = context;
    for (int i = 0; i < e->count; i++) {
        if (e->unknowns[i].symbol == sym && e->unknowns[i].order == primes) {
            return poly_number(a, 0.0);
        }
    }
    return NULL;
}

static bool derive_system(equations *e, diags *errors) {
    algebra *a = e->algebra;
    const mechanism *m = e->instance->mechanism;
    const int n = e->count;
    const poly **left = alloc(n, sizeof *left);
    const term **term_at = alloc(n, sizeof *term_at);
    bool good = true;
    int rows = 0;
    for (int t = 0; t < m->term_count && rows < n; t++) {
        if (m->terms[t].kind == TERM_EQUATION && instance_has_term(e->instance, &m->terms[t])) {
            term_at[rows] = &m->terms[t];
            left[rows++] = poly_sub(a, poly_from_expr(a, m->terms[t].value),
                                    poly_from_expr(a, m->terms[t].right));
        }
    }
    for (int s = 0; s < n; s++) {
        e->unknowns[s].order = 0;
        for (int r = 0; r < rows; r++) {
            const int order = highest_order(left[r], e->unknowns[s].symbol);
            e->unknowns[s].order = order > e->unknowns[s].order ? order : e->unknowns[s].order;
        }
        if (e->unknowns[s].order == 0) {
            diag_error(
                errors, e->unknowns[s].symbol->at, "every state needs an equation with its rate",
                "no equation contains a derivative of state '%s'", e->unknowns[s].symbol->name);
            good = false;
        }
    }
    for (int r = 0; r < rows && good && !algebra_overflow(a); r++) {
        for (int s = 0; s < n; s++) {
            const unknown *u = &e->unknowns[s];
            const poly *coefficient = poly_derivative(a, left[r], u->symbol, u->order);
            e->mass[r * n + s] = coefficient;
            for (int k = 0; k < n; k++) {
                if (poly_contains(coefficient, e->unknowns[k].symbol, e->unknowns[k].order)) {
                    diag_error(errors, term_at[r]->at,
                               "solve the equation for it first, or add a state for the inner part",
                               "this equation is not linear in the highest derivatives: %s",
                               u->symbol->name);
                    good = false;
                    break;
                }
            }
            if (!good) {
                break;
            }
        }
        e->potential[r] = poly_substitute(a, left[r], drop_highest, e);
        e->velocity[r] = poly_number(a, 0.0);
        e->applied[r] = poly_number(a, 0.0);
    }
    free(left);
    free(term_at);
    return good;
}

/* --- both ----------------------------------------------------------------------------------------*/

static const poly **polys(int count) { return alloc(count, sizeof(const poly *)); }

/* Beyond the limits of the algebra, or of walks through its results? */
static bool too_large(const equations *e) {
    if (algebra_overflow(e->algebra)) {
        return true; /* and the unvisited part is missing */
    }
    double size = 0.0;
    for (int i = 0; i < e->count; i++) {
        if (e->velocity[i] == NULL || e->potential[i] == NULL || e->applied[i] == NULL) {
            return true;
        }
        size += e->velocity[i]->size + e->potential[i]->size + e->applied[i]->size;
        for (int j = 0; j < e->count; j++) {
            size += e->mass[i * e->count + j]->size;
        }
    }
    return size > POLY_SIZE_MAX;
}

equations *equations_derive(const instance *inst, diags *errors) {
    return equations_derive_after(inst, NULL, NULL, errors);
}

equations *equations_derive_after(const instance *inst, equations_question *before, void *context,
                                  diags *errors) {
    const mechanism *m = inst->mechanism;
    const int n = m->coordinate_count;
    equations *e = alloc(1, sizeof *e);
    e->folding = inst->folding;
    e->folding.way = folding_way();
    folding *const before_it = folding_use(&e->folding);
    e->algebra = algebra_new();
    if (before != NULL) {
        before(context, e->algebra, inst);
    }
    e->instance = inst;
    e->count = n;
    e->unknowns = alloc(n, sizeof *e->unknowns);
    e->conserved = alloc(n, sizeof *e->conserved);
    e->mass = polys(n * n);
    e->velocity = polys(n);
    e->potential = polys(n);
    e->applied = polys(n);
    e->momentum = polys(n);
    e->output = polys(m->output_count);
    for (int i = 0; i < n; i++) {
        e->unknowns[i] = (unknown){m->coordinates[i], 2};
        poly_symbol(e->algebra, m->coordinates[i], 0); /* coordinates lead the canonical order */
    }
    for (int i = 0; i < m->parameter_count; i++) {
        poly_symbol(e->algebra, m->parameters[i], 0);
    }
    for (int i = 0; i < n; i++) {
        poly_symbol(e->algebra, m->coordinates[i], 1);
    }
    e->contacts = contact_laws_make(e->algebra, inst);
    bool good = m->is_system ? derive_system(e, errors) : derive_lagrange(e, errors);
    for (int i = 0; i < m->output_count && good; i++) {
        e->output[i] = poly_from_expr(e->algebra, m->outputs[i]->value);
    }
    if (good && too_large(e)) {
        equations_report_growth(e, errors);
        good = false;
    }
    if (good) {
        good = equations_check_solvable(e, errors);
    }
    (void)folding_use(before_it);
    if (!good) {
        equations_free(e);
        return NULL;
    }
    return e;
}
