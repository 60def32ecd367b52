/* solve.c: the solution for the highest derivatives in the arrangement with the least op_list_weight(). Arrangements
 * differ in scale, in the order of elimination, in the angle that is evaluated first, and in the unknowns that are
 * eliminated symbolically. These unknowns have a constant diagonal entry, such as a carriage's total mass. Cramer's
 * rule solves the last two or three equations with one division. */
#include "host/image/solve.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/derive/equations.h"
#include "host/image/op_list.h"
#include "host/number/folding.h"

/* === solving n linear equations by entering operations into a list ============================ */

static int minus_product(op_list *t, int from, int x, int y) {
    return op_list_sub(t, from, op_list_mul(t, x, y));
}

/* Below, mass[n * n], force[n] and solution[n] hold indices of operations. Elimination overwrites mass and force. */

/* Enters the determinant of the equations rows[] in the unknowns columns[], by cofactors (size <= 3). */
static int determinant(op_list *t, int n, const int *mass, const int *rows, const int *columns,
                       int size) {
    if (size == 1) {
        return mass[rows[0] * n + columns[0]];
    }
    int sum = op_list_constant(t, 0.0);
    for (int c = 0; c < size; c++) {
        int rest[3];
        int kept = 0;
        for (int k = 0; k < size; k++) {
            if (k != c) {
                rest[kept++] = columns[k];
            }
        }
        const int minor = determinant(t, n, mass, rows + 1, rest, size - 1);
        const int product = op_list_mul(t, mass[rows[0] * n + columns[c]], minor);
        sum = c % 2 == 0 ? op_list_add(t, sum, product) : op_list_sub(t, sum, product);
    }
    return sum;
}

/* Solves the equations rows[size] for the unknowns columns[size] by Cramer's rule, with one division. */
static void solve_cramer(op_list *t, int n, const int *mass, const int *force, const int *rows,
                         const int *columns, int size, int *solution) {
    const int all = determinant(t, n, mass, rows, columns, size);
    const int inverse = op_list_div(t, op_list_constant(t, 1.0), all);
    int *swapped = alloc((int64_t)n * n, sizeof *swapped);
    for (int c = 0; c < size; c++) {
        for (int i = 0; i < n * n; i++) {
            swapped[i] = mass[i];
        }
        for (int r = 0; r < size; r++) {
            swapped[rows[r] * n + columns[c]] = force[rows[r]];
        }
        solution[columns[c]] = determinant(t, n, swapped, rows, columns, size);
    }
    for (int c = 0; c < size; c++) {
        int *x = &solution[columns[c]];
        *x = size == 1 ? op_list_div(t, *x, all) : op_list_mul(t, *x, inverse);
    }
    free(swapped);
}

/* Solves the triangular equations rows[0] ... rows[last], from the last on: x_k = (f_k - sum over later unknowns of
 * m_kj x_j) / m_kk. */
static void substitute_back(op_list *t, int n, const int *mass, const int *force, const int *rows,
                            const int *columns, int last, int *solution) {
    for (int at = last; at >= 0; at--) {
        const int *row = &mass[rows[at] * n];
        int rest = force[rows[at]];
        for (int i = at + 1; i < n; i++) {
            rest = minus_product(t, rest, row[columns[i]], solution[columns[i]]);
        }
        solution[columns[at]] = op_list_div(t, rest, row[columns[at]]);
    }
}

/* Eliminates in the order order[n]. The first `done` unknowns, eliminated symbolically, need only back substitution. */
static void eliminate_symmetric(op_list *t, int n, int *mass, int *force, const int *order,
                                int done, int *solution) {
    int left = n - 1; /* index in order[] of the last unknown without a solution */
    double value;
    for (int at = done; at < n - 1; at++) {
        const int k = order[at];
        const bool fixed = op_list_is_constant(t, mass[k * n + k], &value);
        if (at == n - 2 && !fixed) {
            solve_cramer(t, n, mass, force, order + at, order + at, 2, solution);
            left = n - 3;
            break;
        }
        const int inverse = op_list_div(t, op_list_constant(t, 1.0), mass[k * n + k]);
        for (int x = at + 1; x < n; x++) {
            const int i = order[x];
            const int part = op_list_mul(t, inverse, mass[k * n + i]);
            for (int y = x; y < n; y++) {
                const int j = order[y];
                mass[i * n + j] = minus_product(t, mass[i * n + j], part, mass[k * n + j]);
                mass[j * n + i] = mass[i * n + j];
            }
            force[i] = minus_product(t, force[i], part, force[k]);
        }
    }
    substitute_back(t, n, mass, force, order, order, left, solution);
}

