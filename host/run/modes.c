/* modes.c: see modes.h. */
#include "modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

typedef complex_number cn;

#define ROUNDING 0x1p-52
/* What is left of A x - value x beyond this part of its terms is no rounding. (That is 1e-12 of them, and up to 1e-5 of an
 * eigenvalue that is 1e11 times smaller than the largest.) */
#define VECTOR_OFF 1e-2
#define SWEEPS_A_VALUE 60
#define TURNS_OF_BALANCE 30

static cn plus(cn a, cn b) { return (cn){a.re + b.re, a.im + b.im}; }
static cn minus(cn a, cn b) { return (cn){a.re - b.re, a.im - b.im}; }
static cn times(cn a, cn b) { return (cn){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
static cn mirrored(cn a) { return (cn){a.re, -a.im}; }
static cn scaled(cn a, double by) { return (cn){a.re * by, a.im * by}; }

double complex_size(cn z) {
    const double most = number_most(fabs(z.re), fabs(z.im));
    if (!(most > 0.0) || !isfinite(most)) {
        return most;
    }
    const double re = z.re / most;
    const double im = z.im / most;
    return most * number_root(re * re + im * im);
}

cn complex_plus_times(cn a, cn b, cn c) {
    return (cn){a.re + b.re * c.re - b.im * c.im, a.im + b.re * c.im + b.im * c.re};
}

cn complex_over(cn a, cn b) {
    const double size = complex_size(b);
    return scaled(times(a, scaled(mirrored(b), 1.0 / size)), 1.0 / size);
}

cn complex_root(cn z) {
    const double more = number_root(0.5 * (complex_size(z) + fabs(z.re)));
    const double less = more > 0.0 ? 0.5 * fabs(z.im) / more : 0.0;
    const double re = z.re < 0.0 ? less : more;
    const double im = z.re < 0.0 ? more : less;
    return (cn){re, z.im < 0.0 ? -im : im};
}

/* --- balanced, and in Hessenberg's form ----------------------------------------------------------*/

/* Similar to what it was, by powers of two, its rows and columns of like sizes; scale[n] as they were multiplied. */
static void balance(int n, double *a, double *scale) {
    bool again = true;
    for (int i = 0; i < n; i++) {
        scale[i] = 1.0;
    }
    for (int turn = 0; turn < TURNS_OF_BALANCE && again; turn++) {
        again = false;
        for (int i = 0; i < n; i++) {
            double row = 0.0;
            double column = 0.0;
            for (int j = 0; j < n; j++) {
                row += j != i ? fabs(a[i * n + j]) : 0.0;
                column += j != i ? fabs(a[j * n + i]) : 0.0;
            }
            if (!(row > 0.0) || !(column > 0.0)) {
                continue;
            }
            int row_2;
            int column_2;
            number_split(row, &row_2);
            number_split(column, &column_2);
            const int by = (row_2 - column_2) / 2;
            if (by != 0) {
                again = true;
                scale[i] = number_scaled(scale[i], by);
                for (int j = 0; j < n; j++) {
                    a[i * n + j] = number_scaled(a[i * n + j], -by);
                    a[j * n + i] = number_scaled(a[j * n + i], by);
                }
            }
        }
    }
}

static void swap_rows_and_columns(int n, double *a, int i, int k) {
    for (int j = 0; j < n; j++) {
        const double kept = a[i * n + j];
        a[i * n + j] = a[k * n + j];
        a[k * n + j] = kept;
    }
    for (int j = 0; j < n; j++) {
        const double kept = a[j * n + i];
        a[j * n + i] = a[j * n + k];
        a[j * n + k] = kept;
    }
}

static void hessenberg(int n, double *a) {
    for (int c = 0; c + 2 < n; c++) {
        int pivot = c + 1;
        for (int i = c + 2; i < n; i++) {
            pivot = fabs(a[i * n + c]) > fabs(a[pivot * n + c]) ? i : pivot;
        }
        if (a[pivot * n + c] == 0.0) {
            continue;
        }
        if (pivot != c + 1) {
            swap_rows_and_columns(n, a, pivot, c + 1);
        }
        for (int i = c + 2; i < n; i++) {
            const double factor = a[i * n + c] / a[(c + 1) * n + c];
            for (int j = 0; j < n && factor != 0.0; j++) {
                a[i * n + j] -= factor * a[(c + 1) * n + j];
            }
            for (int j = 0; j < n && factor != 0.0; j++) {
                a[j * n + c + 1] += factor * a[j * n + i];
            }
            a[i * n + c] = 0.0;
        }
    }
}

/* --- QR steps ----------------------------------------------------------------------------------------*/

/* The eigenvalue of the last 2 x 2 of the block that is nearer to its corner. */
static cn wilkinson(const cn *h, int n, int last) {
    const cn a = h[(last - 1) * n + last - 1];
    const cn b = h[(last - 1) * n + last];
    const cn c = h[last * n + last - 1];
    const cn d = h[last * n + last];
    const cn half = scaled(minus(a, d), 0.5);
    const cn off = complex_root(plus(times(half, half), times(b, c)));
    const cn middle = scaled(plus(a, d), 0.5);
    const cn one = plus(middle, off);
    const cn two = minus(middle, off);
    return complex_size(minus(one, d)) < complex_size(minus(two, d)) ? one : two;
}

/* One QR step of rows first..last: rotations from the left make it upper triangular, the same from the right go back. */
static void qr_step(cn *h, int n, int first, int last, cn shift, cn *turn) {
    for (int i = first; i <= last; i++) {
        h[i * n + i] = minus(h[i * n + i], shift);
    }
    for (int i = first; i < last; i++) {
        const cn a = h[i * n + i];
        const cn b = h[(i + 1) * n + i];
        const double sizes[2] = {complex_size(a), complex_size(b)};
        const double size = complex_size((cn){sizes[0], sizes[1]});
        const cn c = size > 0.0 ? scaled(a, 1.0 / size) : (cn){1.0, 0.0};
        const cn s = size > 0.0 ? scaled(b, 1.0 / size) : (cn){0.0, 0.0};
        turn[2 * i] = c;
        turn[2 * i + 1] = s;
        for (int j = i; j <= last; j++) {
            const cn up = h[i * n + j];
            const cn down = h[(i + 1) * n + j];
            h[i * n + j] = plus(times(mirrored(c), up), times(mirrored(s), down));
            h[(i + 1) * n + j] = minus(times(c, down), times(s, up));
        }
    }
    for (int i = first; i < last; i++) {
        const cn c = turn[2 * i];
        const cn s = turn[2 * i + 1];
        for (int j = first; j <= (i + 1 < last ? i + 1 : last); j++) {
            const cn left = h[j * n + i];
            const cn right = h[j * n + i + 1];
            h[j * n + i] = plus(times(left, c), times(right, s));
            h[j * n + i + 1] = minus(times(right, mirrored(c)), times(left, mirrored(s)));
        }
    }
    for (int i = first; i <= last; i++) {
        h[i * n + i] = plus(h[i * n + i], shift);
    }
}

/* Where the block that ends at `last` begins: above it there is nothing. */
static int block_begin(const cn *h, int n, int last, double norm) {
    int i = last;
    while (i > 0) {
        const double sizes = complex_size(h[i * n + i]) + complex_size(h[(i - 1) * n + i - 1]);
        const double scale = sizes > 0.0 ? sizes : norm;
        if (complex_size(h[i * n + i - 1]) <= ROUNDING * scale) {
            break;
        }
        i--;
    }
    return i;
}

static bool qr(int n, cn *h, cn *value, double norm) {
    cn *turn = room(2 * (int64_t)n, sizeof *turn);
    int last = n - 1;
    int sweeps = 0;
    while (last >= 0 && sweeps < SWEEPS_A_VALUE) {
        const int first = block_begin(h, n, last, norm);
        if (first == last) {
            value[last] = h[last * n + last];
            last--;
            sweeps = 0;
            continue;
        }
        sweeps++;
        const cn odd = {complex_size(h[last * n + last - 1]) + h[last * n + last].re, 0.0};
        qr_step(h, n, first, last, sweeps % 11 == 0 ? odd : wilkinson(h, n, last), turn);
    }
    free(turn);
    return last < 0;
}

bool modes_values(int n, const double *matrix, cn *value) {
    double *a = room((int64_t)n * n + n, sizeof *a);
    cn *h = room((int64_t)n * n, sizeof *h);
    double norm = 0.0;
    memcpy(a, matrix, (size_t)n * (size_t)n * sizeof *a);
    balance(n, a, a + (ptrdiff_t)n * n);
    hessenberg(n, a);
    for (int i = 0; i < n * n; i++) {
        h[i] = (cn){a[i], 0.0};
        norm += fabs(a[i]);
    }
    const bool found = isfinite(norm) && qr(n, h, value, norm);
    free(a);
    free(h);
    return found;
}

/* --- vectors ---------------------------------------------------------------------------------------------*/

/* Gauss's elimination of a complex system in place, rows exchanged; pivots of nothing count as `least`. */
static void solve(int n, cn *a, cn *x, double least) {
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int i = c + 1; i < n; i++) {
            pivot = complex_size(a[i * n + c]) > complex_size(a[pivot * n + c]) ? i : pivot;
        }
        for (int j = 0; j < n; j++) {
            const cn kept = a[c * n + j];
            a[c * n + j] = a[pivot * n + j];
            a[pivot * n + j] = kept;
        }
        const cn kept = x[c];
        x[c] = x[pivot];
        x[pivot] = kept;
        if (complex_size(a[c * n + c]) < least) {
            a[c * n + c] = (cn){least, 0.0};
        }
        for (int i = c + 1; i < n; i++) {
            const cn factor = complex_over(a[i * n + c], a[c * n + c]);
            for (int j = c; j < n; j++) {
                a[i * n + j] = minus(a[i * n + j], times(factor, a[c * n + j]));
            }
            x[i] = minus(x[i], times(factor, x[c]));
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) {
            x[i] = minus(x[i], times(a[i * n + j], x[j]));
        }
        x[i] = complex_over(x[i], a[i * n + i]);
    }
}

