/* watch.c: see watch.h. */
#include "watch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* A close look is due when the accelerations change so in a step that a rate changes by this part of its range less or
 * more than they said. */
#define LOOK_AT 0.02
#define LOOK_LARGER 1.3
/* Steps of the accurate way in one of the run's, at first, and at most; they agree when the next finer ones do within this. */
#define PARTS_FIRST 4
#define PARTS_MOST 4096
#define AGREED 1e-5
/* On which so many places are asked for their mass matrix. */
#define INERTIA_PLACES 512
/* How far beyond a run that failed. */
#define STEPS_AHEAD 2
/* The books' rule is in doubt where its two halves differ by this part of the work, and that is this part of all. */
#define DOUBT_SHARE 0.01
#define DOUBT_LEAST 1e-7
#define DOUBTS_MOST 4000
#define DOUBT_PARTS 6

watch *watch_open(const image *im, const engine_kind *kind) {
    watch *w = room(1, sizeof *w);
    w->field = field_open(im, kind);
    const int64_t n = w->field->n;
    const int64_t rows = w->field->rows;
    w->step_s = im->step_s;
    w->smooth = im->contacts == 0;
    w->stride = 1;
    w->record = room(WATCH_RECORDS * n, sizeof *w->record);
    w->low = room((8 + WATCH_WINDOW) * n, sizeof *w->low);
    w->high = w->low + n;
    w->slope = w->high + n;
    w->scratch = w->slope + 2 * n;
    w->past = w->scratch + 3 * n;
    w->mass = room(rows * rows + rows, sizeof *w->mass);
    w->most = w->mass + rows * rows;
    w->worst.inertia = 1.0;
    w->singular.inertia = 1.0;
    w->balanced = im->has_energies && w->smooth;
    return w;
}

void watch_close(watch *w) {
    if (w != NULL) {
        field_close(w->field);
        free(w->record);
        free(w->low);
        free(w->mass);
        free(w);
    }
}

static double *past(const watch *w, uint64_t step) {
    return w->past + (ptrdiff_t)(step % (WATCH_WINDOW + 1)) * w->field->n;
}

static double time_of(const watch *w, uint64_t step) { return (double)step * w->step_s; }

static bool is_rate(const watch *w, int i) {
    return image_component(w->field->image, i).primes > 0;
}

/* --- records --------------------------------------------------------------------------------------------*/

static void enter_record(watch *w, const double *x) {
    const size_t n = (size_t)w->field->n;
    if (w->steps % w->stride != 0) {
        return;
    }
    if (w->records == WATCH_RECORDS) { /* every other one stays */
        for (int k = 1; 2 * k < WATCH_RECORDS; k++) {
            memcpy(w->record + k * (ptrdiff_t)n, w->record + 2 * k * (ptrdiff_t)n,
                   n * sizeof *w->record);
            w->record_s[k] = w->record_s[2 * k];
        }
        w->records = WATCH_RECORDS / 2;
        w->stride *= 2;
        if (w->steps % w->stride != 0) {
            return;
        }
    }
    memcpy(w->record + w->records * (ptrdiff_t)n, x, n * sizeof *w->record);
    w->record_s[w->records++] = time_of(w, w->steps);
}

/* --- a close look ------------------------------------------------------------------------------------------*/

/* Of the size of a rate: what changes it by. */
static void rate_sizes(const watch *w, double *size) {
    for (int i = 0; i < w->field->n; i++) {
        size[i] =
            number_most(w->high[i] - w->low[i], number_most(fabs(w->low[i]), fabs(w->high[i])));
    }
}