static void exchange(int *a, int *b) {
    const int kept = *a;
    *a = *b;
    *b = kept;
}

/* Moves a pivot from the rows and columns >= `at` to position `at`: the largest constant or, if there is none, the
 * entry that is largest at a generic state. Returns true if the pivot is a constant. */
static bool bring_pivot(const op_list *t, int n, const int *mass, const double *value, int *rows,
                        int *columns, int at) {
    double best = -1.0;
    bool best_constant = false;
    int row = at;
    int column = at;
    for (int i = at; i < n; i++) {
        for (int j = at; j < n; j++) {
            const int entry = mass[rows[i] * n + columns[j]];
            const bool constant = t->ops[entry].code == OP_CONSTANT && t->ops[entry].value != 0.0;
            const double v = value[rows[i] * n + columns[j]];
            const double size = isfinite(v) ? fabs(v) : 0.0;
            if ((constant && !best_constant) || (constant == best_constant && size > best)) {
                best = size;
                best_constant = constant;
                row = i;
                column = j;
            }
        }
    }
    exchange(&rows[at], &rows[row]);
    exchange(&columns[at], &columns[column]);
    return best_constant;
}

static void eliminate_general(op_list *t, int n, const poly *const *of, int *mass, int *force,
                              int *solution) {
    int rows[COORDINATES_MAX];
    int columns[COORDINATES_MAX];
    double *value = alloc((int64_t)n * n, sizeof *value);
    uint64_t seed = 0;
    for (int i = 0; i < n * n; i++) {
        value[i] = poly_evaluate(of[i], equations_generic, &seed);
    }
    for (int i = 0; i < n; i++) {
        rows[i] = columns[i] = i;
    }
    int at = 0;
    while (at < n) {
        const bool constant = bring_pivot(t, n, mass, value, rows, columns, at);
        if (!constant && n - at <= 3) {
            solve_cramer(t, n, mass, force, rows + at, columns + at, n - at, solution);
            break;
        }
        const int pivot = rows[at] * n + columns[at];
        for (int i = at + 1; i < n; i++) {
            const int r = rows[i];
            const int first = r * n + columns[at];
            const int part = op_list_div(t, mass[first], mass[pivot]);
            for (int j = at + 1; j < n; j++) {
                const int above = rows[at] * n + columns[j];
                const int here = r * n + columns[j];
                mass[here] = minus_product(t, mass[here], part, mass[above]);
                value[here] -= value[first] / value[pivot] * value[above];
            }
            force[r] = minus_product(t, force[r], part, force[rows[at]]);
        }
        at++;
    }
    substitute_back(t, n, mass, force, rows, columns, at - 1, solution);
    free(value);
}

/* === a coordinate that hangs on a hinge ======================================================= */
/* A body on a hinge with the angle q has the equation A q'' + sum_j P_j x_j = f. The x_j are the other unknowns.
 * P_j = Re(z_j exp(i c q)) is a sinusoid of q, with the quadrature P~_j = Im(z_j exp(i c q)). A and c are constants.
 * Elimination of q'' adds -P_i P_j / A to entry (i, j) of mass[]. Only the term P~_i P~_j contains q:
 *
 *     P_i P_j = Re(z_i conj(z_j)) - P~_i P~_j */

static const poly *bend(algebra *a, const poly *p, const symbol *q) {
    return poly_derivative(a, poly_derivative(a, p, q, 0), q, 0);
}

/* Returns true if q is only in angles of sines and cosines, and linear there. */
static bool is_wave(algebra *a, const poly *p, const symbol *q) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double slope;
        if (m->angle != NULL && !poly_is_number(poly_derivative(a, m->angle, q, 0), &slope)) {
            return false;
        }
        for (int j = 0; j < m->count; j++) {
            if (poly_contains(poly_of_atom(a, m->factors[j].atom, 1.0), q, 0)) {
                return false;
            }
        }
    }
    return true;
}

static double frequency_squared(algebra *a, const poly *p, const symbol *q) {
    const poly *bent = is_wave(a, p, q) ? bend(a, p, q) : p;
    if (bent == p || bent->count != p->count) {
        return 0.0;
    }
    const double squared = -bent->terms[0].coefficient / p->terms[0].coefficient;
    const poly *rest = poly_add(a, bent, poly_scale(a, p, squared));
    return squared > 0.0 && poly_is_zero(rest) ? squared : 0.0;
}

