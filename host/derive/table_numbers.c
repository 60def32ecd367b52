/* table_numbers.c: see table_numbers.h.
 *
 * A table's pieces meet at knots half a cell from the cells' middles. Through the function's values there, straight
 * pieces would be off by h^2/8 f'', and by h^2/12 f'' on the mean; cubic ones, with its slopes, by h^4/384 f'''' and
 * h^4/720 f''''. Always to one side: a mechanism that turns and turns would sum that up. So the knots are moved by that
 * mean (taken from the differences between knots): nothing is left of it, and the worst is a third and a half less.
 */
#include "table_numbers.h"

#include <math.h>
#include <stdlib.h>

#include "core/table.h"
#include "host/base/room.h"
#include "turn_function.h"

/* The knot `at`, of 2^bits on a ring. */
static double knot(const double *of, int cells, int at) { return of[at & (cells - 1)]; }

static double second_difference(const double *of, int n, int i) {
    return (knot(of, n, i - 1) + knot(of, n, i + 1)) - 2.0 * of[i];
}

static double fourth_difference(const double *of, int n, int i) {
    return (knot(of, n, i - 2) + knot(of, n, i + 2)) -
           4.0 * (knot(of, n, i - 1) + knot(of, n, i + 1)) + 6.0 * of[i];
}

/* Cell i of the table, between knots i and i + 1. */
static void write_linear(const double *value, int n, int i, double *number) {
    const double left = value[i] - second_difference(value, n, i) / 12.0;
    const int next = (i + 1) & (n - 1);
    const double right = value[next] - second_difference(value, n, next) / 12.0;
    number[0] = 0.5 * (left + right);
    number[1] = right - left;
}

static void write_cubic(const double *value, const double *slope, int n, int i, double *number) {
    double knots[2];
    double slopes[2];
    for (int k = 0; k < 2; k++) {
        const int at = (i + k) & (n - 1);
        knots[k] = value[at] + fourth_difference(value, n, at) / 720.0;
        slopes[k] = slope[at] + fourth_difference(slope, n, at) / 720.0;
    }
    const double rise = knots[1] - knots[0];
    const double both = slopes[0] + slopes[1];
    number[2] = 0.5 * (slopes[1] - slopes[0]);
    number[3] = both - 2.0 * rise;
    number[0] = 0.5 * (knots[0] + knots[1]) - 0.25 * number[2];
    number[1] = rise - 0.25 * number[3];
}

/* Is table k the same, or the opposite, when the angle turns the other way? To the bit. */
static bool mirrors(const tape_tables *of, int k, bool odd) {
    const int n = 1 << of->bits;
    for (int i = 0; i <= n / 2; i++) {
        const double *here = &of->number[(i * of->count + k) * of->terms];
        const double *there = &of->number[(((n - i) & (n - 1)) * of->count + k) * of->terms];
        for (int c = 0; c < of->terms; c++) {
            const bool opposite = (c % 2 != 0) != odd;
            if (here[c] != (opposite ? -there[c] : there[c])) {
                return false;
            }
        }
    }
    return true;
}

static void find_mirrors(tape_tables *of) {
    of->folds = true;
    for (int k = 0; k < of->count; k++) {
        of->odd[k] = mirrors(of, k, true);
        of->folds = of->folds && (of->odd[k] || mirrors(of, k, false));
    }
}

/* How far off its function each table is, at `TRIED` places a cell, its middle and its knots among them: there, or
 * nearly, the worst ones are. */
static void measure(const table_functions *f, tape_tables *of) {
    enum { TRIED = 16 };
    const tape *c = f->list;
    const int n = 1 << of->bits;
    turn_value *all = room(c->count, sizeof *all);
    for (int i = 0; i < n * TRIED; i++) {
        const double y = (double)(i % TRIED) / TRIED - 0.5;
        const int cell = i / TRIED;
        turn_evaluate(c, f->multiple, (cell + y) / n, all);
        for (int k = 0; k < of->count; k++) {
            const double *number = &of->number[(cell * of->count + k) * of->terms];
            double value = 0.0;
            for (int term = of->terms - 1; term >= 0; term--) {
                value = number[term] + y * value;
            }
            const double exact = all[f->function[k]].value;
            of->size[k] = number_most(of->size[k], fabs(exact));
            of->off[k] = number_most(of->off[k], fabs(value - exact));
        }
    }
    free(all);
}

void table_numbers(const table_functions *f, tape_tables *into) {
    const tape *c = f->list;
    const int n = 1 << into->bits;
    turn_value *all = room(c->count, sizeof *all);
    double *value = room((int64_t)into->count * n, sizeof *value);
    double *slope = room((int64_t)into->count * n, sizeof *slope);
    for (int i = 0; i < n; i++) {
        turn_evaluate(c, f->multiple, (i - 0.5) / n, all);
        for (int k = 0; k < into->count; k++) {
            value[k * n + i] = all[f->function[k]].value;
            slope[k * n + i] = all[f->function[k]].slope / n;
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < into->count; k++) {
            double *number = &into->number[(i * into->count + k) * into->terms];
            if (into->terms == WH_TABLE_LINEAR) {
                write_linear(&value[k * n], n, i, number);
            } else {
                write_cubic(&value[k * n], &slope[k * n], n, i, number);
            }
            for (int term = 0; term < into->terms; term++) {
                number[term] = number[term] == 0.0 ? 0.0 : number[term]; /* one zero */
            }
        }
    }
    find_mirrors(into);
    measure(f, into);
    free(all);
    free(value);
    free(slope);
}
