/* rank.c: scaling, then elimination with full pivoting. */
#include "rank.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/number/gauss.h"

/* Passes over rows and columns; each halves the error of the logarithms of the scales. */
#define PASSES 16
/* Part of the scaled size below which a pivot is round-off, even with exact entries: about four times the
 * algebra's threshold of zero in a sum. */
#define NO_PIVOT 4e-14

/* The power of two next to 1/sqrt(x); 1 for zero. */
static double scale_for(double x) {
    int exponent;
    if (!(x > 0.0) || !isfinite(x)) {
        return 1.0;
    }
    (void)number_split(x, &exponent);
    return number_scaled(1.0, -(exponent / 2));
}

static void scale_row(double *m, int n, int i, double by) {
    for (int j = 0; j < n; j++) {
        m[i * n + j] *= by;
    }
}

static void scale_column(double *m, int n, int j, double by) {
    for (int i = 0; i < n; i++) {
        m[i * n + j] *= by;
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

static double largest_of_row(const double *m, int n, int i) {
    double largest = 0.0;
    for (int j = 0; j < n; j++) {
        largest = number_most(largest, fabs(m[i * n + j]));
    }
    return largest;
}

static double largest_of_column(const double *m, int n, int j) {
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
        largest = number_most(largest, fabs(m[i * n + j]));
    }
    return largest;
}

/* Rows are scaled by one pass, columns by the next: roots of the largest, so that neither side decides. */
static void scale_general(double *m, double *error, int n) {
    for (int pass = 0; pass < 2 * PASSES; pass++) {
        for (int i = 0; i < n; i++) {
            const double by =
                scale_for(pass % 2 == 0 ? largest_of_row(m, n, i) : largest_of_column(m, n, i));
            void (*const scale)(double *, int, int, double) =
                pass % 2 == 0 ? scale_row : scale_column;
            scale(m, n, i, by);
            scale(error, n, i, by);
        }
    }
}

static void scale_symmetric(double *m, double *error, int n) {
    for (int i = 0; i < n; i++) {
        const double by = scale_for(m[i * n + i]);
        scale_row(m, n, i, by);
        scale_column(m, n, i, by);
        scale_row(error, n, i, by);
        scale_column(error, n, i, by);
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
