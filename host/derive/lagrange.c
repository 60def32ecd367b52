/* lagrange.c: Lagrange's equations, systems given by their equations, and the test that they can be solved. */
#include "host/derive/lagrange.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/number/gauss.h"

#define PASSES 16      /* number of rounds in scale_general() */
#define NO_PIVOT 4e-14 /* a smaller pivot of a scaled matrix counts as zero: it is round-off */

/* A power of two within a factor of two of 1/sqrt(x); 1 if x is not positive and finite. */
static double scale_for(double x) {
    int exponent;
    if (!(x > 0.0) || !isfinite(x)) {
        return 1.0;
    }
    (void)number_split(x, &exponent);
    return number_scaled(1.0, -(exponent / 2));
}

/* A row or a column: n entries from `first` on, `stride` apart. */
typedef struct line {
    int first;
    int stride;
} line;

static line row_of(int n, int i) { return (line){i * n, 1}; }
static line column_of(int n, int i) { return (line){i, n}; }

static void scale_line(double *m, double *error, int n, line of, double by) {
    for (int k = 0; k < n; k++) {
        m[of.first + k * of.stride] *= by;
        error[of.first + k * of.stride] *= by;
    }
}

static bool has_positive_diagonal(const double *m, int n) {
    for (int i = 0; i < n; i++) {
        if (!(m[i * n + i] > 0.0)) {
            return false;
        }
    }
    return true;
}

/* Divides each row, then each column, by about the square root of its largest entry. Repeats this PASSES times. */
static void scale_general(double *m, double *error, int n) {
    for (int pass = 0; pass < 2 * PASSES; pass++) {
        for (int i = 0; i < n; i++) {
            const line of = pass % 2 == 0 ? row_of(n, i) : column_of(n, i);
            double largest = 0.0;
            for (int k = 0; k < n; k++) {
                largest = number_most(largest, fabs(m[of.first + k * of.stride]));
            }
            scale_line(m, error, n, of, scale_for(largest));
        }
    }
}

static void scale_symmetric(double *m, double *error, int n) {
    for (int i = 0; i < n; i++) {
        const double by = scale_for(m[i * n + i]);
        scale_line(m, error, n, row_of(n, i), by);
        scale_line(m, error, n, column_of(n, i), by);
    }
}

int rank_of(double *m, double *error, int n, bool symmetric) {
    if (symmetric && has_positive_diagonal(m, n)) {
        scale_symmetric(m, error, n);
    } else {
        scale_general(m, error, n);
    }
    double blur = NO_PIVOT;
    for (int i = 0; i < n * n; i++) {
        blur = number_most(blur, (double)n * error[i]);
    }
    int *lead = alloc(n, sizeof *lead);
    const int rank = gauss_reduce(m, n, n, n, true, blur, lead);
    free(lead);
    return rank;
}

bool rank_is_positive(double *m, int n) {
    gauss_pivots(m, n);
    return has_positive_diagonal(m, n);
}

/* === can the equations be solved for the highest derivatives? ================================= */

#define TRIES 24 /* generic states at which the mass matrix is tested */
/* The last tried state is the start of the run, because some mass matrices are defined only there. */
#define TRY_START TRIES
#define ENTRY_ROUNDING 4e-16 /* round-off of an entry, relative to the sum of its terms' sizes */
#define MASS_BLUR_FINE \
    1e-10 /* equations_check_solvable() tries no more states when mass_blur is at most this */

enum { HINT_SIZE = 320 };

typedef struct generic_state {
    const instance *instance;
    uint64_t seed;
} generic_state;

/* At TRY_START, symbols have their start values. At other states, only parameters and inputs have them. */
static double generic_value(void *context, const symbol *s, int primes) {
    generic_state *state = context;
    if (s->kind == SYM_PARAMETER || s->kind == SYM_INPUT || state->seed == TRY_START) {
        return instance_value(state->instance, s, primes);
    }
    return equations_generic(&state->seed, s, primes);
}

static double *room_for(int n) { return alloc(4 * (int64_t)n * n, sizeof(double)); }

/* Computes the mass matrix at a tried state, and the error bounds of its entries. Returns false if it is not finite. */
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

/* Takes the first tried state with a finite mass matrix. Returns the first row that depends on rows above it, or -1. */
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

/* Returns the place of active statement number `which` (from 0) of this kind, or the mechanism's place. */
static place place_of(const instance *inst, term_kind kind, int which) {
    const mechanism *m = inst->mechanism;
    for (int i = 0; i < m->term_count; i++) {
        if (m->terms[i].kind == kind && instance_has(inst, m->terms[i].effect) && which-- == 0) {
            return m->terms[i].at;
        }
    }
    return m->at;
}

/* Has the row no highest derivative? Then its equation constrains the states, but does not move them. */
static bool row_is_empty(const equations *e, int row) {
    bool empty = true;
    for (int j = 0; j < e->count; j++) {
        empty = empty && poly_is_zero(e->mass[row * e->count + j]);
    }
    return empty;
}

