/* normal.c: linear least squares, row by row. */
#include "normal.h"

#include "core/root.h"

#define N WH_NORMAL_UNKNOWNS

void wh_normal_start(wh_normal *normal, const wh_real guess[N]) {
    for (unsigned i = 0; i < N; i++) {
        for (unsigned j = 0; j < N; j++) {
            normal->matrix[i][j] = i == j ? WH_R(1.0) : WH_R(0.0);
        }
        normal->right[i] = guess[i];
    }
    normal->misfit = WH_R(0.0);
}

void wh_normal_add(wh_normal *normal, const wh_real row[N], wh_real off, wh_real weight) {
    for (unsigned i = 0; i < N; i++) {
        const wh_real weighted = weight * row[i];
        normal->right[i] += weighted * off;
        for (unsigned j = 0; j <= i; j++) {
            normal->matrix[i][j] += weighted * row[j];
        }
    }
    normal->misfit += weight * off * off;
}

/* Round-off of a diagonal's prior 1 after the rows have made it large. */
#define PIVOT_LEAST WH_R(1e-3)

void wh_normal_factor(wh_normal *normal) {
    wh_real(*m)[N] = normal->matrix;
    for (unsigned j = 0; j < N; j++) {
        for (unsigned i = j; i < N; i++) {
            wh_real sum = m[i][j];
            for (unsigned k = 0; k < j; k++) {
                sum -= m[i][k] * m[j][k];
            }
            m[i][j] = i != j ? sum / m[j][j] : WH_SQRT(sum > PIVOT_LEAST ? sum : PIVOT_LEAST);
        }
    }
}

/* y becomes L^-1 y; before `from` it is zero. */
static WH_CALLED void forward(const wh_normal *normal, wh_real y[N], unsigned from) {
    for (unsigned i = from; i < N; i++) {
        for (unsigned k = from; k < i; k++) {
            y[i] -= normal->matrix[i][k] * y[k];
        }
        y[i] /= normal->matrix[i][i];
    }
}

void wh_normal_solve(wh_normal *normal) {
    wh_real *y = normal->right;
    forward(normal, y, 0);
    for (unsigned i = N; i-- > 0;) {
        for (unsigned k = i + 1U; k < N; k++) {
            y[i] -= normal->matrix[k][i] * y[k];
        }
        y[i] /= normal->matrix[i][i];
    }
}

/* The inverse's diagonal: the square of L^-1 times the unit vector. */
wh_real wh_normal_deviation(const wh_normal *normal, unsigned which) {
    wh_real y[N] = {WH_R(0.0)};
    wh_real sum = WH_R(0.0);
    y[which] = WH_R(1.0);
    forward(normal, y, which);
    for (unsigned i = which; i < N; i++) {
        sum += y[i] * y[i];
    }
    return WH_SQRT(sum);
}
