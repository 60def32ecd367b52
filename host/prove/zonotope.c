/* zonotope.c: linear maps of zonotopes, and their reduction. */
#include "host/prove/zonotope.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

/* === orthogonal =============================================================================== */
/* Axes for a box that turns with the motion. They are nearly orthogonal, so enclosing a turned box in a new one along
 * them costs little (Lohner, Enclosing the solutions of ordinary initial and boundary value problems, 1987). */

/* The columns of `of` into a[n * n], by their contribution to the box, longest first. */
static void sorted(int n, const double *of, const double *radii, double *a) {
    bool *taken = alloc(n, sizeof *taken);
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
        best = best >= 0 ? best : c; /* only NaN reaches this */
        taken[best] = true;
        for (int i = 0; i < n; i++) {
            a[i * n + c] = of[i * n + best];
        }
    }
    free(taken);
}

/* Apply the reflection by v[n], on rows k on, to columns `from` on of m. */
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

/* axes[n * n], a column each: the columns of `of`, orthogonalized in order of their length times radii[n]
 * (Householder's reflections). Doubles suffice: their round-off can only widen the result. */
static void orthogonal_axes(int n, const double *of, const double *radii, double *axes) {
    double *a = alloc((int64_t)n * n, sizeof *a);
    double *v = alloc((int64_t)n * n, sizeof *v); /* a row for each reflection */
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

/* to[n] = a x. */
static void frame_apply(int n, const enclosure *a, const enclosure *x, enclosure *to) {
    for (int i = 0; i < n; i++) {
        enclosure sum = enclosure_of(0.0);
        for (int k = 0; k < n; k++) {
            sum = enclosure_add(sum, enclosure_mul(a[i * n + k], x[k]));
        }
        to[i] = sum;
    }
}

/* The largest absolute row sum of I - A^T A. */
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

/* inverse[n * n]: an enclosure of the inverse of `axes`. False if they are too far from orthogonal. A^-1 = (I - E)^-1
 * A^T with E = I - A^T A. In the row norm, (I - E)^-1 differs from I by at most |E| / (1 - |E|). */
static bool orthogonal_inverse(int n, const double *axes, enclosure *inverse) {
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

/* === the zonotope ============================================================================= */

zonotope *zonotope_new(int n, int most) {
    zonotope *z = alloc(1, sizeof *z);
    z->n = n;
    z->most = most > 4 * n ? most : 4 * n;
    z->drift = alloc(n, sizeof *z->drift);
    z->generator = alloc((int64_t)z->most * n, sizeof *z->generator);
    return z;
}

void zonotope_free(zonotope *z) {
    if (z != NULL) {
        free(z->drift);
        free(z->generator);
        free(z);
    }
}

static double size_of(double x) { return x < 0.0 ? -x : x; }

/* The sum of absolute values, rounded up. */
static double sum_up(double a, double b) { return b == 0.0 ? a : enclosure_above(a + b); }

void zonotope_box(const zonotope *z, enclosure *box) {
    for (int i = 0; i < z->n; i++) {
        double radius = 0.0;
        for (int k = 0; k < z->count; k++) {
            radius = sum_up(radius, size_of(z->generator[k * z->n + i]));
        }
        box[i] = enclosure_add(enclosure_of(z->drift[i]), (enclosure){-radius, radius});
    }
}

/* --- along axes -----------------------------------------------------------------------------------------*/

/* The n longest generators as columns; unit axes fill missing ones. */
static void longest(const zonotope *z, double *columns, double *radii) {
    const int n = z->n;
    double *length = alloc(n, sizeof *length);
    for (int i = 0; i < n * n; i++) {
        columns[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    }
    for (int k = 0; k < z->count; k++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++) {
            sum += z->generator[k * n + i] * z->generator[k * n + i];
        }
        int least = 0;
        for (int j = 1; j < n; j++) {
            least = length[j] < length[least] ? j : least;
        }
        if (sum > length[least]) {
            length[least] = sum;
            for (int i = 0; i < n; i++) {
                columns[i * n + least] = z->generator[k * n + i];
            }
        }
    }
    for (int j = 0; j < n; j++) {
        radii[j] = length[j] > 0.0 ? 1.0 : 1e-300;
    }
    free(length);
}

/* The extent of generators `from` on along each row of the inverse axes. */
static void reach(const zonotope *z, const enclosure *inverse, int from, double *radius) {
    const int n = z->n;
    for (int i = 0; i < n; i++) {
        radius[i] = 0.0;
        for (int k = from; k < z->count; k++) {
            enclosure sum = enclosure_of(0.0);
            for (int j = 0; j < n; j++) {
                const double g = z->generator[k * n + j];
                sum = enclosure_add(sum, enclosure_times(inverse[i * n + j], g));
            }
            radius[i] = sum_up(radius[i], enclosure_size(sum));
        }
    }
}

/* Axes and their inverse; if those of the generators are unsuitable, the unit axes. */
static void find_axes(const zonotope *z, double *axes, enclosure *inverse) {
    const int n = z->n;
    double *columns = alloc((int64_t)n * n, sizeof *columns);
    double *radii = alloc(n, sizeof *radii);
    longest(z, columns, radii);
    orthogonal_axes(n, columns, radii, axes);
    if (!orthogonal_inverse(n, axes, inverse)) {
        for (int i = 0; i < n * n; i++) {
            axes[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
            inverse[i] = enclosure_of(axes[i]);
        }
    }
    free(columns);
    free(radii);
}

void zonotope_frame(const zonotope *z, double *axes, enclosure *off) {
    const int n = z->n;
    enclosure *inverse = alloc((int64_t)n * n, sizeof *inverse);
    enclosure *drift = alloc(n, sizeof *drift);
    double *radius = alloc(n, sizeof *radius);
    find_axes(z, axes, inverse);
    reach(z, inverse, 0, radius);
    for (int i = 0; i < n; i++) {
        drift[i] = enclosure_of(z->drift[i]);
    }
    frame_apply(n, inverse, drift, off);
    for (int i = 0; i < n; i++) {
        off[i] = enclosure_add(off[i], (enclosure){-radius[i], radius[i]});
    }
    free(inverse);
    free(drift);
    free(radius);
}

/* --- fewer ---------------------------------------------------------------------------------------------*/

typedef struct ranked {
    double size;
    int which;
} ranked;

static int by_size(const void *a, const void *b) {
    const ranked *x = a;
    const ranked *y = b;
    return x->size > y->size ? -1 : x->size < y->size ? 1 : x->which - y->which;
}

static void sort_by_size(zonotope *z) {
    const int n = z->n;
    ranked *order = alloc(z->count, sizeof *order);
    double *sorted = alloc((int64_t)z->count * n, sizeof *sorted);
    for (int k = 0; k < z->count; k++) {
        order[k].which = k;
        for (int i = 0; i < n; i++) {
            order[k].size += size_of(z->generator[k * n + i]);
        }
    }
    qsort(order, (size_t)z->count, sizeof *order, by_size);
    for (int k = 0; k < z->count; k++) {
        memcpy(&sorted[k * n], &z->generator[order[k].which * n], (size_t)n * sizeof *sorted);
    }
    memcpy(z->generator, sorted, (size_t)z->count * (size_t)n * sizeof *sorted);
    free(order);
    free(sorted);
}

/* The smaller half becomes one box along axes. The rounding of its corners is added to noise[n]. */
static void reduce(zonotope *z, double *noise) {
    const int n = z->n;
    double *axes = alloc((int64_t)n * n, sizeof *axes);
    enclosure *inverse = alloc((int64_t)n * n, sizeof *inverse);
    double *radius = alloc(n, sizeof *radius);
    sort_by_size(z);
    find_axes(z, axes, inverse);
    const int kept = z->most / 2;
    reach(z, inverse, kept, radius);
    z->count = kept;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            const enclosure corner = enclosure_times(enclosure_of(axes[i * n + j]), radius[j]);
            z->generator[z->count * n + i] = enclosure_middle(corner);
            noise[i] = sum_up(noise[i], enclosure_radius(corner));
        }
        z->count++;
    }
    free(axes);
    free(inverse);
    free(radius);
}

/* --- mapped --------------------------------------------------------------------------------------------*/

/* vector[n] becomes the centre of map vector + more (NULL: nothing); its error is added to noise[n]. to[n] is scratch. */
static void map_vector(int n, const enclosure *map, double *vector, const enclosure *more,
                       enclosure *to, double *noise) {
    for (int i = 0; i < n; i++) {
        to[i] = more != NULL ? more[i] : enclosure_of(0.0);
        for (int j = 0; j < n; j++) {
            if (vector[j] != 0.0) {
                to[i] = enclosure_add(to[i], enclosure_times(map[i * n + j], vector[j]));
            }
        }
    }
    for (int i = 0; i < n; i++) {
        vector[i] = enclosure_middle(to[i]);
        noise[i] = sum_up(noise[i], enclosure_radius(to[i]));
    }
}

void zonotope_map(zonotope *z, const enclosure *map, const enclosure *more) {
    const int n = z->n;
    double *noise = alloc(n, sizeof *noise);
    enclosure *to = alloc(n, sizeof *to);
    map_vector(n, map, z->drift, more, to, noise);
    for (int k = 0; k < z->count; k++) {
        map_vector(n, map, &z->generator[k * n], NULL, to, noise);
    }
    if (z->count + 2 * n > z->most) {
        reduce(z, noise);
    }
    for (int i = 0; i < n; i++) {
        double *made = &z->generator[z->count * n];
        memset(made, 0, (size_t)n * sizeof *made);
        made[i] = noise[i];
        z->count += noise[i] != 0.0 ? 1 : 0;
    }
    free(noise);
    free(to);
}
