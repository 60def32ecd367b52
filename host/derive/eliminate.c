/* eliminate.c: Gauss's elimination and Cramer's rule, as operations. */
#include "eliminate.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"

static int minus_product(tape *t, int from, int x, int y) {
    return tape_sub(t, from, tape_mul(t, x, y));
}

/* --- symmetric positive definite -----------------------------------------------------------------*/

/* x_k = (f_k - sum over later unknowns of m_kj x_j) / m_kk */
static void substitute_back(tape *t, int n, const int *mass, const int *force, const int *order,
                            int at, int *solution) {
    const int k = order[at];
    int rest = force[k];
    for (int i = at + 1; i < n; i++) {
        rest = minus_product(t, rest, mass[k * n + order[i]], solution[order[i]]);
    }
    solution[k] = tape_div(t, rest, mass[k * n + k]);
}

static void solve_pair(tape *t, int n, const int *mass, const int *force, int i, int j,
                       int *solution) {
    const int mixed = mass[i * n + j];
    const int determinant =
        minus_product(t, tape_mul(t, mass[i * n + i], mass[j * n + j]), mixed, mixed);
    const int inverse = tape_div(t, tape_constant(t, 1.0), determinant);
    const int x = minus_product(t, tape_mul(t, force[i], mass[j * n + j]), mixed, force[j]);
    const int y = minus_product(t, tape_mul(t, force[j], mass[i * n + i]), mixed, force[i]);
    solution[i] = tape_mul(t, x, inverse);
    solution[j] = tape_mul(t, y, inverse);
}

static void eliminate_symmetric(tape *t, int n, int *mass, int *force, const int *order, int done,
                                int *solution) {
    int left = n - 1; /* the last place whose value is still wanted */
    double value;
    for (int at = done; at < n - 1; at++) {
        const int k = order[at];
        const bool fixed = tape_is_constant(t, mass[k * n + k], &value);
        if (at == n - 2 && !fixed) {
            solve_pair(t, n, mass, force, k, order[n - 1], solution);
            left = n - 3;
            break;
        }
        const int inverse = tape_div(t, tape_constant(t, 1.0), mass[k * n + k]);
        for (int x = at + 1; x < n; x++) {
            const int i = order[x];
            const int part = tape_mul(t, inverse, mass[k * n + i]);
            for (int y = x; y < n; y++) {
                const int j = order[y];
                mass[i * n + j] = minus_product(t, mass[i * n + j], part, mass[k * n + j]);
                mass[j * n + i] = mass[i * n + j];
            }
            force[i] = minus_product(t, force[i], part, force[k]);
        }
    }
    for (; left >= 0; left--) {
        substitute_back(t, n, mass, force, order, left, solution);
    }
}

/* --- any regular matrix --------------------------------------------------------------------------*/

/* A number between 0.3 and 0.67, another for each leaf: it depends on what the leaf is, not on its place in
 * the list. */
static double generic(double of) {
    return 0.3 + 0.37 * number_remainder(fabs(of) * 0.6180339887, 1.0);
}

/* What every operation gives at a made-up generic state: tells vanishing pivots from others. */
static double *sample(const tape *t) {
    double *v = room(t->count, sizeof *v);
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const int values = op_rows[o->code].values;
        const double a = values > 0 ? v[o->a] : 0.0;
        const double b = (values > 1 || o->code == OP_PHASE) && o->b >= 0 ? v[o->b] : 0.0;
        switch (o->code) {
        case OP_CONSTANT: v[i] = o->value; break;
        case OP_LINEAR:
        case OP_RATE:
        case OP_INPUT:
        case OP_ACCEL:
        case OP_TIME:
        case OP_RADIANS:
        case OP_NOISE: v[i] = generic(1.0 + 31.0 * (double)o->code + o->a); break;
        case OP_PHASE:
            v[i] = o->value + b;
            for (int k = 0; k < t->angles && o->turns != NULL; k++) {
                v[i] += o->turns[k] * generic(1.0 + k);
            }
            break;
        case OP_ADD: v[i] = a + b; break;
        case OP_SUB: v[i] = a - b; break;
        case OP_MUL: v[i] = a * b; break;
        case OP_DIV: v[i] = a / b; break;
        case OP_NEG: v[i] = -a; break;
        case OP_SQRT: v[i] = number_root(fabs(a)); break;
        case OP_CELL: /* no list that is eliminated from has tables */
        case OP_LINE:
        case OP_CUBIC:
        case OP_SIN:
        case OP_COS:
        case OP_ABS:
        case OP_SIGN:
        case OP_MIN:
        case OP_MAX:
        case OP_CALL:
        case OP_POW: v[i] = generic(31.0 * (double)o->code + 7.0 * a + 3.0 * b); break;
        }
    }
    return v;
}

