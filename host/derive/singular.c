/* singular.c: trying the mass matrix at generic states, and at the start. */
#include "singular.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define TRIES 24
/* The try after those: the state at which a run starts. What is defined in a narrow range only may
 * be without a value at all the others. */
#define TRY_START TRIES
/* A pivot below this part of its row's size counts as zero. */
#define NO_PIVOT 1e-11

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

/* Rank of the n by n matrix m (destroyed), by elimination with full pivoting. */
static int rank_of(double *m, int n) {
    int rank = 0;
    for (int step = 0; step < n; step++) {
        int row = step;
        int column = step;
        for (int i = step; i < n; i++) {
            for (int j = step; j < n; j++) {
                if (fabs(m[i * n + j]) > fabs(m[row * n + column])) {
                    row = i;
                    column = j;
                }
            }
        }
        if (fabs(m[row * n + column]) < NO_PIVOT) {
            break;
        }
        rank++;
        for (int j = 0; j < n; j++) {
            const double swap = m[step * n + j];
            m[step * n + j] = m[row * n + j];
            m[row * n + j] = swap;
        }
        for (int i = 0; i < n; i++) {
            const double swap = m[i * n + step];
            m[i * n + step] = m[i * n + column];
            m[i * n + column] = swap;
        }
        for (int i = step + 1; i < n; i++) {
            const double part = m[i * n + step] / m[step * n + step];
            for (int j = step; j < n; j++) {
                m[i * n + j] -= part * m[step * n + j];
            }
        }
    }
    return rank;
}

/* Is a regular symmetric n by n matrix positive definite (sqrt-free Cholesky, destroys m)? */
static bool is_positive(double *m, int n) {
    for (int k = 0; k < n; k++) {
        if (!(m[k * n + k] > 0.0)) {
            return false;
        }
        for (int i = k + 1; i < n; i++) {
            const double part = m[k * n + i] / m[k * n + k];
            for (int j = i; j < n; j++) {
                m[i * n + j] -= part * m[k * n + j];
            }
        }
    }
    return true;
}

/* Rows, then columns, to a largest entry of one: units must not decide. */
static void balance(double *m, int n) {
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < n; i++) {
            double largest = 0.0;
            for (int j = 0; j < n; j++) {
                largest = fmax(largest, fabs(pass == 0 ? m[i * n + j] : m[j * n + i]));
            }
            for (int j = 0; j < n && largest > 0.0; j++) {
                *(pass == 0 ? &m[i * n + j] : &m[j * n + i]) /= largest;
            }
        }
    }
}

/* The values of the mass matrix at one try; false when one is not finite. */
static bool mass_at(const equations *e, int try, double *m) {
    generic_state state = {e->instance, (uint64_t)try};
    bool finite = true;
    for (int i = 0; i < e->count * e->count; i++) {
        m[i] = poly_evaluate(e->mass[i], generic_value, &state);
        finite = finite && isfinite(m[i]);
    }
    return finite;
}

/* The first row whose highest derivatives follow from those of the rows above, at the first finite
 * try; -1 when there is none. */
static int dependent_row(const equations *e) {
    const int n = e->count;
    double *m = calloc(2 * (size_t)n * (size_t)n + 1, sizeof *m);
    if (m == NULL) {
        abort();
    }
    double *part = m + n * n;
    int found = -1;
    bool finite = false;
    for (int try = 0; try < TRIES && !finite; try++) {
        finite = mass_at(e, try, m);
    }
    balance(m, n);
    for (int rows = 1; rows <= n && finite && found < 0; rows++) {
        for (int i = 0; i < n * n; i++) {
            part[i] = i < rows * n ? m[i] : 0.0;
        }
        if (rank_of(part, n) < rows) {
            found = rows - 1;
        }
    }
    free(m);
    return found;
}

/* Where equation `row` of a system stands. */
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

/* An effect that takes no part here and whose T contains the rate of `s`; NULL: none. */
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

static void report_singular(const equations *e, diags *errors) {
    char hint[HINT_SIZE] = "give it a mass or an inertia, or remove the coordinate";
    const int n = e->count;
    if (e->instance->mechanism->is_system) {
        report_singular_system(e, errors);
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

/* What the best of the states tried allows. */
typedef enum verdict { NOWHERE_FINITE, SINGULAR, NOT_POSITIVE, SOLVABLE } verdict;

/* At one try; m holds 2 n^2 numbers. */
static verdict verdict_at(const equations *e, int try, double *m) {
    const int n = e->count;
    generic_state state = {e->instance, (uint64_t)try};
    bool finite = mass_at(e, try, m) && energies_finite(e, &state);
    for (int i = 0; i < n && finite; i++) {
        finite = isfinite(poly_evaluate(equations_force(e, i), generic_value, &state));
    }
    if (!finite) {
        return NOWHERE_FINITE;
    }
    double *kept = m + n * n;
    for (int i = 0; i < n * n; i++) {
        kept[i] = m[i];
    }
    balance(m, n);
    if (rank_of(m, n) < n) {
        return SINGULAR;
    }
    /* The elimination of a mechanism relies on it; a system's equations are in any order and sign. */
    return e->instance->mechanism->is_system || is_positive(kept, n) ? SOLVABLE : NOT_POSITIVE;
}

bool equations_check_solvable(const equations *e, diags *errors) {
    const int n = e->count;
    double *m = calloc(2 * (size_t)n * (size_t)n + 1, sizeof *m);
    if (m == NULL) {
        abort();
    }
    verdict best = NOWHERE_FINITE;
    for (int try = 0; try <= TRY_START && best != SOLVABLE; try++) {
        const verdict found = verdict_at(e, try, m);
        best = found > best ? found : best;
    }
    free(m);
    const mechanism *of = e->instance->mechanism;
    switch (best) {
    case NOWHERE_FINITE:
        diag_error(errors, of->at,
                   "look for a division by zero, or a root or logarithm of a negative number",
                   "the equations of '%s' have no finite value at any state tried", of->name);
        break;
    case SINGULAR: report_singular(e, errors); break;
    case NOT_POSITIVE:
        diag_error(errors, equations_kinetic_place(e->instance),
                   "a mass below zero? products of different rates alone, as x'*y'? equations "
                   "that are meant so can be given outright",
                   "the kinetic energy of '%s' is negative for some motion at every state tried",
                   of->name);
        break;
    case SOLVABLE: break;
    }
    return best == SOLVABLE;
}