typedef struct wave_of {
    const poly *here;   /* P_j above, or the first term of f */
    const poly *across; /* its quadrature, as P~_j above */
} wave_of;

static wave_of wave_make(algebra *a, const poly *p, const symbol *q, double c) {
    return (wave_of){p, poly_scale(a, poly_derivative(a, p, q, 0), -1.0 / c)};
}

/* Returns Re(z_x conj(z_y)), which does not contain q. */
static const poly *without_turn(algebra *a, wave_of x, wave_of y) {
    return poly_add(a, poly_mul(a, x.here, y.here), poly_mul(a, x.across, y.across));
}

static double shared_frequency(algebra *a, int n, const poly *const *mass, const bool *gone, int k,
                               const symbol *q) {
    double squared = 0.0;
    for (int j = 0; j < n; j++) {
        const poly *entry = mass[k * n + j];
        if (j == k || gone[j] || poly_is_zero(entry)) {
            continue;
        }
        const double own = frequency_squared(a, entry, q);
        if (own == 0.0 || (squared != 0.0 && fabs(own - squared) > 1e-12 * squared)) {
            return 0.0;
        }
        squared = own;
    }
    return number_root(squared);
}

/* Removes the centrifugal pull g across_i q'^2 from each force[i]. Returns g, or 0 if no common g exists. */
static double take_pull(algebra *a, int n, const poly **force, const poly *const *across,
                        const poly *rate_squared) {
    double g = 0.0;
    for (int i = 0; i < n; i++) {
        if (poly_is_zero(across[i])) {
            continue;
        }
        const poly *one = poly_mul(a, across[i], rate_squared);
        double own = 0.0;
        for (int t = 0; t < force[i]->count && one->count > 0; t++) {
            if (force[i]->terms[t].mono == one->terms[0].mono) {
                own = force[i]->terms[t].coefficient / one->terms[0].coefficient;
            }
        }
        const poly *rest = poly_sub(a, force[i], poly_scale(a, one, own));
        if (own == 0.0 || rest->count > force[i]->count - one->count ||
            (g != 0.0 && fabs(own - g) > 1e-12 * fabs(g))) {
            return 0.0;
        }
        g = own;
    }
    for (int i = 0; i < n; i++) {
        const poly *one = poly_mul(a, across[i], rate_squared);
        force[i] = poly_sub(a, force[i], poly_scale(a, one, g));
    }
    return g;
}

/* Eliminates unknown k, the angle `turning`. Returns false if row k is not the equation of a hinge. On success, the
 * caller must add across_i across_j / own to mass_ij, and across_i across_n / own to force_i. */
static bool hinge_eliminate(algebra *a, int n, const poly **mass, const poly **force,
                            const bool *gone, int k, const symbol *turning, double *own,
                            const poly **across) {
    if (!poly_is_number(mass[k * n + k], own) || *own <= 0.0) {
        return false;
    }
    const double c = shared_frequency(a, n, mass, gone, k, turning);
    if (c == 0.0 || !is_wave(a, force[k], turning)) {
        return false;
    }
    const poly *waving = poly_scale(a, bend(a, force[k], turning), -1.0 / (c * c));
    const poly *still = poly_sub(a, force[k], waving);
    if (poly_contains(still, turning, 0)) {
        return false;
    }
    const wave_of pull = wave_make(a, waving, turning, c);
    for (int i = 0; i < n; i++) {
        const bool left = i != k && !gone[i];
        across[i] = left ? wave_make(a, mass[k * n + i], turning, c).across : poly_number(a, 0.0);
    }
    const poly *rate = poly_symbol(a, turning, 1);
    const poly *rate_squared = poly_mul(a, rate, rate);
    const double g = take_pull(a, n, force, across, rate_squared);
    across[n] = poly_add(a, pull.across, poly_scale(a, rate_squared, g * *own));
    for (int i = 0; i < n; i++) {
        if (i == k || gone[i]) {
            continue;
        }
        const wave_of beside = {mass[k * n + i], across[i]};
        for (int j = 0; j < n; j++) {
            const wave_of above = {mass[k * n + j], across[j]};
            if (j != k && !gone[j]) {
                const poly *taken = poly_scale(a, without_turn(a, beside, above), 1.0 / *own);
                mass[i * n + j] = poly_sub(a, mass[i * n + j], taken);
            }
        }
        const poly *taken = without_turn(a, beside, pull);
        taken = poly_add(a, taken, poly_mul(a, beside.here, still));
        force[i] = poly_sub(a, force[i], poly_scale(a, taken, 1.0 / *own));
    }
    return true;
}