/* The least pivot of the mass matrix at x, of what its diagonal has been at most, and whose it is. */
static double least_pivot(watch *w, double time_s, const double *x, int *row) {
    const int rows = w->field->rows;
    double least = 1.0;
    double *size = w->scratch + 2 * (ptrdiff_t)w->field->n;
    rate_sizes(w, size);
    field_mass(w->field, time_s, x, size, w->mass);
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
static int position_near(watch *w, double time_s, const double *x, int row) {
    const int n = w->field->n;
    const int rows = w->field->rows;
    double *at = room(2 * (int64_t)n, sizeof *at);
    double *size = at + n;
    double most = 0.0;
    int found = -1;
    memcpy(at, x, (size_t)n * sizeof *at);
    rate_sizes(w, size);
    field_mass(w->field, time_s, at, size, w->mass);
    const double here = w->mass[row * rows + row];
    for (int i = 0; i < n; i++) {
        if (!is_rate(w, i)) {
            at[i] = x[i] + 1e-3 * number_least(w->high[i] - w->low[i], 1.0);
            field_mass(w->field, time_s, at, size, w->mass);
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
    const double h = (made->end_s - made->begin_s) / INERTIA_PLACES;
    const int parts = 1 + (int)(h / made->fine_step_s);
    int row = -1;
    for (int k = 0; k < w->records; k++) { /* what it is elsewhere */
        least_pivot(w, w->record_s[k], w->record + k * (ptrdiff_t)w->field->n, &row);
    }
    memcpy(x, begin, (size_t)w->field->n * sizeof *x);
    for (int k = 0; k <= INERTIA_PLACES; k++) {
        const double inertia = least_pivot(w, made->begin_s + h * k, x, &row);
        if (inertia < made->inertia) {
            made->inertia = inertia;
            made->singular = w->field->rate[row];
            made->singular_s = made->begin_s + h * k;
            made->near = row;
            memcpy(least, x, (size_t)w->field->n * sizeof *x);
        }
        field_go(w->field, made->begin_s + h * k, h, parts, x);
    }
    if (made->inertia < 1.0) {
        made->near = position_near(w, made->singular_s, least, made->near);
        made->near_at = made->near >= 0 ? least[made->near] : 0.0;
    }
    free(x);
}

/* How far apart two ends of a way are; *whose: which component's; -1: the rates'. */
static double apart(watch *w, double time_s, const double *run, const double *truth, int *whose) {
    const int n = w->field->n;
    const int rows = w->field->rows;
    double most = 0.0;
    *whose = -1;
    for (int i = 0; i < n; i++) {
        const double range = w->high[i] - w->low[i];
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
        field_mass(w->field, time_s, truth, size, w->mass);
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

/* From step `begin` to `end` again, and `ahead` steps beyond, which the run could not take. */
static void look(watch *w, uint64_t begin, uint64_t end, int ahead) {
    const size_t bytes = (size_t)w->field->n * sizeof *w->low;
    double *fine = w->scratch;
    double *coarse = w->scratch + w->field->n;
    watch_look made = {.done = true,
                       .begin_s = time_of(w, begin),
                       .end_s = time_of(w, end + (uint64_t)ahead),
                       .inertia = 1.0,
                       .near = -1,
                       .singular = -1};
    const double span_s = made.end_s - made.begin_s;
    const int steps = (int)(end - begin) + ahead;
    int parts = PARTS_FIRST;
    int ignored;
    memcpy(coarse, past(w, begin), bytes);
    field_go(w->field, made.begin_s, span_s, steps * parts, coarse);
    for (; parts < PARTS_MOST; parts *= 4) {
        memcpy(fine, past(w, begin), bytes);
        field_go(w->field, made.begin_s, span_s, 4 * steps * parts, fine);
        made.resolved = apart(w, made.end_s, coarse, fine, &ignored) < AGREED;
        if (made.resolved) {
            break;
        }
        memcpy(coarse, fine, bytes);
    }
    made.off = ahead > 0 ? 1.0 : apart(w, made.end_s, past(w, end), fine, &made.component);
    made.failed = ahead > 0;
    made.fine_step_s = w->step_s / parts;
    if (w->field->rows > 0 && made.off > 10.0 * AGREED) {
        watch_inertia(w, past(w, begin), &made);
    }
    if (isfinite(made.off) && (!w->worst.done || made.off > w->worst.off)) {
        w->worst = made;
    }
    if (isfinite(made.off) && made.inertia < 0.01 &&
        (!w->singular.done || made.off > w->singular.off)) {
        w->singular = made;
    }
    w->looked++;
}

/* How much less or more a rate changes in the last step than the accelerations at its begin say, as a part of its range. */
static double change_of_slopes(const watch *w) {
    double most = 0.0;
    for (int i = 0; i < w->field->n; i++) {
        const double range = w->high[i] - w->low[i];
        if (w->field->next[i] < 0 && range > 0.0) {
            const double off = fabs(w->slope[i] - w->slope[w->field->n + i]) * w->step_s / range;
            most = off > most ? off : most;
        }
    }
    return most;
}

static void look_where_due(watch *w) {
    const double metric = w->steps > 2 ? change_of_slopes(w) : 0.0;
    if (metric > LOOK_AT && (metric > LOOK_LARGER * w->metric || w->steps >= w->next)) {
        w->metric = number_most(metric, w->metric);
        w->next = w->steps + WATCH_WINDOW + 2 * w->steps / 3;
        w->due = w->steps + WATCH_WINDOW / 2;
    }
    if (w->due != 0 && w->steps >= w->due) {
        look(w, w->steps > WATCH_WINDOW ? w->steps - WATCH_WINDOW : 0, w->steps, 0);
        w->due = 0;
    }
}

void watch_end(watch *w, bool failed) {
    if (w->smooth && w->steps > 0 && (w->due != 0 || failed)) {
        look(w, w->steps > WATCH_WINDOW ? w->steps - WATCH_WINDOW : 0, w->steps,
             failed ? STEPS_AHEAD : 0);
    }
}

/* --- the balance -------------------------------------------------------------------------------------------*/

static void lose(watch *w, double lost_J) {
    w->lost_J += lost_J;
    w->most_J = number_most(w->most_J, fabs(w->lost_J));
    w->balanced = w->balanced && isfinite(w->lost_J);
}

/* What a step did to the energy, less what the accurate way from its begin does. */
static void lose_on_the_way(watch *w, uint64_t begin, double energy_J) {
    double *x = w->scratch;
    memcpy(x, past(w, begin), (size_t)w->field->n * sizeof *x);
    field_go(w->field, time_of(w, begin), w->step_s, DOUBT_PARTS, x);
    field_slope(w->field, time_of(w, begin + 1), x, w->scratch + w->field->n);
    lose(w, energy_J - field_energy_J(w->field));
}

static void balance(watch *w, const books *b) {
    const double *entry = b->value + w->field->image->count;
    const double power_W = entry[BOOK_INPUT_POWER] - entry[BOOK_LOSS_POWER];
    const double energy_J = b->energy_J[1];
    w->power_W[w->steps % 2 == 1 ? 1 : 2] = power_W;
    if (w->steps == 0) {
        w->power_W[0] = power_W;
        w->energy_J = energy_J;
    }
    if (w->steps == 0 || w->steps % 2 == 1) {
        w->middle_J = energy_J;
        return;
    }
    const double ends_W = w->power_W[0] + w->power_W[2];
    const double work_J = w->step_s / 3.0 * (ends_W + 4.0 * w->power_W[1]);
    const double sizes_J =
        w->step_s / 3.0 * (fabs(w->power_W[0]) + fabs(w->power_W[2]) + 4.0 * fabs(w->power_W[1]));
    const double doubt_J = fabs(w->step_s / 3.0 * (ends_W - 2.0 * w->power_W[1]));
    const bool doubt = doubt_J > DOUBT_SHARE * sizes_J && doubt_J > DOUBT_LEAST * b->size_J &&
                       w->doubts < DOUBTS_MOST;
    if (doubt) {
        lose_on_the_way(w, w->steps - 2, w->middle_J);
        lose_on_the_way(w, w->steps - 1, energy_J);
        w->doubts++;
    } else {
        lose(w, energy_J - w->energy_J - work_J);
    }
    w->power_W[0] = power_W;
    w->energy_J = energy_J;
}

/* --- all of it -----------------------------------------------------------------------------------------------*/

/* The books have the highest derivatives already. */
static void read_slopes(watch *w, const books *b, const double *x) {
    const int n = w->field->n;
    memcpy(w->slope + n, w->slope, (size_t)n * sizeof *w->slope);
    if (b == NULL) {
        field_slope(w->field, time_of(w, w->steps), x, w->slope);
        return;
    }
    for (int i = 0; i < n; i++) {
        const int next = w->field->next[i];
        w->slope[i] = next >= 0 ? x[next] : b->value[-1 - next];
    }
}

void watch_enter(watch *w, const engine_kind *kind, const books *b, const void *run) {
    w->steps = kind->steps(run);
    double *x = past(w, w->steps);
    kind->state(run, x, x + w->field->image->angles);
    for (int i = 0; i < w->field->n; i++) {
        w->low[i] = w->steps == 0 || x[i] < w->low[i] ? x[i] : w->low[i];
        w->high[i] = w->steps == 0 || x[i] > w->high[i] ? x[i] : w->high[i];
    }
    enter_record(w, x);
    if (!w->smooth) {
        return;
    }
    read_slopes(w, b, x);
    if (w->balanced) {
        balance(w, b);
    }
    look_where_due(w);
}
