/* look_close.c: see look_close.h. */
#include "look_close.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* Steps of the accurate way in one of the run's, at first, and at most; they agree when the next finer ones do within this. */
#define PARTS_FIRST 4
#define PARTS_MOST 4096
#define LOOK_OPERATIONS 2e8
#define AGREED 1e-5
/* On which so many places are asked for their mass matrix. */
#define INERTIA_PLACES 512

static bool is_rate(const watch *w, int i) {
    return image_component(w->field->image, i).primes > 0;
}

/* --- a close look ------------------------------------------------------------------------------------------*/

/* Of the size of a rate: what changes it by. */
static void rate_sizes(const watch *w, double *size) {
    for (int i = 0; i < w->field->n; i++) {
        size[i] = fabs(w->low[i]) + fabs(w->high[i]);
    }
}

/* The least pivot of the mass matrix at x, of what its diagonal has been at most, and whose it is. */
static double least_pivot(watch *w, const double *x, int *row) {
    const int rows = w->field->rows;
    double least = 1.0;
    double *size = w->scratch + 2 * (ptrdiff_t)w->field->n;
    rate_sizes(w, size);
    field_mass(w->field, x, size, w->mass);
    for (int i = 0; i < rows; i++) {
        w->most[i] = number_most(w->most[i], w->mass[i * rows + i]);
    }
    for (int c = 0; c < rows; c++) {
        const double pivot = w->mass[c * rows + c];
        const double part = w->most[c] > 0.0 ? fabs(pivot) / w->most[c] : 1.0;
        if (part < least) {
            least = part;
            *row = c;
        }
        for (int i = c + 1; i < rows && pivot != 0.0; i++) {
            const double factor = w->mass[i * rows + c] / pivot;
            for (int j = c; j < rows; j++) {
                w->mass[i * rows + j] -= factor * w->mass[c * rows + j];
            }
        }
    }
    return least;
}

/* Which position makes the diagonal entry of this row change most, by how far it moves a second. */
static int position_near(watch *w, const double *x, int row) {
    const int n = w->field->n;
    const int rows = w->field->rows;
    double *at = room(2 * (int64_t)n, sizeof *at);
    double *size = at + n;
    double most = 0.0;
    int found = -1;
    memcpy(at, x, (size_t)n * sizeof *at);
    rate_sizes(w, size);
    field_mass(w->field, at, size, w->mass);
    const double here = w->mass[row * rows + row];
    for (int i = 0; i < n; i++) {
        if (!is_rate(w, i)) {
            at[i] = x[i] + 1e-3 * number_least(w->high[i] - w->low[i], 1.0);
            field_mass(w->field, at, size, w->mass);
            const double change = fabs(w->mass[row * rows + row] - here);
            at[i] = x[i];
            if (change > most) {
                most = change;
                found = i;
            }
        }
    }
    free(at);
    return found;
}

/* Down the accurate way once more, past its least pivot. */
static void watch_inertia(watch *w, const double *begin, watch_look *made) {
    double *x = room(2 * (int64_t)w->field->n, sizeof *x);
    double *least = x + w->field->n;
    const int places = w->field->rows > 8 ? INERTIA_PLACES / 8 : INERTIA_PLACES;
    const double h = (made->end_s - made->begin_s) / places;
    const int parts = 1 + (int)(h / made->fine_step_s);
    int row = -1;
    for (int k = 0; k < w->records; k++) { /* what it is elsewhere */
        least_pivot(w, w->record + k * (ptrdiff_t)w->field->n, &row);
    }
    memcpy(x, begin, (size_t)w->field->n * sizeof *x);
    for (int k = 0; k <= places; k++) {
        const double inertia = least_pivot(w, x, &row);
        if (inertia < made->inertia) {
            made->inertia = inertia;
            made->singular = w->field->rate[row];
            made->singular_s = made->begin_s + h * k;
            made->near = row;
            memcpy(least, x, (size_t)w->field->n * sizeof *x);
        }
        field_go(w->field, h, parts, x);
    }
    if (made->inertia < 1.0) {
        made->near = position_near(w, least, made->near);
        made->near_at = made->near >= 0 ? least[made->near] : 0.0;
    }
    free(x);
}

