/* singular.c: trying the mass matrix at generic states. */
#include "singular.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define TRIES 24
/* A pivot below this part of its row's size counts as zero. */
#define NO_PIVOT 1e-11

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

static void report_singular(const equations *e, diags *errors) {
    const int n = e->count;
    const bool system = e->instance->mechanism->is_system;
    for (int i = 0; i < n && !system; i++) {
        bool empty = true;
        for (int j = 0; j < n; j++) {
            empty = empty && poly_is_zero(e->mass[i * n + j]);
        }
        if (empty) {
            diag_error(errors, e->unknowns[i].symbol->at,
                       "give it a mass or an inertia, or remove the coordinate",
                       "singular mass matrix: the kinetic energy does not contain %s'",
                       e->unknowns[i].symbol->name);
            return;
        }
    }
    diag_error(errors, e->instance->mechanism->at,
               system ? "two equations may say the same, or one may lack its highest derivative"
                      : "two coordinates may describe the same motion, or a mass may be zero",
               system ? "the equations of '%s' cannot be solved for the highest derivatives: "
                        "singular at every state tried"
                      : "singular mass matrix: '%s' cannot be solved for its accelerations at any "
                        "state tried",
               e->instance->mechanism->name);
}

bool equations_check_solvable(const equations *e, diags *errors) {
    const int n = e->count;
    double *m = calloc((size_t)n * (size_t)n + 1, sizeof *m);
    if (m == NULL) {
        abort();
    }
    bool any_finite = false;
    bool solvable = false;
    for (int try = 0; try < TRIES && !solvable; try++) {
        generic_state state = {e->instance, (uint64_t)try};
        bool finite = true;
        for (int i = 0; i < n * n; i++) {
            m[i] = poly_evaluate(e->mass[i], generic_value, &state);
            finite = finite && isfinite(m[i]);
        }
        for (int i = 0; i < n && finite; i++) {
            finite = isfinite(poly_evaluate(equations_force(e, i), generic_value, &state));
        }
        if (finite) {
            any_finite = true;
            balance(m, n);
            solvable = rank_of(m, n) == n;
        }
    }
    free(m);
    if (solvable) {
        return true;
    }
    if (!any_finite) {
        diag_error(errors, e->instance->mechanism->at,
                   "look for a division by zero, or a root or logarithm of a negative number",
                   "the equations of '%s' have no finite value at any state tried",
                   e->instance->mechanism->name);
        return false;
    }
    report_singular(e, errors);
    return false;
}
