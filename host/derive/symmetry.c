/* symmetry.c: the search for affine symmetries as the null space of linear conditions (theory: symmetry.h). */
#include "host/derive/symmetry.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/number/gauss.h"

/* === the null space =========================================================================== */

/* Conditions row . v = 0 on a vector v. Each row has norm 1. If count is 0, `row` is NULL. The owner frees it. */
typedef struct conditions {
    int columns;
    int count;
    double *row; /* [count * columns] */
} conditions;

/* Entries within this distance of a whole number are rounded to it. */
#define NULL_SPACE_ROUNDING 1e-8

static double vector_length(const double *row, int columns) {
    double most = 0.0;
    double sum = 0.0;
    for (int k = 0; k < columns; k++) {
        most = number_most(most, fabs(row[k]));
    }
    for (int k = 0; k < columns && most > 0.0; k++) {
        sum += (row[k] / most) * (row[k] / most);
    }
    return most * number_root(sum);
}

static void conditions_take(conditions *c, const double *row) {
    const double length = vector_length(row, c->columns);
    if (length > 0.0) {
        const int64_t before = (int64_t)c->count++ * c->columns;
        c->row = alloc_more(c->row, before + c->columns, sizeof *c->row);
        for (int k = 0; k < c->columns; k++) {
            c->row[before + k] = row[k] / length;
        }
    }
}

static void conditions_add(conditions *c, const conditions *more) {
    for (int i = 0; i < more->count; i++) {
        conditions_take(c, &more->row[(ptrdiff_t)i * c->columns]);
    }
}

/* Writes a basis of the null space of the conditions to basis[], row by row, and returns the number of rows. A pivot
 * counts as zero if it is at most `zero` times the largest entry of the conditions. */
static int null_space(const conditions *c, double zero, double *basis) {
    const int n = c->columns;
    const int64_t entries = (int64_t)c->count * n;
    double *m = alloc(entries, sizeof *m);
    int *lead = alloc(n, sizeof *lead);
    double most = 0.0;
    int count = 0;
    for (int64_t i = 0; i < entries; i++) {
        m[i] = c->row[i];
        most = number_most(most, fabs(m[i]));
    }
    int pivots = gauss_reduce(m, c->count, n, n, false, zero * most, lead);
    for (int k = n - 1; k >= 0; k--) {
        if (pivots > 0 && lead[pivots - 1] == k) {
            pivots--;
            continue;
        }
        double *v = &basis[count++ * n];
        for (int j = 0; j < n; j++) {
            v[j] = j == k ? 1.0 : 0.0;
        }
        for (int i = 0; i < pivots; i++) { /* the rows whose pivot is before column k */
            const double entry = -m[i * n + k] / m[i * n + lead[i]];
            const double whole = number_nearest(entry);
            v[lead[i]] = fabs(entry - whole) > NULL_SPACE_ROUNDING ? entry : whole;
        }
    }
    free(lead);
    free(m);
    return count;
}

/* === symmetries =============================================================================== */

/* The argument `zero` of null_space() for two kinds of conditions. */
#define ZERO_OF_TERMS 1e-12  /* conditions from coefficients of terms */
#define ZERO_OF_VALUES 1e-11 /* conditions from values at random states */
#define DRAWS 50 /* attempts to find a random state at which all functions are defined */

/* The columns of a condition: the entries of A, row by row, then the entries of b. */
static int columns_of(const equations *e) { return e->count * (e->count + 1); }

/* Returns the change of an energy by a motion in which the entry of column k is 1, and all others are 0. */
static const poly *change_by(const equations *e, const poly *energy, int k) {
    algebra *a = e->algebra;
    const int n = e->count;
    const symbol *moved = e->unknowns[k < n * n ? k / n : k - n * n].symbol;
    const poly *by_place = poly_derivative(a, energy, moved, 0);
    if (k >= n * n) {
        return by_place;
    }
    const symbol *with = e->unknowns[k % n].symbol;
    return poly_add(a, poly_mul(a, by_place, poly_symbol(a, with, 0)),
                    poly_mul(a, poly_derivative(a, energy, moved, 1), poly_symbol(a, with, 1)));
}