/* === forms of the equations =================================================================== */

typedef struct arrangement {
    bool scaled;
    bool rescaled; /* equations are rescaled after symbolic elimination */
    bool hinged;   /* unknowns on hinges are eliminated first, in the order below */
    int lead;      /* value of lowering.lead */
    /* unknown that is eliminated symbolically; -1: none; -2: all with a constant diagonal */
    int first;
    int order[COORDINATES_MAX]; /* order of elimination */
} arrangement;

/* The equations of an arrangement, with all polys in one array for lower_plan(). */
typedef struct arranged {
    int n;
    int polys;
    const poly **mass;  /* [n * n] */
    const poly **force; /* [n] */
    int hinges;
    const poly **across; /* [hinges * (n + 1)] `across` of hinge_eliminate() for each hinge */
    double inverse[COORDINATES_MAX]; /* [hinges] factor of across_i across_j in add_across() */
    double scale[COORDINATES_MAX];   /* [n] scale of each row and column */
    bool gone[COORDINATES_MAX];      /* [n] eliminated symbolically */
    int order[COORDINATES_MAX];      /* [n] eliminated unknowns first */
    int eliminated;
} arranged;

#define SYMBOLIC_TERMS_MAX 60 /* elimination stops before an entry gets more terms */

#define TALLY_MAX 128 /* different numbers in a tally; further numbers are not counted */

/* Counts how often each absolute value occurs. A tally starts as {0}. */
typedef struct tally {
    double size[TALLY_MAX];
    int uses[TALLY_MAX];
    int count;
} tally;

static void tally_add(tally *t, const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const double size = fabs(p->terms[i].coefficient);
        int k = 0;
        while (k < t->count && fabs(t->size[k] - size) > 1e-13 * size) {
            k++;
        }
        if (k == t->count && k < TALLY_MAX) {
            t->size[t->count++] = size;
        }
        if (k < t->count) {
            t->uses[k]++;
        }
    }
}

static double tally_favourite(const tally *t) {
    int best = -1;
    for (int k = 0; k < t->count; k++) {
        if (best < 0 || t->uses[k] > t->uses[best]) {
            best = k;
        }
    }
    return best < 0 ? 1.0 : t->size[best];
}

/* Chooses scale[i] for row and column i, and returns a divisor of all equations, to make many coefficients 1. */
static double choose_scales(const linear_system *s, double *scale) {
    const int n = s->n;
    tally all = {.count = 0};
    bool any_turning = false;
    for (int i = 0; i < n; i++) {
        any_turning = any_turning || s->turning[i];
    }
    for (int i = 0; i < n; i++) {
        if (any_turning && !s->turning[i]) {
            continue;
        }
        tally_add(&all, s->force[i]);
        for (int j = 0; j < n; j++) {
            if (!any_turning || s->turning[j]) {
                tally_add(&all, s->mass[i * n + j]);
            }
        }
    }
    const double common = tally_favourite(&all);
    for (int i = 0; i < n && any_turning; i++) {
        if (!s->turning[i]) {
            tally row = {.count = 0};
            for (int j = 0; j < n; j++) {
                if (s->turning[j]) {
                    tally_add(&row, s->mass[i * n + j]);
                }
            }
            scale[i] = row.count == 0 ? 1.0 : common / tally_favourite(&row);
        }
    }
    return common;
}

/* Returns c * scale. If only round-off separates it from a multiple of 1/48, returns that multiple. */
static double scale_number(folding *f, double c, double scale) {
    const double scaled = folding_product(f, c, scale);
    const double nearest = number_floor(scaled * 48.0 + 0.5) / 48.0;
    return nearest != 0.0 && folding_same(f, scaled, nearest, 1e-15) ? nearest : scaled;
}

static const poly *scale_simply(algebra *a, const poly *p, double scale) {
    return poly_each_number(a, p, scale_number, scale);
}

