/* equations.c: the symbolic equations of an instance, with its contacts, forces and energy. */
#include "host/derive/equations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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
    law->row = algebra_room(a, m->coordinate_count, sizeof(const poly *));
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
                     contact_law *law) {
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
        law->set = algebra_room(a, from->set_count, sizeof(const poly *));
        for (int i = 0; i < from->set_count; i++) {
            law->set[i] = poly_from_expr(a, from->sets[i].value);
        }
        break;
    }
}

bool contact_loosens(const contact_statement *h) {
    return h->kind == CONTACT_WHEN && h->normal != NULL;
}

/* Does the value change within a step? Inputs change only between steps. */
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

/* Adds a crossing for each friction whose normal force varies (contact_loosens()). */
static void make_loosening(algebra *a, const mechanism *m, contact_laws *laws) {
    const int written = laws->count;
    contact_statement *loose = algebra_room(a, written, sizeof *loose);
    for (int k = 0; k < written && laws->count < CONTACTS_MAX; k++) {
        const contact_statement *of = laws->law[k].from;
        if (of->kind == CONTACT_FRICTION && moves(a, m, poly_from_expr(a, of->normal))) {
            loose[k] = (contact_statement){.kind = CONTACT_WHEN,
                                           .value = of->normal,
                                           .normal = of->normal,
                                           .effect = of->effect,
                                           .at = of->at};
            make_law(a, m, &loose[k], &laws->law[laws->count++]);
        }
    }
}

contact_laws *contact_laws_make(algebra *a, const instance *inst) {
    const mechanism *m = inst->mechanism;
    const int own = inst->scene != NULL ? inst->scene->when_count : 0;
    const int most = 2 * m->contact_count + own; /* each friction may get a crossing */
    contact_laws *laws = algebra_room(a, 1, sizeof *laws);
    laws->law = algebra_room(a, most, sizeof *laws->law);
    for (int k = 0; k < CONTACT_KINDS; k++) {
        for (int i = 0; i < m->contact_count + own; i++) {
            const contact_statement *h =
                i < m->contact_count ? &m->contacts[i] : &inst->scene->whens[i - m->contact_count];
            if (h->kind != (contact_kind)k ||
                (i < m->contact_count && !instance_has(inst, h->effect))) {
                continue;
            }
            make_law(a, m, h, &laws->law[laws->count++]);
            laws->forced += h->kind != CONTACT_WHEN;
            laws->set_count += h->kind == CONTACT_WHEN ? h->set_count : 0;
        }
    }
    make_loosening(a, m, laws);
    return laws->count > 0 ? laws : NULL;
}

const poly *contact_law_poly(const equations *e, int k, int i) {
    const contact_law *law = &e->contacts->law[k];
    const poly *const fixed[LAW_POLYS] = {law->value, law->speed, law->first, law->second,
                                          law->bias};
    const int more = i - LAW_POLYS;
    if (more < 0) {
        return fixed[i];
    }
    if (law->row != NULL) {
        return more < e->count ? law->row[more] : NULL;
    }
    return more < law->from->set_count ? law->set[more] : NULL;
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

/* === the equations ============================================================================ */

static statement_force force_of(algebra *a, const mechanism *m, const term *t) {
    statement_force made = {t, algebra_room(a, m->coordinate_count, sizeof(const poly *)),
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
    statement_force *forces = algebra_room(a, m->term_count, sizeof *forces);
    *count = 0;
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        if ((t->kind == TERM_Q || t->kind == TERM_F) && instance_has(inst, t->effect)) {
            forces[(*count)++] = force_of(a, m, t);
        }
    }
    return forces;
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

/* === access to finished equations ============================================================= */

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

double equations_generic(void *seed, const symbol *s, int primes) {
    const uint64_t state = *(const uint64_t *)seed;
    const uint64_t number = (uint64_t)(s->index + (s->kind == SYM_INPUT ? 1000 : 0));
    uint64_t x = state * UINT64_C(0x9e3779b97f4a7c15) + number * 8191U + (uint64_t)primes * 131071U;
    x = (x ^ (x >> 31)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 29)) * UINT64_C(0x94d049bb133111eb);
    return (state % 2 == 0 ? 0.1 : -0.9) + 1.7 * (double)(x >> 11) * 0x1p-53;
}

void equations_report_growth(const equations *e, diags *errors) {
    const mechanism *m = e->instance->mechanism;
    char *limit = algebra_limit(e->algebra);
    char hint[200] = "use smaller powers of sums, or coordinates relative to the joints";
    if (m->parameter_count > 0) {
        snprintf(
            hint, sizeof hint,
            "write 'let' instead of 'parameter', so that %d parameters become numbers; otherwise use smaller powers of sums, or coordinates relative to the joints",
            m->parameter_count);
    }
    diag_error(errors, m->at, hint, "the equations of '%s' grow too large: %s", m->name, limit);
    free(limit);
}

void equations_free(equations *e) { algebra_free(e != NULL ? e->algebra : NULL); }

/* === the energy in the balance ================================================================ */

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

bool energy_momentum_is_linear(const equations *e, int i) {
    algebra *a = e->algebra;
    const poly *rest = e->momentum[i];
    for (int j = 0; j < e->count; j++) {
        const poly *rate = poly_symbol(a, e->unknowns[j].symbol, 1);
        rest = poly_sub(a, rest, poly_mul(a, e->mass[i * e->count + j], rate));
    }
    return poly_is_zero(rest);
}

static const poly *no_rate(void *context, algebra *a, const symbol *s, int primes) {
    (void)context;
    return s->kind == SYM_COORDINATE && primes == 1 ? poly_number(a, 0.0) : NULL;
}

/* Is T a homogeneous quadratic form of the rates, and does V contain no rate? */
static bool is_quadratic(const equations *e) {
    bool quadratic = !has_rates(e, e->stored) && !energy_mass_has_rates(e);
    for (int i = 0; i < e->count && quadratic; i++) {
        quadratic = energy_momentum_is_linear(e, i);
    }
    return quadratic && poly_is_zero(poly_substitute(e->algebra, e->kinetic, no_rate, NULL));
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
    const poly *power = poly_add(a, poly_mul(a, force, poly_symbol(a, q, 1)),
                                 /* applied[i] is the driven coordinate's acceleration */
                                 poly_mul(a, poly_derivative(a, lagrangian, q, 1), e->applied[i]));
    return poly_scale(a, power, -1.0);
}