/* Expands sines and cosines such as sin(theta + 0.5), because take_terms() needs linearly independent terms. */
static const poly *without_phases(algebra *a, const poly *p) {
    const poly *sum = poly_number(a, 0.0);
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double number = 0.0;
        for (int k = 0; m->angle != NULL && k < m->angle->count; k++) {
            const poly_term *t = &m->angle->terms[k];
            number = t->mono->count == 0 && t->mono->trig == TRIG_NONE ? t->coefficient : number;
        }
        if (number == 0.0) {
            sum = poly_add(a, sum, poly_of_term(a, p->terms[i].coefficient, m));
            continue;
        }
        const poly *angle = poly_sub(a, m->angle, poly_number(a, number));
        const bool is_sine = m->trig == TRIG_SIN;
        const poly *same = is_sine ? poly_sin(a, angle) : poly_cos(a, angle);
        const poly *other = is_sine ? poly_cos(a, angle) : poly_sin(a, angle);
        const double part = is_sine ? number_sine(number) : -number_sine(number);
        const poly *product =
            poly_add(a, poly_scale(a, same, number_cosine(number)), poly_scale(a, other, part));
        product = poly_scale(a, product, p->terms[i].coefficient);
        for (int k = 0; k < m->count; k++) {
            product =
                poly_mul(a, product, poly_of_atom(a, m->factors[k].atom, m->factors[k].exponent));
        }
        sum = poly_add(a, sum, product);
    }
    return sum;
}

/* Returns the sum of row[i] times the shift of coordinate i by motion k (columns_of()). */
static const poly *power_by(const equations *e, const poly *const *row, int k) {
    const int n = e->count;
    const poly *on = equations_fold(e, row[k < n * n ? k / n : k - n * n]);
    return k < n * n
               ? poly_mul(e->algebra, on, poly_symbol(e->algebra, e->unknowns[k % n].symbol, 0))
               : on;
}

typedef struct entry {
    const mono *mono;
    int column;
    double coefficient;
} entry;

static int by_mono(const void *left, const void *right) {
    const entry *x = left;
    const entry *y = right;
    return x->mono->id != y->mono->id ? (x->mono->id < y->mono->id ? -1 : 1)
                                      : x->column - y->column;
}

/* Adds a condition for each mono in the normal forms change[columns]: row[k] is the mono's coefficient in change[k]. */
static void take_terms(conditions *s, const poly *const *change) {
    int64_t count = 0;
    for (int k = 0; k < s->columns; k++) {
        count += change[k]->count;
    }
    entry *all = alloc(count, sizeof *all);
    double *row = alloc(s->columns, sizeof *row);
    int64_t filled = 0;
    for (int k = 0; k < s->columns; k++) {
        for (int i = 0; i < change[k]->count; i++) {
            all[filled++] = (entry){change[k]->terms[i].mono, k, change[k]->terms[i].coefficient};
        }
    }
    qsort(all, (size_t)count, sizeof *all, by_mono);
    for (int64_t i = 0; i < count;) {
        const mono *of = all[i].mono;
        for (int k = 0; k < s->columns; k++) {
            row[k] = 0.0;
        }
        for (; i < count && all[i].mono == of; i++) {
            row[all[i].column] = all[i].coefficient;
        }
        conditions_take(s, row);
    }
    free(row);
    free(all);
}

/* Adds the condition that the power of a force, or the rate of a gap, vanishes. */
static void take_row(const equations *e, conditions *s, const poly *const *row,
                     const poly **change) {
    for (int k = 0; k < s->columns; k++) {
        change[k] = without_phases(e->algebra, poly_expanded(e->algebra, power_by(e, row, k)));
    }
    take_terms(s, change);
}