/* Eliminates unknown k from the other equations. If an entry would grow too much, returns false and changes nothing. */
static bool eliminate_symbolic(algebra *a, int n, const poly **mass, const poly **force,
                               const bool *gone, int k) {
    double diagonal;
    if (!poly_is_number(mass[k * n + k], &diagonal) || diagonal == 0.0) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (mass[i * n + k]->count * mass[k * n + j]->count > SYMBOLIC_TERMS_MAX) {
                return false;
            }
        }
    }
    for (int i = 0; i < n; i++) {
        if (gone[i] || i == k || poly_is_zero(mass[i * n + k])) {
            continue;
        }
        const poly *part = poly_scale(a, mass[i * n + k], 1.0 / diagonal);
        for (int j = 0; j < n; j++) {
            if (!gone[j] && j != k) {
                mass[i * n + j] = poly_sub(a, mass[i * n + j], poly_mul(a, part, mass[k * n + j]));
            }
        }
        force[i] = poly_sub(a, force[i], poly_mul(a, part, force[k]));
    }
    return true;
}

/* Deletes the equations of unwanted unknowns that are eliminated before the first wanted one. */
static void forget_unwanted(algebra *a, const linear_system *s, const poly **mass,
                            const poly **force, const int *order, int eliminated) {
    const int n = s->n;
    for (int e = 0; e < eliminated && !s->wanted[order[e]]; e++) {
        const int k = order[e];
        for (int i = 0; i < n; i++) {
            if (i != k) {
                mass[k * n + i] = mass[i * n + k] = poly_number(a, 0.0);
            }
        }
        force[k] = poly_number(a, 0.0);
    }
}

static void scale_equations(algebra *a, int n, const poly **mass, const poly **force,
                            const bool *gone, double scale) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (!gone[j]) {
                mass[i * n + j] = scale_simply(a, mass[i * n + j], scale);
            }
        }
        if (!gone[i]) {
            force[i] = scale_simply(a, force[i], scale);
        }
    }
}

/* Divides the remaining equations by the most frequent size of their numbers. */
static void scale_what_is_left(algebra *a, int n, const poly **mass, const poly **force,
                               const bool *gone) {
    tally all = {.count = 0};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (!gone[j]) {
                tally_add(&all, mass[i * n + j]);
            }
        }
        if (!gone[i]) {
            tally_add(&all, force[i]);
        }
    }
    scale_equations(a, n, mass, force, gone, 1.0 / tally_favourite(&all));
}

static void scale_all(algebra *a, const linear_system *s, const arrangement *how, arranged *w) {
    const int n = s->n;
    double common = 1.0;
    for (int i = 0; i < n; i++) {
        w->scale[i] = 1.0;
    }
    if (how->scaled) {
        common = choose_scales(s, w->scale);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double factor_ij = w->scale[i] * w->scale[j] / common;
            w->mass[i * n + j] =
                how->scaled ? scale_simply(a, s->mass[i * n + j], factor_ij) : s->mass[i * n + j];
        }
        w->force[i] =
            how->scaled ? scale_simply(a, s->force[i], w->scale[i] / common) : s->force[i];
    }
    for (int i = 0; i < n * (n + 1); i++) {
        w->across[i] = poly_number(a, 0.0);
    }
}

static void put_away(arranged *w, int k) {
    w->gone[k] = true;
    w->order[w->eliminated++] = k;
}

/* Eliminates all unknowns on hinges, in the arrangement's order. Returns false if there are none. */
static bool eliminate_hinged(algebra *a, const linear_system *s, const arrangement *how,
                             arranged *w) {
    const int n = s->n;
    for (int i = 0; i < n; i++) {
        const int k = how->order[i];
        const poly **across = w->across + w->hinges * (n + 1);
        double own;
        bool off = true; /* true: no earlier hinge adds terms to row k in add_across() */
        for (int h = 0; h < w->hinges; h++) {
            off = off && poly_is_zero(w->across[h * (n + 1) + k]);
        }
        if (off &&
            hinge_eliminate(a, n, w->mass, w->force, w->gone, k, s->unknown[k], &own, across)) {
            w->inverse[w->hinges++] = 1.0 / own;
            put_away(w, k);
        }
    }
    return w->hinges > 0;
}