/* Determinant of the equations rows[] in the unknowns columns[], by cofactors (size <= 3). */
static int determinant(tape *t, int n, const int *mass, const int *rows, const int *columns,
                       int size) {
    if (size == 1) {
        return mass[rows[0] * n + columns[0]];
    }
    int sum = tape_constant(t, 0.0);
    for (int c = 0; c < size; c++) {
        int rest[3];
        int kept = 0;
        for (int k = 0; k < size; k++) {
            if (k != c) {
                rest[kept++] = columns[k];
            }
        }
        const int minor = determinant(t, n, mass, rows + 1, rest, size - 1);
        const int product = tape_mul(t, mass[rows[0] * n + columns[c]], minor);
        sum = c % 2 == 0 ? tape_add(t, sum, product) : tape_sub(t, sum, product);
    }
    return sum;
}

static void solve_cramer(tape *t, int n, const int *mass, const int *force, const int *rows,
                         const int *columns, int size, int *solution) {
    const int all = determinant(t, n, mass, rows, columns, size);
    const int inverse = tape_div(t, tape_constant(t, 1.0), all);
    int *swapped = room((int64_t)n * n, sizeof *swapped);
    for (int c = 0; c < size; c++) {
        for (int i = 0; i < n * n; i++) {
            swapped[i] = mass[i];
        }
        for (int r = 0; r < size; r++) {
            swapped[rows[r] * n + columns[c]] = force[rows[r]];
        }
        const int top = determinant(t, n, swapped, rows, columns, size);
        solution[columns[c]] = size == 1 ? tape_div(t, top, all) : tape_mul(t, top, inverse);
    }
    free(swapped);
}

/* Move the best pivot among the equations and unknowns from `at` on to place `at`: a constant one if
 * there is any, else the largest at the sample state. Returns whether it is constant. */
static bool bring_pivot(const tape *t, int n, const int *mass, int *rows, int *columns, int at) {
    double *v = sample(t);
    double best = -1.0;
    bool best_constant = false;
    int row = at;
    int column = at;
    for (int i = at; i < n; i++) {
        for (int j = at; j < n; j++) {
            const int entry = mass[rows[i] * n + columns[j]];
            const bool constant = t->ops[entry].code == OP_CONSTANT && t->ops[entry].value != 0.0;
            const double size = isfinite(v[entry]) ? fabs(v[entry]) : 0.0;
            if ((constant && !best_constant) || (constant == best_constant && size > best)) {
                best = size;
                best_constant = constant;
                row = i;
                column = j;
            }
        }
    }
    free(v);
    int swap = rows[at];
    rows[at] = rows[row];
    rows[row] = swap;
    swap = columns[at];
    columns[at] = columns[column];
    columns[column] = swap;
    return best_constant;
}

static void eliminate_general(tape *t, int n, int *mass, int *force, int *solution) {
    int *rows = room(2 * (int64_t)n, sizeof *rows);
    int *columns = rows + n;
    for (int i = 0; i < n; i++) {
        rows[i] = columns[i] = i;
    }
    int at = 0;
    while (at < n) {
        const bool constant = bring_pivot(t, n, mass, rows, columns, at);
        if (!constant && n - at <= 3) {
            solve_cramer(t, n, mass, force, rows + at, columns + at, n - at, solution);
            break;
        }
        const int pivot = mass[rows[at] * n + columns[at]];
        for (int i = at + 1; i < n; i++) {
            const int r = rows[i];
            const int part = tape_div(t, mass[r * n + columns[at]], pivot);
            for (int j = at + 1; j < n; j++) {
                const int above = mass[rows[at] * n + columns[j]];
                mass[r * n + columns[j]] = minus_product(t, mass[r * n + columns[j]], part, above);
            }
            force[r] = minus_product(t, force[r], part, force[rows[at]]);
        }
        at++;
    }
    for (at = at - 1; at >= 0; at--) {
        int rest = force[rows[at]];
        for (int j = at + 1; j < n; j++) {
            rest = minus_product(t, rest, mass[rows[at] * n + columns[j]], solution[columns[j]]);
        }
        solution[columns[at]] = tape_div(t, rest, mass[rows[at] * n + columns[at]]);
    }
    free(rows);
}

void eliminate(tape *t, bool symmetric, int n, int *mass, int *force, const int *order, int done,
               int *solution) {
    if (symmetric) {
        eliminate_symmetric(t, n, mass, force, order, done, solution);
    } else {
        eliminate_general(t, n, mass, force, solution);
    }
}