/* Adds the condition that the momentum does not depend on the symbol that a crossing sets. */
static void take_set(const equations *e, conditions *s, const assignment *set,
                     const poly **change) {
    for (int k = 0; k < s->columns; k++) {
        const poly *momentum = poly_expanded(e->algebra, power_by(e, e->momentum, k));
        change[k] = without_phases(
            e->algebra, poly_expanded(e->algebra, poly_derivative(e->algebra, momentum, set->symbol,
                                                                  set->primes)));
    }
    take_terms(s, change);
}

/* Adds conditions for a momentum that neither the applied forces nor any contact changes. */
static void take_forces(const equations *e, conditions *s, const poly **change) {
    const contact_laws *laws = e->contacts;
    take_row(e, s, e->applied, change);
    for (int c = 0; laws != NULL && c < laws->count; c++) {
        const contact_law *law = &laws->law[c];
        if (law->row != NULL) {
            take_row(e, s, law->row, change);
        }
        for (int i = 0; law->row == NULL && i < law->from->set_count; i++) {
            take_set(e, s, &law->from->sets[i], change);
        }
    }
}

/* Counts motions that leave an energy unchanged at random states. Returns -1 if the states give no finite change[]. */
static int count_by_values(const equations *e, const poly *const *change) {
    const int columns = columns_of(e);
    conditions of_values = {.columns = columns};
    double *row = alloc(columns, sizeof *row);
    double *basis = alloc((int64_t)columns * columns, sizeof *basis);
    uint64_t seed = 1;
    bool good = true;
    for (int i = 0; i < 2 * columns && good; i++) {
        good = false;
        for (int draw = 0; draw < DRAWS && !good; draw++, seed++) {
            good = true;
            for (int k = 0; k < columns && good; k++) {
                row[k] = poly_evaluate(change[k], equations_generic, &seed);
                good = isfinite(row[k]);
            }
        }
        if (good) {
            conditions_take(&of_values, row);
        }
    }
    const int count = good ? null_space(&of_values, ZERO_OF_VALUES, basis) : -1;
    free(basis);
    free(row);
    free(of_values.row);
    return count;
}

const poly *symmetry_along(const equations *e, const symmetry *s, const poly *const *row) {
    const poly *sum = poly_number(e->algebra, 0.0);
    for (int i = 0; i < e->count; i++) {
        sum = poly_add(e->algebra, sum, poly_mul(e->algebra, row[i], s->shift[i]));
    }
    return poly_expanded(e->algebra, sum);
}

static symmetry symmetry_of(const equations *e, const double *by) {
    algebra *a = e->algebra;
    const int n = e->count;
    symmetry s = {.shift = algebra_room(a, n, sizeof(const poly *)), .stored = poly_number(a, 0.0)};
    for (int i = 0; i < n; i++) {
        s.shift[i] = poly_number(a, by[n * n + i]);
        for (int j = 0; j < n; j++) {
            s.shift[i] =
                poly_add(a, s.shift[i],
                         poly_scale(a, poly_symbol(a, e->unknowns[j].symbol, 0), by[i * n + j]));
        }
    }
    s.momentum = symmetry_along(e, &s, e->momentum);
    for (int k = 0; k < n * (n + 1); k++) {
        if (fabs(by[k]) > 0.0) {
            s.stored = poly_add(a, s.stored, poly_scale(a, change_by(e, e->stored, k), by[k]));
        }
    }
    s.stored = poly_expanded(a, s.stored);
    return s;
}

typedef struct finding {
    const equations *equations;
    symmetries *found;
    /* [(columns + 1) * columns] rows: the symmetries found, and a place for one more */
    double *known;
    int count;     /* number of symmetries found */
    double *basis; /* [columns * columns] working memory */
} finding;

