/* energy.c: telling a quadratic form of the rates from anything else, and the integral of the latter. */
#include "energy.h"

#include <math.h>

/* States that T is tried at; so many of them must give numbers. */
#define TRIES 12
#define TRIES_NEEDED 3
/* What rounding may leave of Euler's theorem, as part of its terms. T must be exactly zero at rest, so this
 * only has to find kinks, such as abs(x'), whose second derivative vanishes. */
#define EULER_ROUNDING 1e-9

typedef struct trial_state {
    const instance *instance;
    unsigned number;
    bool at_rest;
} trial_state;

/* Numbers between 0.2 and 1.8, rates with either sign: the fractional part of multiples of a root. */
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

/* At rest a quadratic form and its slopes are zero. *known: they are numbers there. */
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

/* Is T a homogeneous quadratic form of the rates, and V free of them? With masses free of rates T is a form
 * of second degree plus one of first and one of none, which show at rest. */
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
        poly_mul(a, poly_derivative(a, lagrangian, q, 1), e->applied[i])); /* that of the rate */
    return poly_scale(a, power, -1.0);
}
