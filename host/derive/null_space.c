#include "null_space.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

#define SWEEPS_MOST 60

conditions conditions_none(int columns) {
    return (conditions){columns, alloc((int64_t)columns * columns, sizeof(double))};
}

double vector_length(const double *row, int columns) {
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

/* Takes a row, which is destroyed, by Givens rotations. */
static void rotate_in(conditions *c, double *row) {
    const int n = c->columns;
    for (int k = 0; k < n; k++) {
        double *above = &c->r[k * n];
        const double size = number_root(above[k] * above[k] + row[k] * row[k]);
        if (size > 0.0) {
            const double cosine = above[k] / size;
            const double sine = row[k] / size;
            for (int j = k; j < n; j++) {
                const double old = above[j];
                above[j] = cosine * old + sine * row[j];
                row[j] = cosine * row[j] - sine * old;
            }
        }
    }
}

void conditions_take(conditions *c, double *row) {
    const double length = vector_length(row, c->columns);
    for (int k = 0; k < c->columns && length > 0.0; k++) {
        row[k] /= length;
    }
    rotate_in(c, row);
}

void conditions_add(conditions *c, const conditions *more) {
    double *row = alloc(c->columns, sizeof *row);
    for (int i = 0; i < c->columns; i++) {
        for (int k = 0; k < c->columns; k++) {
            row[k] = more->r[i * c->columns + k];
        }
        rotate_in(c, row);
    }
    free(row);
}

/* One Jacobi rotation that makes columns p and q of m orthogonal; v turns along. False when they are so already. */
static bool make_orthogonal(double *m, double *v, int n, int p, int q) {
    double pp = 0.0;
    double qq = 0.0;
    double pq = 0.0;
    for (int i = 0; i < n; i++) {
        pp += m[i * n + p] * m[i * n + p];
        qq += m[i * n + q] * m[i * n + q];
        pq += m[i * n + p] * m[i * n + q];
    }
    if (!(fabs(pq) > 1e-16 * number_root(pp * qq))) {
        return false;
    }
    const double ratio = (qq - pp) / (2.0 * pq);
    const double tangent =
        (ratio < 0.0 ? -1.0 : 1.0) / (fabs(ratio) + number_root(1.0 + ratio * ratio));
    const double cosine = 1.0 / number_root(1.0 + tangent * tangent);
    double *const both[] = {m, v};
    for (int which = 0; which < 2; which++) {
        double *of = both[which];
        for (int i = 0; i < n; i++) {
            const double left = of[i * n + p];
            const double right = of[i * n + q];
            of[i * n + p] = cosine * (left - tangent * right);
            of[i * n + q] = cosine * (tangent * left + right);
        }
    }
    return true;
}

int null_space(const conditions *c, double zero, double *basis) {
    const int n = c->columns;
    double *m = alloc((int64_t)n * n, sizeof *m);
    double *v = alloc((int64_t)n * n, sizeof *v);
    double *size = alloc(n, sizeof *size);
    double most = 0.0;
    int count = 0;
    for (int i = 0; i < n * n; i++) {
        m[i] = c->r[i];
        v[i] = i / n == i % n ? 1.0 : 0.0;
    }
    bool turns = true;
    for (int sweep = 0; turns && sweep < SWEEPS_MOST; sweep++) {
        turns = false;
        for (int p = 0; p < n; p++) {
            for (int q = p + 1; q < n; q++) {
                turns = make_orthogonal(m, v, n, p, q) || turns;
            }
        }
    }
    for (int k = 0; k < n; k++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++) {
            sum += m[i * n + k] * m[i * n + k];
        }
        size[k] = number_root(sum);
        most = number_most(most, size[k]);
    }
    for (int k = 0; k < n; k++) {
        if (!(size[k] > zero * most)) {
            for (int i = 0; i < n; i++) {
                basis[count * n + i] = v[i * n + k];
            }
            count++;
        }
    }
    free(size);
    free(v);
    free(m);
    return count;
}

void null_space_tidy(double *basis, int count, int columns) {
    for (int done = 0; done < count; done++) {
        int row = done;
        int column = 0;
        double most = 0.0;
        for (int k = columns - 1; k >= 0 && !(most > 0.3); k--) {
            for (int i = done; i < count; i++) {
                if (fabs(basis[i * columns + k]) > most) {
                    most = fabs(basis[i * columns + k]);
                    row = i;
                    column = k;
                }
            }
        }
        for (int k = 0; k < columns; k++) {
            const double swap = basis[row * columns + k];
            basis[row * columns + k] = basis[done * columns + k];
            basis[done * columns + k] = swap;
        }
        const double by = basis[done * columns + column];
        for (int k = 0; k < columns; k++) {
            basis[done * columns + k] /= by;
        }
        for (int i = 0; i < count; i++) {
            const double part = basis[i * columns + column];
            for (int k = 0; k < columns && i != done; k++) {
                basis[i * columns + k] -= part * basis[done * columns + k];
            }
        }
    }
    for (int i = 0; i < count * columns; i++) {
        basis[i] = fabs(basis[i]) > NULL_SPACE_ROUNDING ? basis[i] : 0.0;
    }
}