/* x becomes the eigenvector nearest to it, of size one. */
static bool iterate(int n, const double *a, bool transposed, cn value, cn *x, cn *room_of_matrix) {
    double norm = complex_size(value);
    for (int i = 0; i < n * n; i++) {
        norm = number_most(norm, fabs(a[i]));
    }
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                const cn entry = {transposed ? a[j * n + i] : a[i * n + j], 0.0};
                room_of_matrix[i * n + j] = i == j ? minus(entry, value) : entry;
            }
        }
        solve(n, room_of_matrix, x, 8.0 * ROUNDING * norm);
        double size = 0.0;
        for (int i = 0; i < n; i++) {
            size = number_most(size, complex_size(x[i]));
        }
        if (!(size > 0.0) || !isfinite(size)) {
            return false;
        }
        for (int i = 0; i < n; i++) {
            x[i] = scaled(x[i], 1.0 / size);
        }
    }
    return true;
}

/* Does A x come to value x? What x was iterated from may hold nothing of the eigenvectors of this value, not even by
 * rounding, where the matrix falls into parts that do not touch: then x is made of those of others. */
static bool is_vector(int n, const double *a, bool transposed, cn value, const cn *x) {
    double off = 0.0;
    double most = 0.0;
    for (int i = 0; i < n; i++) {
        cn left = times((cn){-value.re, -value.im}, x[i]);
        double sum = complex_size(left);
        for (int j = 0; j < n; j++) {
            const cn term = scaled(x[j], transposed ? a[j * n + i] : a[i * n + j]);
            left = plus(left, term);
            sum += complex_size(term);
        }
        off = number_most(off, complex_size(left));
        most = number_most(most, sum);
    }
    return off <= VECTOR_OFF * most;
}