static void report_singular_system(const equations *e, diags *errors) {
    const int row = dependent_row(e);
    const bool empty = row >= 0 && row_is_empty(e, row);
    diag_error(
        errors, place_of(e->instance, TERM_EQUATION, row),
        empty ? "a constraint between states: differentiate it until a highest derivative appears"
              : "look for two equivalent equations, or for one without its highest derivative",
        "the equations of '%s' cannot be solved for the highest derivatives: this equation %s",
        e->instance->mechanism->name,
        empty ? "contains none"
              : "has the same highest derivatives as a sum of multiples of the equations above it");
}

/* Returns an inactive effect whose T contains the rate of `s`, or NULL. */
static const char *effect_with_inertia(const equations *e, const symbol *s) {
    const mechanism *m = e->instance->mechanism;
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        if (t->kind == TERM_T && !instance_has(e->instance, t->effect) &&
            poly_contains(poly_from_expr(e->algebra, t->value), s, 1)) {
            return m->effects[t->effect].name;
        }
    }
    return NULL;
}

/* Returns the term of T that is negative at the largest number of tried states, or NULL. *most is this number. */
static const term *negative_part(const equations *e, int *most) {
    const mechanism *of = e->instance->mechanism;
    const term *found = NULL;
    *most = 0;
    for (int i = 0; i < of->term_count; i++) {
        const term *t = &of->terms[i];
        if (t->kind != TERM_T || !instance_has(e->instance, t->effect)) {
            continue;
        }
        const poly *value = poly_from_expr(e->algebra, t->value);
        int negative = 0;
        for (int try = 0; try < TRY_START; try++) {
            generic_state state = {e->instance, (uint64_t)try};
            negative += poly_evaluate(value, generic_value, &state) < 0.0;
        }
        if (negative > *most) {
            found = t;
            *most = negative;
        }
    }
    return found;
}

static void report_singular(const equations *e, diags *errors) {
    char hint[HINT_SIZE];
    const int n = e->count;
    if (e->instance->mechanism->is_system) {
        report_singular_system(e, errors);
        return;
    }
    int negative;
    const term *taken = negative_part(e, &negative);
    if (negative == TRY_START) {
        diag_error(errors, taken->at, "subtract less inertia, or select an effect that adds some",
                   "singular mass matrix: this removes all inertia of '%s' for some motion",
                   e->instance->mechanism->name);
        return;
    }
    int empty = 0;
    while (empty < n && !row_is_empty(e, empty)) {
        empty++;
    }
    const symbol *without = empty < n ? e->unknowns[empty].symbol : NULL;
    const char *giver = NULL;
    for (int i = 0; i < n && giver == NULL; i++) {
        giver =
            without == NULL || i == empty ? effect_with_inertia(e, e->unknowns[i].symbol) : NULL;
    }
    if (giver != NULL) {
        snprintf(hint, sizeof hint,
                 "the effect '%.60s' adds an inertia: write `with %.60s` in the scene, or add "
                 "--with %.60s",
                 giver, giver, giver);
    }
    if (without != NULL) {
        diag_error(errors, without->at,
                   giver != NULL ? hint : "give it a mass or an inertia, or remove the coordinate",
                   "singular mass matrix: the kinetic energy does not contain %s'", without->name);
        return;
    }
    diag_error(
        errors, e->instance->mechanism->at,
        giver != NULL
            ? hint
            : "look for two coordinates that describe the same motion, or for a mass of zero",
        "singular mass matrix: '%s' cannot be solved for its accelerations at any state tried",
        e->instance->mechanism->name);
}

/* Are T and V finite? A constant 1/0 in them is a mistake of the user, although no equation contains it. */
static bool energies_finite(const equations *e, generic_state *state) {
    return e->kinetic == NULL || (isfinite(poly_evaluate(e->kinetic, generic_value, state)) &&
                                  isfinite(poly_evaluate(e->stored, generic_value, state)));
}

/* The result of one tried state, from worst to best. */
typedef enum solvability { NOWHERE_FINITE, SINGULAR, NOT_POSITIVE, SOLVABLE } solvability;

/* m and error come from rank_of(): the nonzero entries of m are its pivots. */
static double blur_of(const double *m, const double *error, int n) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int i = 0; i < n * n; i++) {
        least = m[i] != 0.0 ? number_least(least, fabs(m[i])) : least;
        most = number_most(most, error[i]);
    }
    return most / least;
}

/* *blur is set if the result is SOLVABLE. `m` comes from room_for(n). */
static solvability solvability_at(const equations *e, int try, double *m, double *blur) {
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
    /* only a mechanism's matrix must be positive definite */
    return is_system || rank_is_positive(kept, n) ? SOLVABLE : NOT_POSITIVE;
}

/* Sets e->mass_blur. Returns false (reported) if no tried state is SOLVABLE. A matrix that is singular only at some
 * states, such as a pole of spherical coordinates, passes. */