static void scale_unknown(algebra *a, arranged *w, int i, double scale) {
    const int n = w->n;
    for (int j = 0; j < n; j++) {
        w->mass[i * n + j] = scale_simply(a, w->mass[i * n + j], scale);
        w->mass[j * n + i] = scale_simply(a, w->mass[j * n + i], scale);
    }
    for (int h = 0; h < w->hinges; h++) {
        const poly **across = &w->across[h * (n + 1) + i];
        *across = scale_simply(a, *across, scale);
    }
    w->force[i] = scale_simply(a, w->force[i], scale);
    w->scale[i] *= scale;
}

static void scale_beside_hinges(algebra *a, const linear_system *s, arranged *w) {
    const int n = s->n;
    const double common = 1.0 / w->inverse[0];
    for (int h = 0; h < w->hinges; h++) {
        w->inverse[h] = scale_number(algebra_folding(a), w->inverse[h], common);
    }
    scale_equations(a, n, w->mass, w->force, w->gone, common);
    for (int i = 0; i < n; i++) {
        if (w->gone[i] || s->turning[i]) {
            continue;
        }
        tally row = {.count = 0};
        for (int h = 0; h < w->hinges; h++) {
            tally_add(&row, w->across[h * (n + 1) + i]);
        }
        tally_add(&row, w->force[i]);
        for (int j = 0; j < n; j++) {
            if (j != i) {
                tally_add(&row, w->mass[i * n + j]);
            }
        }
        scale_unknown(a, w, i, 1.0 / tally_favourite(&row));
    }
}

/* Returns false if the arrangement is impossible. The caller frees w->mass in both cases. */
static bool arrange(algebra *a, const linear_system *s, const arrangement *how, arranged *w) {
    const int n = s->n;
    *w = (arranged){.n = n, .polys = n * n + n + n * (n + 1)};
    w->mass = alloc(w->polys, sizeof *w->mass);
    w->force = w->mass + n * n;
    w->across = w->force + n;
    scale_all(a, s, how, w);
    if (how->hinged && !eliminate_hinged(a, s, how, w)) {
        return false;
    }
    for (int i = 0; i < n && how->first != -1; i++) {
        const int k = how->order[i];
        if ((how->first == -2 || how->first == k) &&
            eliminate_symbolic(a, n, w->mass, w->force, w->gone, k)) {
            put_away(w, k);
        }
    }
    if (how->hinged && how->rescaled) {
        scale_beside_hinges(a, s, w);
    } else if (how->rescaled && w->eliminated > 0) {
        scale_what_is_left(a, n, w->mass, w->force, w->gone);
    }
    if (s->sparing) {
        forget_unwanted(a, s, w->mass, w->force, w->order, w->eliminated);
    }
    int entered = w->eliminated;
    for (int i = 0; i < n; i++) {
        if (!w->gone[how->order[i]]) {
            w->order[entered++] = how->order[i];
        }
    }
    return true;
}

/* === the cheapest of several arrangements ===================================================== */

/* All orders of elimination are tried only up to PERMUTED_MAX unknowns and PERMUTED_SIZE_MAX operands. */
#define PERMUTED_MAX 4           /* unknowns */
#define PERMUTED_SIZE_MAX 4000.0 /* operands in the equations */
#define LEADS_MAX 5              /* largest arrangement.lead that is tried */

/* Adds a hinge's terms, across_i across_j * inverse, to the mass matrix and the forces. */
static void add_across(op_list *t, int n, const int *across, double inverse, int *mass,
                       int *force) {
    const int factor = op_list_constant(t, inverse);
    for (int i = 0; i < n; i++) {
        const int part = op_list_mul(t, factor, across[i]);
        for (int j = 0; j <= i; j++) {
            const int product = op_list_mul(t, part, across[j]);
            mass[i * n + j] = op_list_add(t, mass[i * n + j], product);
            mass[j * n + i] = mass[i * n + j];
        }
        const int pull = op_list_mul(t, part, across[n]);
        force[i] = op_list_add(t, force[i], pull);
    }
}

