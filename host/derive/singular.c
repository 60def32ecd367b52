/* singular.c: trying the mass matrix at generic states, and at the start. */
#include "singular.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "rank.h"

#define TRIES 24
/* The last try: the state at which a run starts. A mass matrix with a narrow domain may be
 * undefined at all the others. */
#define TRY_START TRIES
/* Rounding of an entry, as part of the sizes of its terms. */
#define ENTRY_ROUNDING 4e-16
/* A relative accuracy of the mass matrix that suffices: no better state is searched for. */
#define MASS_BLUR_FINE 1e-10

enum { HINT_SIZE = 320 };

typedef struct generic_state {
    const instance *instance;
    uint64_t seed;
} generic_state;

/* The same symbol always gets the same number within one try: a hash of its place. */
static double generic_value(void *context, const symbol *s, int primes) {
    const generic_state *state = context;
    if (s->kind == SYM_PARAMETER) {
        return state->instance->parameter[s->index];
    }
    if (s->kind == SYM_INPUT) {
        return state->instance->input[s->index];
    }
    if (state->seed == TRY_START) {
        const int i = s->index;
        return primes < state->instance->start_count[i] ? state->instance->start[i][primes] : 0.0;
    }
    uint64_t x = state->seed * UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)s->index * 8191U +
                 (uint64_t)primes * 131071U;
    x = (x ^ (x >> 31)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 29)) * UINT64_C(0x94d049bb133111eb);
    const double part = (double)(x >> 11) * 0x1p-53;
    return (state->seed % 2 == 0 ? 0.1 : -0.9) + 1.7 * part;
}

/* Four n by n matrices. */
static double *room_for(int n) { return alloc(4 * (int64_t)n * n, sizeof(double)); }

/* The values of the mass matrix at one try, and how well they are known; false when one is not finite. */
static bool mass_at(const equations *e, int try, double *m, double *error) {
    generic_state state = {e->instance, (uint64_t)try};
    bool finite = true;
    for (int i = 0; i < e->count * e->count; i++) {
        m[i] = poly_evaluate(e->mass[i], generic_value, &state);
        error[i] = ENTRY_ROUNDING * poly_magnitude(e->mass[i], generic_value, &state);
        finite = finite && isfinite(m[i]) && isfinite(error[i]);
    }
    return finite;
}

/* The first row with highest derivatives that depend on those of the rows above, at the first
 * finite try; -1: all are independent. */
static int dependent_row(const equations *e) {
    const int n = e->count;
    double *m = room_for(n);
    double *error = m + n * n;
    double *part = error + n * n;
    double *part_error = part + n * n;
    int found = -1;
    bool finite = false;
    for (int try = 0; try < TRIES && !finite; try++) {
        finite = mass_at(e, try, m, error);
    }
    for (int rows = 1; rows <= n && finite && found < 0; rows++) {
        for (int i = 0; i < n * n; i++) {
            part[i] = i < rows * n ? m[i] : 0.0;
            part_error[i] = i < rows * n ? error[i] : 0.0;
        }
        if (rank_of(part, part_error, n, false) < rows) {
            found = rows - 1;
        }
    }
    free(m);
    return found;
}

static place place_of_equation(const equations *e, int row) {
    const mechanism *m = e->instance->mechanism;
    for (int t = 0, at = 0; t < m->term_count; t++) {
        if (m->terms[t].kind == TERM_EQUATION && instance_has_term(e->instance, &m->terms[t]) &&
            at++ == row) {
            return m->terms[t].at;
        }
    }
    return m->at;
}

/* No highest derivative at all in the row: it binds the states, it does not move them. */
static bool row_is_empty(const equations *e, int row) {
    bool empty = true;
    for (int j = 0; j < e->count; j++) {
        empty = empty && poly_is_zero(e->mass[row * e->count + j]);
    }
    return empty;
}

static void report_singular_system(const equations *e, diags *errors) {
    const int row = dependent_row(e);
    if (row >= 0 && row_is_empty(e, row)) {
        diag_error(
            errors, place_of_equation(e, row),
            "a constraint between states: differentiate it until a highest derivative appears",
            "the equations of '%s' cannot be solved for the highest derivatives: "
            "this one contains none",
            e->instance->mechanism->name);
    } else {
        diag_error(errors, row < 0 ? e->instance->mechanism->at : place_of_equation(e, row),
                   "two equations may say the same, or one may lack its highest derivative",
                   "the equations of '%s' cannot be solved for the highest derivatives: "
                   "this one has the same combination of them as those above it",
                   e->instance->mechanism->name);
    }
}

/* An inactive effect with the rate of `s` in its T; NULL: there is no such effect. */
static const char *effect_with_inertia(const equations *e, const symbol *s) {
    const mechanism *m = e->instance->mechanism;
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        if (t->kind == TERM_T && !instance_has_term(e->instance, t) &&
            poly_contains(poly_from_expr(e->algebra, t->value), s, 1)) {
            return m->effects[t->effect].name;
        }
    }
    return NULL;
}

/* At how many of the states tried this part of the kinetic energy is negative. */
static int times_negative(const equations *e, const term *t) {
    const poly *value = poly_from_expr(e->algebra, t->value);
    int negative = 0;
    for (int try = 0; try < TRY_START; try++) {
        generic_state state = {e->instance, (uint64_t)try};
        negative += poly_evaluate(value, generic_value, &state) < 0.0 ? 1 : 0;
    }
    return negative;
}