static bool equations_check_solvable(equations *e, diags *errors) {
    const int n = e->count;
    double *m = room_for(n);
    solvability best = NOWHERE_FINITE;
    e->mass_blur = (double)INFINITY;
    for (int try = 0; try <= TRY_START && e->mass_blur > MASS_BLUR_FINE; try++) {
        double blur = (double)INFINITY;
        const solvability found = solvability_at(e, try, m, &blur);
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
        diag_error(
            errors, taken != NULL ? taken->at : place_of(e->instance, TERM_T, 0),
            "look for a negative mass or a product of two rates, such as x'*y'; or write the equations themselves, with 'state' and 'equation' statements",
            "the kinetic energy of '%s' is negative for some rates in every state that Whirl tried",
            of->name);
        break;
    case SOLVABLE: break;
    }
    return best == SOLVABLE;
}

/* === the equations of motion ================================================================== */

static const poly *sum_of_terms(algebra *a, const instance *inst, term_kind kind) {
    const mechanism *m = inst->mechanism;
    const poly *sum = poly_number(a, 0.0);
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        if (t->kind == kind && instance_has(inst, t->effect)) {
            sum = poly_add(a, sum, poly_from_expr(a, t->value));
        }
    }
    return sum;
}

/* Returns false (reported) if `momentum` contains an input without a rate. */
static bool momentum_free_of_inputs(const equations *e, const poly *momentum, diags *errors) {
    const mechanism *m = e->instance->mechanism;
    char hint[RATE_HINT_SIZE];
    for (int i = 0; i < m->input_count; i++) {
        if (poly_contains(momentum, m->inputs[i], 0)) {
            diag_error(errors, place_of(e->instance, TERM_T, 0),
                       input_rate_hint(m->inputs[i], hint),
                       "the kinetic energy depends on input '%s', which has no declared rate",
                       m->inputs[i]->name);
            return false;
        }
    }
    return true;
}

static const poly *acceleration_of(algebra *a, const symbol *driven) {
    const symbol *input = symbol_acceleration(driven);
    return input != NULL ? poly_symbol(a, input, 0) : poly_number(a, 0.0);
}

/* A driven coordinate's equation is q'' = its input's acceleration. It has no momentum, and no force moves it. */
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
            if (other->driven != NULL) { /* the acceleration of `other` is known */
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
    const poly **left = algebra_room(a, n, sizeof *left);
    const term **term_at = algebra_room(a, n, sizeof *term_at);
    bool good = true;
    int rows = 0;
    for (int t = 0; t < m->term_count && rows < n; t++) {
        if (m->terms[t].kind == TERM_EQUATION && instance_has(e->instance, m->terms[t].effect)) {
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
            diag_error(errors, e->unknowns[s].symbol->at,
                       "write an equation that contains the rate of this state",
                       "no equation contains a derivative of state '%s'",
                       e->unknowns[s].symbol->name);
            good = false;
        }
    }
    for (int r = 0; r < rows && good && !algebra_overflow(a); r++) {
        for (int s = 0; s < n && good; s++) {
            const unknown *u = &e->unknowns[s];
            const poly *coefficient = poly_derivative(a, left[r], u->symbol, u->order);
            e->mass[r * n + s] = coefficient;
            for (int k = 0; k < n && good; k++) {
                good = !poly_contains(coefficient, e->unknowns[k].symbol, e->unknowns[k].order);
            }
            if (!good) {
                diag_error(
                    errors, term_at[r]->at,
                    "solve the equation for it by hand, or declare a state for the nonlinear part",
                    "this equation is not linear in the highest derivatives: %s", u->symbol->name);
            }
        }
        e->potential[r] = poly_substitute(a, left[r], drop_highest, e);
        e->velocity[r] = e->applied[r] = poly_number(a, 0.0);
    }
    return good;
}

static const poly **polys(algebra *a, int count) {
    return algebra_room(a, count, sizeof(const poly *));
}

static bool too_large(const equations *e) {
    if (algebra_overflow(e->algebra)) {
        return true; /* the expressions are incomplete */
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
    const mechanism *m = inst->mechanism;
    const int n = m->coordinate_count;
    algebra *a = algebra_new();
    equations *e = algebra_room(a, 1, sizeof *e);
    e->folding = inst->folding;
    (void)algebra_fold(a, &e->folding);
    e->algebra = a;
    e->instance = inst;
    e->count = n;
    e->unknowns = algebra_room(a, n, sizeof *e->unknowns);
    e->conserved = algebra_room(a, n, sizeof *e->conserved);
    e->mass = polys(a, n * n);
    e->velocity = polys(a, n);
    e->potential = polys(a, n);
    e->applied = polys(a, n);
    e->momentum = polys(a, n);
    e->output = polys(a, m->output_count);
    for (int i = 0; i < n; i++) {
        e->unknowns[i] = (unknown){m->coordinates[i], 2};
    }
    e->contacts = contact_laws_make(a, inst);
    bool good = m->is_system ? derive_system(e, errors) : derive_lagrange(e, errors);
    for (int i = 0; i < m->output_count && good; i++) {
        e->output[i] = poly_from_expr(a, m->outputs[i]->value);
    }
    if (good && too_large(e)) {
        equations_report_growth(e, errors);
        good = false;
    }
    good = good && equations_check_solvable(e, errors);
    (void)algebra_fold(a, NULL);
    if (!good) {
        equations_free(e);
        return NULL;
    }
    return e;
}
