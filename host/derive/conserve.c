/* conserve.c: the choice of recoverable coordinates, and their recovery. */
#include "host/derive/conserve.h"

#include <stdint.h>
#include <stdio.h>

/* === forces on a coordinate, and forces that depend on it ===================================== */

/* Finds the first force, loss or contact that changes the momentum of unknown i. Returns its word, such as "the Q". */
static const char *influence_on(const equations *e, int i, place *at) {
    algebra *a = e->algebra;
    const mechanism *m = e->instance->mechanism;
    const symbol *q = e->unknowns[i].symbol;
    for (int k = 0; k < m->term_count; k++) {
        const term *each = &m->terms[k];
        const poly *value = poly_from_expr(a, each->value);
        const bool acts = each->kind == TERM_Q   ? each->coordinate == q && !poly_is_zero(value)
                          : each->kind == TERM_F ? !poly_is_zero(poly_derivative(a, value, q, 1))
                                                 : false;
        if (acts && instance_has(e->instance, each->effect)) {
            *at = each->at;
            return each->kind == TERM_Q ? "the Q" : "the F";
        }
    }
    for (int k = 0; e->contacts != NULL && k < e->contacts->count; k++) {
        const contact_law *law = &e->contacts->law[k];
        if (contact_law_pushes(law, i)) {
            *at = law->from->at;
            return contact_called(law->from->kind);
        }
    }
    return "nothing"; /* not reached */
}

/* Does a force, a loss or a contact depend on the coordinate's position? Energies are not checked. */
static bool influence_of(const equations *e, const symbol *q) {
    const mechanism *m = e->instance->mechanism;
    bool found = false;
    for (int k = 0; k < m->term_count && !found; k++) {
        const term *each = &m->terms[k];
        found = instance_has(e->instance, each->effect) &&
                (each->kind == TERM_Q || each->kind == TERM_F) &&
                poly_contains(poly_from_expr(e->algebra, each->value), q, 0);
    }
    for (int k = 0; e->contacts != NULL && k < e->contacts->count; k++) {
        const poly *each;
        for (int i = 0; (each = contact_law_poly(e, k, i)) != NULL; i++) {
            found = found || poly_contains(each, q, 0);
        }
    }
    return found;
}

/* === recovered coordinates ==================================================================== */

static double start_value(void *context, const symbol *s, int primes) {
    return instance_value(context, s, primes);
}

static double at_start(const equations *e, const poly *p) {
    return poly_evaluate(p, start_value, (void *)(uintptr_t)e->instance);
}

/* Returns the antiderivative of a term with respect to q, or NULL if Whirl cannot find an antiderivative. */
static const poly *integrate_term(algebra *a, const poly_term *t, const symbol *q) {
    const mono *m = t->mono;
    const poly *factors = poly_number(a, t->coefficient);
    double power = 0.0;
    for (int i = 0; i < m->count; i++) {
        const poly *f = poly_of_atom(a, m->factors[i].atom, m->factors[i].exponent);
        if (!poly_contains(f, q, 0)) {
            factors = poly_mul(a, factors, f);
        } else if (m->factors[i].atom->kind == ATOM_SYMBOL && m->factors[i].exponent != -1.0) {
            power = m->factors[i].exponent;
        } else {
            return NULL;
        }
    }
    const poly *slope = m->trig == TRIG_NONE ? NULL : poly_derivative(a, m->angle, q, 0);
    double k;
    if (slope == NULL || poly_is_zero(slope)) {
        const poly *x = poly_symbol(a, q, 0);
        const poly *raised = poly_scale(a, poly_pow(a, x, power + 1.0), 1.0 / (power + 1.0));
        const poly *wave = m->trig == TRIG_NONE  ? NULL
                           : m->trig == TRIG_SIN ? poly_sin(a, m->angle)
                                                 : poly_cos(a, m->angle);
        return poly_mul(a, wave != NULL ? poly_mul(a, factors, wave) : factors, raised);
    }
    if (power != 0.0 || !poly_is_number(slope, &k)) {
        return NULL;
    }
    const poly *turned = m->trig == TRIG_SIN ? poly_scale(a, poly_cos(a, m->angle), -1.0 / k)
                                             : poly_scale(a, poly_sin(a, m->angle), 1.0 / k);
    return poly_mul(a, factors, turned);
}

