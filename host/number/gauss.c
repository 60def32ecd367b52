#include "gauss.h"

#include <math.h>

/* Subtracts a multiple of row `of` from `row`, so that the entry of `row` in the pivot's column becomes 0. */
static void clear(double *row, const double *of, int columns, int pivot) {
    const double part = row[pivot] / of[pivot];
    for (int k = 0; k < columns && part != 0.0; k++) {
        row[k] -= part * of[k];
    }
    row[pivot] = 0.0;
}

int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead) {
    int rank = 0;
    for (int step = 0; step < pivots && rank < rows; step++) {
        int row = rank;
        int column = step;
        for (int i = rank; i < rows; i++) {
            for (int k = full ? 0 : step; k < (full ? pivots : step + 1); k++) {
                if (fabs(m[i * columns + k]) > fabs(m[row * columns + column])) {
                    row = i;
                    column = k;
                }
            }
        }
        if (!(fabs(m[row * columns + column]) > zero)) {
            continue;
        }
        for (int k = 0; k < columns && row != rank; k++) {
            const double kept = m[rank * columns + k];
            m[rank * columns + k] = m[row * columns + k];
            m[row * columns + k] = kept;
        }
        for (int i = 0; i < rows; i++) {
            if (i != rank) {
                clear(m + i * columns, m + rank * columns, columns, column);
            }
        }
        lead[rank++] = column;
    }
    return rank;
}

void gauss_pivots(double *m, int n) {
    for (int c = 0; c < n; c++) {
        for (int i = c + 1; i < n && m[c * n + c] != 0.0; i++) {
            clear(m + i * n, m + c * n, n, c);
        }
    }
}
