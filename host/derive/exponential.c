/* exponential.c: scaling, a series, squaring. */
#include "exponential.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* Each halving of the step costs a squaring, and each squaring up to one of the 104 bits: 50 leave a double its digits. */
enum { HALVINGS_MOST = 50 };

/* Powers of a matrix of norm 1/2 and below leave 2^-110 of it behind after so many. */
enum { POWERS = 26 };

/* to = a[states * states of its columns] b, for b of as many columns as `to`. */
static void product(const twofold *a, const twofold *b, int states, int columns, twofold *to) {
    for (int i = 0; i < states; i++) {
        for (int k = 0; k < columns; k++) {
            twofold sum = twofold_of(0.0);
            for (int j = 0; j < states; j++) {
                sum = twofold_add(sum, twofold_mul(a[i * columns + j], b[j * columns + k]));
            }
            to[i * columns + k] = sum;
        }
    }
}

void exponential_series(twofold *step, int states, int columns, int order) {
    const int count = states * columns;
    twofold *power = room(count, sizeof *power);
    twofold *next = room(count, sizeof *next);
    twofold *of = room(count, sizeof *of);
    memcpy(of, step, (size_t)count * sizeof *of);
    memcpy(power, step, (size_t)count * sizeof *power);
    for (int k = 2; k <= order; k++) {
        product(of, power, states, columns, next);
        for (int i = 0; i < count; i++) {
            power[i] = twofold_div(next[i], twofold_of((double)k));
            step[i] = twofold_add(step[i], power[i]);
        }
    }
    free(power);
    free(next);
    free(of);
}

/* Largest sum of sizes of a row. */
static double norm(const twofold *a, int states, int columns) {
    double most = 0.0;
    for (int i = 0; i < states; i++) {
        double sum = 0.0;
        for (int j = 0; j < states; j++) {
            sum += fabs(a[i * columns + j].high);
        }
        most = sum > most || isnan(sum) ? sum : most;
    }
    return most;
}

/* Sum of the sizes of row i (step 1) or of column i of A, without the diagonal. */
static double off_diagonal(const twofold *a, int i, bool row, int states, int columns) {
    double sum = 0.0;
    for (int j = 0; j < states; j++) {
        sum += j == i ? 0.0 : fabs(a[row ? i * columns + j : j * columns + i].high);
    }
    return sum;
}

/* State i in units `by` times as large. */
static void in_units(twofold *a, int i, double by, int states, int columns) {
    for (int j = 0; j < columns; j++) {
        a[i * columns + j] = twofold_scale(a[i * columns + j], 1.0 / by);
    }
    for (int j = 0; j < states; j++) {
        a[j * columns + i] = twofold_scale(a[j * columns + i], by);
    }
}

/* Units, powers of two, in which rows and columns of A are of a size (Parlett & Reinsch, Numerische Mathematik 13 (1969)
 * 293): a stiffness of 1e9 N/m beside a rate of 1e-3 m/s would else want many halvings. */
static void balance(twofold *a, double *unit, int states, int columns) {
    for (int i = 0; i < states; i++) {
        unit[i] = 1.0;
    }
    for (int round = 0; round < 20; round++) {
        for (int i = 0; i < states; i++) {
            const double row = off_diagonal(a, i, true, states, columns);
            const double column = off_diagonal(a, i, false, states, columns);
            double by = 1.0;
            while (row > 0.0 && column > 0.0 && column * by * 2.0 <= row / by) {
                by *= 2.0;
            }
            while (row > 0.0 && column > 0.0 && row / by * 2.0 <= column * by) {
                by /= 2.0;
            }
            in_units(a, i, by, states, columns);
            unit[i] *= by;
        }
    }
}

/* What of the states is below this part of the largest of its row, in balanced units, is beyond the digits that were kept:
 * the last of twenty masses in a row has a part of 1e-60 in what the first one does within a millisecond, and no float. */
#define LEAST_PART 0x1p-100

static void drop_least(twofold *step, int states, int columns) {
    for (int i = 0; i < states; i++) {
        double most = 0.0;
        for (int j = 0; j < states; j++) {
            const double size = fabs(step[i * columns + j].high);
            most = size > most ? size : most;
        }
        for (int j = 0; j < states; j++) {
            if (fabs(step[i * columns + j].high) < LEAST_PART * most) {
                step[i * columns + j] = twofold_of(0.0);
            }
        }
    }
}

bool exponential_exact(twofold *step, int states, int columns) {
    const int count = states * columns;
    double *unit = room(states, sizeof *unit);
    twofold *square = room(count, sizeof *square);
    int halvings = 0;
    balance(step, unit, states, columns);
    double size = norm(step, states, columns);
    for (; halvings < HALVINGS_MOST && size > 0.5; halvings++) {
        size /= 2.0;
    }
    bool good = size <= 0.5;
    for (int i = 0; i < count; i++) {
        step[i] = twofold_scale(step[i], number_scaled(1.0, -halvings));
    }
    exponential_series(step, states, columns, POWERS);
    for (; halvings > 0 && good; halvings--) { /* (1 + E)^2 = 1 + 2 E + E^2 */
        product(step, step, states, columns, square);
        for (int i = 0; i < count; i++) {
            step[i] = twofold_add(twofold_scale(step[i], 2.0), square[i]);
        }
    }
    drop_least(step, states, columns);
    for (int i = 0; i < states; i++) {
        in_units(step, i, 1.0 / unit[i], states, columns);
    }
    for (int i = 0; i < count; i++) {
        good = good && twofold_is_finite(step[i]);
    }
    free(unit);
    free(square);
    return good;
}