/* Returns the function G with dG/dq_j = mass[j] for every unknown j, or NULL if there is none. Powers of sums, which
 * integrate_term() rejects, are multiplied out first. */
static const poly *potential_of(const equations *e, const poly *const *mass) {
    algebra *a = e->algebra;
    const poly *g = poly_number(a, 0.0);
    for (int j = 0; j < e->count; j++) {
        const symbol *q = e->unknowns[j].symbol;
        const poly *rest = poly_expanded(a, poly_sub(a, mass[j], poly_derivative(a, g, q, 0)));
        for (int i = 0; i < rest->count; i++) {
            const poly *part = integrate_term(a, &rest->terms[i], q);
            if (part == NULL) {
                return NULL;
            }
            g = poly_add(a, g, part);
        }
    }
    for (int j = 0; j < e->count; j++) {
        const poly *slope = poly_derivative(a, g, e->unknowns[j].symbol, 0);
        if (!poly_is_zero(poly_expanded(a, poly_sub(a, slope, mass[j])))) {
            return NULL;
        }
    }
    return g;
}

static bool check_wanted(const equations *e, int i, diags *errors) {
    algebra *a = e->algebra;
    const symbol *q = e->unknowns[i].symbol;
    const scene *s = e->instance->scene;
    const place at = s != NULL ? s->at : q->at;
    if (e->kinetic == NULL) {
        diag_error(errors, at, NULL, "'conserve' needs energies: '%s' is a system of equations",
                   e->instance->mechanism->name);
        return false;
    }
    if (e->conserved[i]) {
        return true;
    }
    const poly *lagrangian = poly_sub(a, e->kinetic, e->stored);
    if (!poly_is_zero(poly_derivative(a, lagrangian, q, 0))) {
        diag_error(
            errors, at,
            "leave this statement out: only a coordinate that no energy contains has a conserved momentum",
            "the momentum of '%s' is not conserved: the energies depend on %s", q->name, q->name);
        return false;
    }
    char hint[160];
    place cause = at;
    const char *what = influence_on(e, i, &cause);
    snprintf(hint, sizeof hint, "leave this statement out, or integrate %s: --without conserve",
             q->name);
    diag_error(errors, at, hint,
               "the momentum of '%s' is not conserved: it is changed by %s in line %d", q->name,
               what, cause.line);
    return false;
}

typedef struct momentum_law {
    double momentum;    /* constant value of the momentum, SI */
    double start;       /* value of G(q) (conserve.h) at the start */
    const poly **mass;  /* [equations->count] momentum = sum_j mass[j] q_j' */
    const poly *others; /* sum of the terms of G(q) that contain no conserved coordinate */
} momentum_law;

/* Solves sum_l m_kl x_l = right_k for x by Cramer's rule, over the conserved coordinates l. */
static void solve_conserved(const equations *e, const conservation *c, const momentum_law *laws,
                            const poly *const *right, const poly **x) {
    algebra *a = e->algebra;
    const int k = c->count;
    const unsigned all = (1U << k) - 1U;
    const poly *m[CONSERVED_MAX * CONSERVED_MAX];
    for (int column = -1; column < k; column++) {
        for (int i = 0; i < k * k; i++) {
            m[i] = i % k == column ? right[i / k] : laws[i / k].mass[c->unknown[i % k]];
        }
        const poly *d = poly_determinant(a, m, k, all, all);
        if (column < 0) {
            for (int i = 0; i < k; i++) {
                x[i] = poly_pow(a, d, -1.0);
            }
        } else {
            x[column] = poly_mul(a, d, x[column]);
        }
    }
}

const symbol conservation_time = {.kind = SYM_INPUT, .name = "time", .text = "", .unit = "s"};

/* Sets c->rate[] and, if c->closed, c->value[]. */
static void recover(const equations *e, conservation *c, const momentum_law *laws) {
    algebra *a = e->algebra;
    const poly *rates[CONSERVED_MAX];
    const poly *values[CONSERVED_MAX];
    for (int k = 0; k < c->count; k++) {
        rates[k] = poly_number(a, laws[k].momentum);
        for (int j = 0; j < e->count; j++) {
            if (c->number[j] < 0) {
                const poly *rate = poly_symbol(a, e->unknowns[j].symbol, 1);
                rates[k] = poly_sub(a, rates[k], poly_mul(a, laws[k].mass[j], rate));
            }
        }
        if (c->closed) {
            const poly *moved =
                poly_scale(a, poly_symbol(a, &conservation_time, 0), laws[k].momentum);
            values[k] = poly_add(a, poly_number(a, laws[k].start), moved);
            values[k] = poly_sub(a, values[k], laws[k].others);
        }
    }
    solve_conserved(e, c, laws, rates, c->rate);
    if (c->closed) {
        solve_conserved(e, c, laws, values, c->value);
    }
}

