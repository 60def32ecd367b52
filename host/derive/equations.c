/* equations.c: queries on complete equations. */
#include "host/derive/equations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "host/base/alloc.h"

static statement_force force_of(algebra *a, const mechanism *m, const term *t) {
    statement_force made = {t, alloc(m->coordinate_count, sizeof(const poly *)),
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
    statement_force *forces = alloc(m->term_count, sizeof *forces);
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

/* === questions to finished equations ========================================================== */

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
        0) { /* products of parameters are separate terms, products of numbers are not */
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

/* === the energy in the balance ================================================================ */
/* The test for a quadratic form of the rates, and the energy integral of other forms. */

/* Sampled states; so many must give finite values. */
#define TRIES 12
#define TRIES_NEEDED 3
/* Round-off allowed in Euler's theorem, relative to its terms. T must be exactly zero at rest, so this test only has to
 * find kinks, such as abs(x'), whose second derivative vanishes. */
#define EULER_ROUNDING 1e-9

typedef struct trial_state {
    const instance *instance;
    unsigned number;
    bool at_rest;
} trial_state;

/* Numbers between 0.2 and 1.8, rates with either sign: fractional parts of multiples of an irrational root. */
static double trial_value(void *context, const symbol *s, int primes) {
    const trial_state *state = context;
    if (s->kind == SYM_PARAMETER) {
        return state->instance->parameter[s->index];
    }
    if (s->kind == SYM_INPUT) {
        return state->instance->input[s->index];
    }
    const double turns = 0.6180339887498949 * (double)(state->number + 1U) +
                         0.4142135623730950 * (double)(s->index + 1) * (double)(primes + 1);
    const double size = 0.2 + 1.6 * (turns - number_floor(turns));
    if (primes == 0) {
        return size;
    }
    return state->at_rest ? 0.0 : (((unsigned)s->index + state->number) % 2U == 0 ? size : -size);
}

/* Does p contain the rate of any coordinate? */
static bool has_rates(const equations *e, const poly *p) {
    for (int i = 0; i < e->count; i++) {
        if (poly_contains(p, e->unknowns[i].symbol, 1)) {
            return true;
        }
    }
    return false;
}

bool energy_mass_has_rates(const equations *e) {
    for (int i = 0; i < e->count * e->count; i++) {
        if (has_rates(e, e->mass[i])) {
            return true;
        }
    }
    return false;
}

/* At rest a quadratic form and its derivatives are zero. *known: they are finite there. */
static bool nothing_at_rest(const equations *e, unsigned number, bool *known) {
    trial_state state = {e->instance, number, true};
    double most = fabs(poly_evaluate(e->kinetic, trial_value, &state));
    for (int i = 0; i < e->count; i++) {
        most += fabs(poly_evaluate(e->momentum[i], trial_value, &state));
    }
    *known = isfinite(most);
    return most == 0.0;
}

/* Euler's theorem: sum q' dT/dq' = 2 T. */
static bool twice_itself(const equations *e, unsigned number, bool *known) {
    trial_state state = {e->instance, number, false};
    double rest = -2.0 * poly_evaluate(e->kinetic, trial_value, &state);
    double size = fabs(rest);
    for (int i = 0; i < e->count; i++) {
        const double part = trial_value(&state, e->unknowns[i].symbol, 1) *
                            poly_evaluate(e->momentum[i], trial_value, &state);
        rest += part;
        size += fabs(part);
    }
    *known = isfinite(size);
    return fabs(rest) <= EULER_ROUNDING * size;
}

/* Is T a homogeneous quadratic form of the rates, and V free of them? If no mass contains a rate, T has degree two at
 * most. Its parts of degree one and zero show at rest. */
static bool is_quadratic(const equations *e) {
    if (has_rates(e, e->stored) || energy_mass_has_rates(e)) {
        return false;
    }
    int tried = 0;
    for (unsigned number = 0; number < TRIES; number++) {
        bool known[2];
        const bool nothing = nothing_at_rest(e, number, &known[0]);
        const bool twice = twice_itself(e, number, &known[1]);
        if (known[0] && known[1]) {
            if (!nothing || !twice) {
                return false;
            }
            tried++;
        }
    }
    return tried >= TRIES_NEEDED;
}

const poly *energy_integral(const equations *e) {
    algebra *a = e->algebra;
    if (e->kinetic == NULL || is_quadratic(e)) {
        return NULL;
    }
    const poly *h = poly_sub(a, e->stored, e->kinetic);
    for (int i = 0; i < e->count; i++) {
        const poly *rate = poly_symbol(a, e->unknowns[i].symbol, 1);
        h = poly_add(a, h, poly_mul(a, rate, e->momentum[i]));
    }
    h = equations_fold(e, h);
    const poly *sum = equations_fold(e, poly_add(a, e->kinetic, e->stored));
    return poly_is_zero(poly_sub(a, h, sum)) ? NULL : h;
}

const poly *energy_drive(const equations *e, int i) {
    algebra *a = e->algebra;
    const symbol *q = e->unknowns[i].symbol;
    const poly *lagrangian = poly_sub(a, e->kinetic, e->stored);
    const poly *force =
        poly_add(a, poly_derivative(a, lagrangian, q, 0), forces_on(a, e->force, e->forces, i));
    const poly *power = poly_add(
        a, poly_mul(a, force, poly_symbol(a, q, 1)),
        poly_mul(a, poly_derivative(a, lagrangian, q, 1), e->applied[i])); /* the rate's part */
    return poly_scale(a, power, -1.0);
}