/* Enters the solution into `t`. If the arrangement is impossible, enters nothing and returns false. */
static bool enter(const lowering *like, op_list *t, const linear_system *s, const arrangement *how,
                  int *solution) {
    const int n = s->n;
    lowering l = *like;
    l.list = t;
    l.waves = NULL;
    l.uses = NULL;
    l.wave_count = l.uses_room = 0;
    l.lead = how->lead;
    arranged w;
    const bool can = arrange(l.algebra, s, how, &w);
    if (can) {
        int *node = alloc(w.polys, sizeof *node);
        lower_plan(&l, w.mass, w.polys);
        for (int i = 0; i < w.polys; i++) {
            node[i] = lower(&l, w.mass[i]);
        }
        lower_done(&l);
        for (int h = 0; h < w.hinges; h++) {
            const int *across = node + n * n + n + h * (n + 1);
            add_across(t, n, across, w.inverse[h], node, node + n * n);
        }
        if (s->symmetric) {
            eliminate_symmetric(t, n, node, node + n * n, w.order, w.eliminated, solution);
        } else {
            eliminate_general(t, n, w.mass, node, node + n * n, solution);
        }
        for (int i = 0; i < n; i++) {
            solution[i] = op_list_mul(t, op_list_constant(t, w.scale[i]), solution[i]);
        }
        free(node);
    }
    free(w.mass);
    return can;
}

/* Returns the weight of an arrangement's list, or -1 if the arrangement is impossible. */
static int weigh(const lowering *l, const linear_system *s, const arrangement *how) {
    op_list *t = op_list_new(l->list->angles, s->n);
    t->folding = l->list->folding;
    int weight = -1;
    if (enter(l, t, s, how, t->result)) {
        for (int i = 0; i < s->n; i++) {
            t->result[i] = s->wanted[i] ? t->result[i] : op_list_constant(t, 0.0);
        }
        op_list_prune(t);
        if (s->sparing) {
            op_list_share_sums(t);
        }
        weight = op_list_weight(t);
    }
    op_list_free(t);
    return weight;
}

static bool next_order(int *order, int n) {
    int i = n - 2;
    while (i >= 0 && order[i] > order[i + 1]) {
        i--;
    }
    if (i < 0) {
        return false;
    }
    int j = n - 1;
    while (order[j] < order[i]) {
        j--;
    }
    exchange(&order[i], &order[j]);
    for (int x = i + 1, y = n - 1; x < y; x++, y--) {
        exchange(&order[x], &order[y]);
    }
    return true;
}

typedef struct choice {
    arrangement how;
    int weight; /* -1: no arrangement was tried yet */
} choice;

static void try_it(const lowering *l, const linear_system *s, const arrangement *how,
                   choice *best) {
    const int weight = weigh(l, s, how);
    if (weight >= 0 && (best->weight < 0 || weight < best->weight)) {
        *best = (choice){*how, weight};
    }
}

static void try_scales(const lowering *l, const linear_system *s, arrangement how, bool rescales,
                       choice *best) {
    for (int again = 0; again <= rescales; again++) {
        how.rescaled = again == 1;
        try_it(l, s, &how, best);
    }
}

/* Tries all methods of elimination with like->order. */
static void try_order(const lowering *l, const linear_system *s, const arrangement *like,
                      bool permuted, choice *best) {
    for (int scaled = 0; scaled < 2; scaled++) {
        arrangement how = *like;
        how.scaled = scaled == 1;
        for (int first = -2; first < (permuted ? s->n : 0); first++) {
            how.first = first;
            try_scales(l, s, how, s->sparing && first != -1, best);
        }
        if (s->sparing && !s->precise) {
            how.first = -1;
            how.hinged = true;
            try_scales(l, s, how, true, best);
        }
    }
}

void solve_highest(lowering *l, const linear_system *s, int *solution) {
    const int n = s->n;
    arrangement how = {.first = -1};
    int constants = 0;
    for (int pass = 0; pass < 2; pass++) { /* unknowns with a constant diagonal come first */
        for (int i = 0; i < n; i++) {
            double value;
            const bool constant = poly_is_number(s->mass[i * n + i], &value) && s->symmetric;
            if (constant == (pass == 0)) {
                how.order[constants++] = i;
            }
        }
    }
    double size = 0.0;
    for (int i = 0; i < n * n; i++) {
        size += s->mass[i]->size;
    }
    for (int i = 0; i < n; i++) {
        size += s->force[i]->size;
    }
    const bool permuted = n <= PERMUTED_MAX && size <= PERMUTED_SIZE_MAX;
    choice best = {how, -1};
    if (s->symmetric) {
        do {
            try_order(l, s, &how, permuted, &best);
        } while (permuted && next_order(how.order, n));
    }
    how = best.how;
    for (how.lead = 1; s->sparing && how.lead <= LEADS_MAX; how.lead++) {
        try_it(l, s, &how, &best);
    }
    enter(l, l->list, s, &best.how, solution);
}
