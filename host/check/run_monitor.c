#include "run_monitor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/number/gauss.h"

/* The mass matrix is tested after a step in which a rate changed by this part of its range less or more than its acceleration
 * predicted. That difference must exceed all earlier ones by the same part. */
#define LOOK_AT 0.02
#define LOOK_LARGER 1.1

run_monitor *run_monitor_open(const image *im, const engine_kind *kind) {
    run_monitor *w = alloc(1, sizeof *w);
    w->field = vector_field_open(im, kind);
    const int64_t n = w->field->n;
    const int64_t rows = w->field->rows;
    w->step_s = im->step_s;
    w->low = alloc(5 * n, sizeof *w->low);
    w->high = w->low + n;
    w->slope = w->high + n;
    w->change = w->slope + 2 * n;
    w->mass = alloc(rows * rows + rows, sizeof *w->mass);
    w->most = w->mass + rows * rows;
    w->looks = im->contacts == 0 && im->mass_moves && rows > 0;
    w->singular = (run_monitor_singular){.inertia = 1.0, .component = -1, .near = -1};
    return w;
}

void run_monitor_close(run_monitor *w) {
    if (w != NULL) {
        vector_field_close(w->field);
        free(w->low);
        free(w->mass);
        free(w);
    }
}

static double time_s(const run_monitor *w) { return (double)w->steps * w->step_s; }

/* --- singular places ------------------------------------------------------------------------------------*/

/* The size of each rate, for differences. */
static double *rate_sizes(const run_monitor *w) {
    double *size = alloc(w->field->n, sizeof *size);
    for (int i = 0; i < w->field->n; i++) {
        size[i] = fabs(w->low[i]) + fabs(w->high[i]);
    }
    return size;
}

/* The least pivot of the mass matrix at x, of the largest diagonal entry of its row so far. */
static double least_pivot(run_monitor *w, const double *x, int *row) {
    const int rows = w->field->rows;
    double least = 1.0;
    double *size = rate_sizes(w);
    vector_field_mass(w->field, x, size, w->mass);
    free(size);
    for (int c = 0; c < rows; c++) {
        w->most[c] = number_most(w->most[c], w->mass[c * rows + c]);
    }
    gauss_pivots(w->mass, rows);
    for (int c = 0; c < rows; c++) {
        const double pivot = w->mass[c * rows + c];
        const double part = w->most[c] > 0.0 ? fabs(pivot) / w->most[c] : 1.0;
        if (part < least) {
            least = part;
            *row = c;
        }
    }
    return least;
}

/* The position with the largest influence on the diagonal entry of this row, by a thousandth of its range. */
static int position_near(run_monitor *w, const double *x, int row) {
    const int n = w->field->n;
    const int rows = w->field->rows;
    double *at = alloc(n, sizeof *at);
    double *size = rate_sizes(w);
    double most = 0.0;
    int found = -1;
    memcpy(at, x, (size_t)n * sizeof *at);
    vector_field_mass(w->field, at, size, w->mass);
    const double here = w->mass[row * rows + row];
    for (int i = 0; i < n; i++) {
        if (image_component(w->field->image, i).primes == 0) {
            at[i] = x[i] + 1e-3 * number_least(w->high[i] - w->low[i], 1.0);
            vector_field_mass(w->field, at, size, w->mass);
            const double change = fabs(w->mass[row * rows + row] - here);
            at[i] = x[i];
            if (change > most) {
                most = change;
                found = i;
            }
        }
    }
    free(at);
    free(size);
    return found;
}

static void look(run_monitor *w, const double *x) {
    int row = -1;
    const double inertia = least_pivot(w, x, &row);
    if (inertia < w->singular.inertia) {
        const int near = position_near(w, x, row);
        w->singular = (run_monitor_singular){inertia, w->field->rate[row], time_s(w), near,
                                             near >= 0 ? x[near] : 0.0};
    }
}

/* Did a rate change in the last step less or more than the acceleration at its begin predicts, by a part of its range, and by more
 * than ever before? */
static bool bends_most(run_monitor *w) {
    bool bends = false;
    for (int i = 0; i < w->field->n; i++) {
        const double off = fabs(w->slope[i] - w->slope[w->field->n + i]) * w->step_s;
        if (w->field->next[i] < 0 && off > LOOK_AT * (w->high[i] - w->low[i]) &&
            off > LOOK_LARGER * w->change[i]) {
            w->change[i] = off;
            bends = true;
        }
    }
    return bends;
}

/* The balance has the highest derivatives already. */
static void read_slopes(run_monitor *w, const books *b, const double *x) {
    const int n = w->field->n;
    memcpy(w->slope + n, w->slope, (size_t)n * sizeof *w->slope);
    if (b == NULL) {
        vector_field_slope(w->field, x, w->slope);
        return;
    }
    for (int i = 0; i < n; i++) {
        const int next = w->field->next[i];
        w->slope[i] = next >= 0 ? x[next] : b->value[-1 - next];
    }
}

void run_monitor_enter(run_monitor *w, const engine_kind *kind, const books *b, const void *run) {
    double x[3 * IMAGE_COMPONENTS_MAX];
    w->steps = kind->steps(run);
    kind->state(run, x, x + w->field->image->angles);
    for (int i = 0; i < w->field->n; i++) {
        w->low[i] = w->steps == 0 || x[i] < w->low[i] ? x[i] : w->low[i];
        w->high[i] = w->steps == 0 || x[i] > w->high[i] ? x[i] : w->high[i];
    }
    if (w->looks) {
        int row;
        if ((w->steps & (w->steps - 1U)) == 0) { /* how large the entries are elsewhere */
            (void)least_pivot(w, x, &row);
        }
        read_slopes(w, b, x);
        if (w->steps > 2 && bends_most(w)) {
            look(w, x);
        }
    }
}