/* The part of the kinetic energy that is negative most often, and the count in *most; NULL: it never is. */
static const term *negative_part(const equations *e, int *most) {
    const mechanism *of = e->instance->mechanism;
    const term *found = NULL;
    *most = 0;
    for (int i = 0; i < of->term_count; i++) {
        const term *t = &of->terms[i];
        const bool takes_part = t->kind == TERM_T && instance_has_term(e->instance, t);
        const int negative = takes_part ? times_negative(e, t) : 0;
        if (negative > *most) {
            found = t;
            *most = negative;
        }
    }
    return found;
}

static void report_singular(const equations *e, diags *errors) {
    char hint[HINT_SIZE] = "give it a mass or an inertia, or remove the coordinate";
    const int n = e->count;
    if (e->instance->mechanism->is_system) {
        report_singular_system(e, errors);
        return;
    }
    int negative;
    const term *taken = negative_part(e, &negative);
    if (negative == TRY_START) {
        diag_error(errors, taken->at, "take less away, or name an effect that gives more",
                   "singular mass matrix: this takes all inertia of '%s' away for some motion",
                   e->instance->mechanism->name);
        return;
    }
    for (int i = 0; i < n; i++) {
        bool empty = true;
        for (int j = 0; j < n; j++) {
            empty = empty && poly_is_zero(e->mass[i * n + j]);
        }
        if (empty) {
            const char *giver = effect_with_inertia(e, e->unknowns[i].symbol);
            if (giver != NULL) {
                snprintf(
                    hint, sizeof hint,
                    "the effect '%.60s' gives it one: name it in the scene: with %.60s, or add "
                    "--with %.60s",
                    giver, giver, giver);
            }
            diag_error(errors, e->unknowns[i].symbol->at, hint,
                       "singular mass matrix: the kinetic energy does not contain %s'",
                       e->unknowns[i].symbol->name);
            return;
        }
    }
    snprintf(hint, sizeof hint,
             "two coordinates may describe the same motion, or a mass may be zero");
    for (int i = 0; i < n; i++) {
        const char *giver = effect_with_inertia(e, e->unknowns[i].symbol);
        if (giver != NULL) {
            snprintf(
                hint, sizeof hint,
                "the effect '%.60s', which adds to the kinetic energy, takes no part here: name "
                "it in the scene: with %.60s, or add --with %.60s",
                giver, giver, giver);
            break;
        }
    }
    diag_error(
        errors, e->instance->mechanism->at, hint,
        "singular mass matrix: '%s' cannot be solved for its accelerations at any state tried",
        e->instance->mechanism->name);
}

/* An energy's constant part vanishes from the equations, but 1/0 in it is a mistake all the same. */
static bool energies_finite(const equations *e, generic_state *state) {
    return e->kinetic == NULL || (isfinite(poly_evaluate(e->kinetic, generic_value, state)) &&
                                  isfinite(poly_evaluate(e->stored, generic_value, state)));
}

/* The best result of the tried states. */
typedef enum verdict { NOWHERE_FINITE, SINGULAR, NOT_POSITIVE, SOLVABLE } run_checks;

/* The largest error of a regular matrix after rank_of(), relative to its least pivot. */
static double blur_of(const double *m, const double *error, int n) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int i = 0; i < n * n; i++) {
        least = m[i] != 0.0 ? number_least(least, fabs(m[i])) : least;
        most = number_most(most, error[i]);
    }
    return most / least;
}

/* At one try, and of one that is solvable *blur; m is of room_for(n). */
static run_checks verdict_at(const equations *e, int try, double *m, double *blur) {
    const int n = e->count;
    generic_state state = {e->instance, (uint64_t)try};
    double *error = m + n * n;
    bool finite = mass_at(e, try, m, error) && energies_finite(e, &state);
    for (int i = 0; i < n && finite; i++) {
        finite = isfinite(poly_evaluate(equations_force(e, i), generic_value, &state));
    }
    if (!finite) {
        return NOWHERE_FINITE;
    }
    double *kept = error + n * n;
    for (int i = 0; i < n * n; i++) {
        kept[i] = m[i];
    }
    const bool is_system = e->instance->mechanism->is_system;
    if (rank_of(m, error, n, !is_system) < n) {
        return SINGULAR;
    }
    *blur = blur_of(m, error, n);
    /* The elimination of a mechanism relies on it; a system's equations are in any order and sign. */
    return is_system || rank_is_positive(kept, n) ? SOLVABLE : NOT_POSITIVE;
}

bool equations_check_solvable(equations *e, diags *errors) {
    const int n = e->count;
    double *m = room_for(n);
    run_checks best = NOWHERE_FINITE;
    e->mass_blur = (double)INFINITY;
    for (int try = 0; try <= TRY_START && e->mass_blur > MASS_BLUR_FINE; try++) {
        double blur = (double)INFINITY;
        const run_checks found = verdict_at(e, try, m, &blur);
        best = found > best ? found : best;
        e->mass_blur = found == SOLVABLE ? number_least(e->mass_blur, blur) : e->mass_blur;
    }
    free(m);
    const mechanism *of = e->instance->mechanism;
    const term *taken;
    int negative;
    switch (best) {
    case NOWHERE_FINITE:
        diag_error(errors, of->at,
                   "look for a division by zero, or a root or logarithm of a negative number",
                   "the equations of '%s' have no finite value at any state tried", of->name);
        break;
    case SINGULAR: report_singular(e, errors); break;
    case NOT_POSITIVE:
        taken = negative_part(e, &negative);
        diag_error(errors, taken != NULL ? taken->at : equations_kinetic_place(e->instance),
                   "a mass below zero? products of different rates alone, as x'*y'? equations "
                   "that are meant so can be given outright",
                   "the kinetic energy of '%s' is negative for some motion at every state tried",
                   of->name);
        break;
    case SOLVABLE: break;
    }
    return best == SOLVABLE;
}