/* How far apart two ends of a way are; *whose: which component's; -1: the rates'. */
static double apart(watch *w, const double *run, const double *truth, int *whose) {
    const int n = w->field->n;
    const int rows = w->field->rows;
    double most = 0.0;
    *whose = -1;
    for (int i = 0; i < n; i++) {
        const double range = w->range[i];
        const bool angle =
            w->field->image->unknown[image_component(w->field->image, i).unknown].is_angle;
        if (is_rate(w, i) && rows > 0) {
            continue;
        }
        const double off = fabs(run[i] - truth[i]) / (angle && range > 1.0 ? 1.0
                                                      : range > 0.0        ? range
                                                                           : 1.0);
        if (off > most || !isfinite(off)) {
            most = isfinite(off) ? off : 1.0;
            *whose = i;
        }
    }
    double off_2 = 0.0;
    double all_2 = 0.0;
    if (rows > 0) {
        double *size = w->scratch + 2 * (ptrdiff_t)n;
        rate_sizes(w, size);
        field_mass(w->field, truth, size, w->mass);
    }
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < rows; j++) {
            const int a = w->field->rate[i];
            const int b = w->field->rate[j];
            off_2 += (run[a] - truth[a]) * w->mass[i * rows + j] * (run[b] - truth[b]);
            all_2 += truth[a] * w->mass[i * rows + j] * truth[b];
        }
    }
    const double rates = all_2 > 0.0 ? number_root(fabs(off_2) / all_2) : 0.0;
    if (rates > most) {
        most = rates;
        *whose = -1;
    }
    return most;
}

/* Of a long list fewer. */
static int parts_most(const watch *w, int steps) {
    const double operations = w->field->image->list[IMAGE_BOOKS]->count + 8.0 * w->field->n;
    const double parts = LOOK_OPERATIONS / (16.0 * steps * operations);
    return parts < PARTS_MOST ? (int)number_most(parts, PARTS_FIRST + 1.0) : PARTS_MOST;
}

void look_close(watch *w, int ahead) {
    const uint64_t end = w->steps;
    const uint64_t begin = end > WATCH_WINDOW ? end - WATCH_WINDOW : 0;
    const size_t bytes = (size_t)w->field->n * sizeof *w->low;
    double *fine = w->scratch;
    double *coarse = w->scratch + w->field->n;
    watch_look made = {.done = true,
                       .begin_s = watch_time_s(w, begin),
                       .end_s = watch_time_s(w, end + (uint64_t)ahead),
                       .inertia = 1.0,
                       .near = -1,
                       .singular = -1};
    const double span_s = made.end_s - made.begin_s;
    const int steps = (int)(end - begin) + ahead;
    int parts = PARTS_FIRST;
    int ignored;
    memcpy(coarse, watch_past(w, begin), bytes);
    field_go(w->field, span_s, steps * parts, coarse);
    const int most = parts_most(w, steps);
    for (; parts < most; parts *= 4) {
        memcpy(fine, watch_past(w, begin), bytes);
        field_go(w->field, span_s, 4 * steps * parts, fine);
        made.resolved = apart(w, coarse, fine, &ignored) < AGREED;
        if (made.resolved) {
            break;
        }
        memcpy(coarse, fine, bytes);
    }
    made.off = ahead > 0 ? 1.0 : apart(w, watch_past(w, end), fine, &made.component);
    made.failed = ahead > 0;
    made.fine_step_s = w->step_s / parts;
    if (w->field->rows > 0 && made.off > 10.0 * AGREED) {
        watch_inertia(w, watch_past(w, begin), &made);
    }
    if (isfinite(made.off) && (!w->worst.done || made.off > w->worst.off)) {
        w->worst = made;
    }
    if (isfinite(made.off) && w->field->image->mass_moves && made.inertia < 0.01 &&
        (!w->singular.done || made.off > w->singular.off)) {
        w->singular = made;
    }
    w->looked++;
}
