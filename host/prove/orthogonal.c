/* orthogonal.c: see orthogonal.h. */
#include "orthogonal.h"

#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* The columns of `of` into a[n * n], the one that makes the box longest first. */
static void sorted(int n, const double *of, const double *radii, double *a) {
    bool *taken = room(n, sizeof *taken);
    for (int c = 0; c < n; c++) {
        int best = -1;
        double longest = -1.0;
        for (int j = 0; j < n; j++) {
            double length = 0.0;
            for (int i = 0; i < n; i++) {
                length += of[i * n + j] * of[i * n + j];
            }
            length *= radii[j] * radii[j];
            if (!taken[j] && length > longest) {
                longest = length;
                best = j;
            }
        }
        best = best >= 0 ? best : c; /* only what is no number gets here */
        taken[best] = true;
        for (int i = 0; i < n; i++) {
            a[i * n + c] = of[i * n + best];
        }
    }
    free(taken);
}

/* Reflects columns `from` on of m by v[n], which acts on rows k on. */
static void reflect(int n, double *m, const double *v, int k, int from) {
    double norm = 0.0;
    for (int i = k; i < n; i++) {
        norm += v[i] * v[i];
    }
    for (int j = from; j < n && norm > 0.0; j++) {
        double sum = 0.0;
        for (int i = k; i < n; i++) {
            sum += v[i] * m[i * n + j];
        }
        for (int i = k; i < n; i++) {
            m[i * n + j] -= 2.0 * sum / norm * v[i];
        }
    }
}

void orthogonal_axes(int n, const double *of, const double *radii, double *axes) {
    double *a = room((int64_t)n * n, sizeof *a);
    double *v = room((int64_t)n * n, sizeof *v); /* a row for each reflection */
    sorted(n, of, radii, a);
    for (int k = 0; k < n; k++) {
        double norm = 0.0;
        for (int i = k; i < n; i++) {
            v[k * n + i] = a[i * n + k];
            norm += a[i * n + k] * a[i * n + k];
        }
        norm = number_root(norm);
        v[k * n + k] += v[k * n + k] < 0.0 ? -norm : norm;
        reflect(n, a, &v[k * n], k, k);
    }
    for (int i = 0; i < n * n; i++) {
        axes[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    }
    for (int k = n - 1; k >= 0; k--) {
        reflect(n, axes, &v[k * n], k, 0);
    }
    free(a);
    free(v);
}

void frame_apply(int n, const enclosure *a, const enclosure *x, enclosure *to) {
    for (int i = 0; i < n; i++) {
        enclosure sum = enclosure_of(0.0);
        for (int k = 0; k < n; k++) {
            sum = enclosure_add(sum, enclosure_mul(a[i * n + k], x[k]));
        }
        to[i] = sum;
    }
}

/* The largest sum of sizes in a row of I - A^T A. */
static double off_orthogonal(int n, const double *axes) {
    double most = 0.0;
    for (int i = 0; i < n; i++) {
        double row = 0.0;
        for (int j = 0; j < n; j++) {
            enclosure sum = enclosure_of(i == j ? -1.0 : 0.0);
            for (int k = 0; k < n; k++) {
                sum = enclosure_add(sum, enclosure_mul(enclosure_of(axes[k * n + i]),
                                                       enclosure_of(axes[k * n + j])));
            }
            row = enclosure_above(row + enclosure_size(sum));
        }
        most = row > most || !(row - row == 0.0) ? row : most;
    }
    return most;
}

/* A^-1 = (I - E)^-1 A^T with E = I - A^T A, and (I - E)^-1 is off I by at most |E| / (1 - |E|) in the row norm. */
bool orthogonal_inverse(int n, const double *axes, enclosure *inverse) {
    const double e = off_orthogonal(n, axes);
    if (!(e < 0.25)) {
        return false;
    }
    const double off = enclosure_above(e / enclosure_below(1.0 - e));
    for (int j = 0; j < n; j++) {
        double most = 0.0;
        for (int i = 0; i < n; i++) {
            const double size = axes[j * n + i] < 0.0 ? -axes[j * n + i] : axes[j * n + i];
            most = enclosure_larger(most, size);
        }
        const double wide = enclosure_above(off * most);
        for (int i = 0; i < n; i++) {
            inverse[i * n + j] =
                enclosure_add(enclosure_of(axes[j * n + i]), (enclosure){-wide, wide});
        }
    }
    return true;
}