bool modes_part(int n, const double *matrix, cn value, const double *slope, cn *part, cn *left_of,
                double *share) {
    double *a = room((int64_t)n * n + n, sizeof *a);
    double *scale = a + (ptrdiff_t)n * n;
    cn *h = room((int64_t)n * n + 2 * (int64_t)n, sizeof *h);
    cn *right = h + (ptrdiff_t)n * n;
    cn *left = right + n;
    memcpy(a, matrix, (size_t)n * (size_t)n * sizeof *a);
    balance(n, a, scale);
    for (int i = 0; i < n; i++) {
        right[i] = (cn){slope[i] / scale[i], 0.0};
    }
    bool told = iterate(n, a, false, value, right, h) && is_vector(n, a, false, value, right);
    for (int i = 0; i < n; i++) {
        left[i] = mirrored(right[i]);
    }
    told = told && iterate(n, a, true, value, left, h) && is_vector(n, a, true, value, left);
    cn both = {0.0, 0.0};
    cn along = {0.0, 0.0};
    double shares = 0.0;
    for (int i = 0; i < n; i++) {
        both = plus(both, times(left[i], right[i]));
        along = plus(along, scaled(left[i], slope[i] / scale[i]));
        share[i] = complex_size(times(left[i], right[i]));
        shares += share[i];
    }
    told = told && complex_size(both) > 1e-9;
    for (int i = 0; i < n; i++) {
        share[i] = told ? share[i] / shares : 0.0;
        left_of[i] = told ? scaled(left[i], 1.0 / scale[i]) : (cn){0.0, 0.0};
        part[i] =
            told ? scaled(times(right[i], complex_over(along, both)), scale[i]) : (cn){0.0, 0.0};
    }
    free(a);
    free(h);
    return told;
}