static bool is_new(finding *f, const double *v, int columns) {
    const int rows = f->count + 1;
    const size_t row = (size_t)columns * sizeof *v;
    double *m = alloc((int64_t)rows * columns, sizeof *m);
    int *lead = alloc(columns, sizeof *lead);
    memcpy(f->known + (ptrdiff_t)f->count * columns, v, row);
    memcpy(m, f->known, (size_t)rows * row);
    const int rank = gauss_reduce(m, rows, columns, columns, true, NULL_SPACE_ROUNDING, lead);
    f->count = rank;
    free(lead);
    free(m);
    return rank == rows;
}

/* Adds the symmetries that meet all conditions and are new. Returns how many meet them, known ones included. */
static int find_more(finding *f, const conditions *c, bool of_both, bool conserved) {
    const int count = null_space(c, ZERO_OF_TERMS, f->basis);
    for (int i = 0; i < count; i++) {
        const double *v = &f->basis[i * c->columns];
        if (!is_new(f, v, c->columns)) {
            continue;
        }
        symmetry made = symmetry_of(f->equations, v);
        made.conserved = conserved;
        if (of_both) {
            made.stored = poly_number(f->equations->algebra, 0.0);
        }
        if (!poly_is_zero(made.momentum)) { /* skips motions without kinetic energy */
            f->found->each[f->found->count++] = made;
        }
    }
    return count;
}

/* Adds the conditions A = 0, so that only shifts remain. */
static void take_no_turning(conditions *s, int n) {
    double *row = alloc(s->columns, sizeof *row);
    for (int k = 0; k < n * n; k++) {
        for (int j = 0; j < s->columns; j++) {
            row[j] = j == k ? 1.0 : 0.0;
        }
        conditions_take(s, row);
    }
    free(row);
}

static bool is_flat(const equations *e) {
    double number;
    bool flat = true;
    for (int i = 0; i < e->count * e->count; i++) {
        flat = flat && poly_is_number(equations_fold(e, e->mass[i]), &number);
    }
    return flat;
}

symmetries *symmetries_find(const equations *e) {
    algebra *a = e->algebra;
    const int columns = columns_of(e);
    const int64_t square = (int64_t)columns * columns;
    const poly **change = algebra_room(a, columns, sizeof *change);
    const poly *const energy[] = {equations_fold(e, e->kinetic), equations_fold(e, e->stored)};
    conditions of[] = {{.columns = columns}, {.columns = columns}};
    conditions of_forces = {.columns = columns};
    symmetries *found = algebra_room(a, 1, sizeof *found);
    *found = (symmetries){.each = algebra_room(a, columns, sizeof *found->each),
                          .complete = true,
                          .flat = is_flat(e)};
    finding f = {e, found, alloc(square + columns, sizeof(double)), 0,
                 alloc(square, sizeof(double))};
    for (int which = 0; which < 2 && !algebra_overflow(a); which++) {
        for (int k = 0; k < columns; k++) {
            change[k] = without_phases(a, poly_expanded(a, change_by(e, energy[which], k)));
        }
        take_terms(&of[which], change);
        found->complete =
            found->complete && !algebra_overflow(a) &&
            count_by_values(e, change) == null_space(&of[which], ZERO_OF_TERMS, f.basis);
    }
    take_forces(e, &of_forces, change);
    conditions_add(&of[1], &of[0]);
    conditions_add(&of_forces, &of[1]);
    (void)find_more(&f, &of_forces, true, true);
    (void)find_more(&f, &of[1], true, false);
    const int of_kinetic = null_space(&of[0], ZERO_OF_TERMS, f.basis);
    take_no_turning(&of[0], e->count);
    (void)find_more(&f, &of[0], false, false);
    found->broken = of_kinetic - f.count;
    free(f.basis);
    free(f.known);
    free(of_forces.row);
    free(of[1].row);
    free(of[0].row);
    return algebra_overflow(a) ? NULL : found;
}