static bool make_law(const equations *e, conservation *c, int k, momentum_law *law, diags *errors) {
    const int n = e->count;
    const int i = c->unknown[k];
    const poly *momentum = equations_fold(e, e->momentum[i]);
    law->mass = algebra_room(e->algebra, n, sizeof(const poly *));
    law->momentum = at_start(e, momentum);
    for (int j = 0; j < n; j++) {
        double value;
        law->mass[j] = equations_fold(e, e->mass[i * n + j]);
        c->closed = c->closed && (c->number[j] < 0 || poly_is_number(law->mass[j], &value));
    }
    /* integrate a coordinate on which a force depends */
    c->closed = c->closed && !influence_of(e, e->unknowns[i].symbol);
    if (energy_momentum_is_linear(e, i)) {
        return true;
    }
    diag_error(errors, e->unknowns[i].symbol->at, "integrate the coordinate: --without conserve",
               "the momentum of '%s' is not linear in the rates", e->unknowns[i].symbol->name);
    return false;
}

/* Finds G(q) for each law. If one law has no G, all conserved coordinates are integrated (`closed` becomes false). */
static void make_potentials(const equations *e, conservation *c, momentum_law *laws) {
    algebra *a = e->algebra;
    for (int k = 0; k < c->count && c->closed; k++) {
        const poly *g = potential_of(e, laws[k].mass);
        c->closed = g != NULL;
        if (g == NULL) {
            break;
        }
        laws[k].start = at_start(e, g);
        for (int m = 0; m < c->count; m++) {
            const poly *own = poly_symbol(a, e->unknowns[c->unknown[m]].symbol, 0);
            g = poly_sub(a, g, poly_mul(a, laws[k].mass[c->unknown[m]], own));
        }
        laws[k].others = g;
    }
}

conservation *conservation_make(const equations *e, const bool *wanted, diags *errors) {
    const int n = e->count;
    momentum_law laws[CONSERVED_MAX] = {0};
    conservation *c = algebra_room(e->algebra, 1, sizeof *c);
    c->unknown = algebra_room(e->algebra, n, sizeof *c->unknown);
    c->number = algebra_room(e->algebra, n, sizeof *c->number);
    c->closed = true;
    bool good = true;
    for (int i = 0; i < n; i++) {
        c->number[i] = -1;
        if (wanted == NULL || !wanted[i]) {
            continue;
        }
        good = check_wanted(e, i, errors) && good;
        c->number[i] = c->count;
        c->unknown[c->count++] = i;
    }
    if (c->count > CONSERVED_MAX || (c->count == n && n > 0)) {
        const scene *s = e->instance->scene;
        diag_error(errors, s != NULL ? s->at : e->instance->mechanism->at,
                   "leave one coordinate out of `conserve`, so that Whirl integrates it",
                   c->count == n ? "no coordinate is left to integrate"
                                 : "more than %d coordinates cannot be conserved at once",
                   CONSERVED_MAX);
        good = false;
    }
    for (int k = 0; k < c->count && good; k++) {
        good = make_law(e, c, k, &laws[k], errors);
    }
    if (good && c->count > 0) {
        make_potentials(e, c, laws);
        recover(e, c, laws);
    }
    return good ? c : NULL;
}

static const poly *settled_value(void *context, algebra *a, const symbol *s, int primes) {
    const conservation *c = context;
    (void)a;
    if (s->kind != SYM_COORDINATE || c->number[s->index] < 0 || primes > 1) {
        return NULL;
    }
    return primes == 1 ? c->rate[c->number[s->index]] : c->value[c->number[s->index]];
}

const poly *conservation_settle(const equations *e, const conservation *c, const poly *p) {
    void *context = (void *)(uintptr_t)c;
    return c->count == 0 ? p : poly_substitute(e->algebra, p, settled_value, context);
}
