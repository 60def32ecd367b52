/* watch.c: see watch.h. */
#include "watch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"
#include "look_close.h"

/* A close look is due when the accelerations change so in a step that a rate changes by this part of its range less or
 * more than they said. */
#define LOOK_AT 0.02
#define LOOK_LARGER 1.3
/* What has not gone further than this part of what the furthest of its unit has is measured by that. */
#define ALIKE_SHARE 1e-3
/* How far beyond a run that failed. */
#define STEPS_AHEAD 2
/* The books' rule is in doubt where its two halves differ by this part of the work, and that is this part of all; and so many
 * steps on: what it is off, and what a step loses, goes to and fro, and of a part of a swing alone it would add up. */
#define DOUBT_SHARE 0.01
#define DOUBT_LEAST 1e-7
#define DOUBT_STEPS 64U
#define DOUBTS_MOST 4000
#define DOUBT_PARTS 6

static bool is_alike(const image *im, int i, int k) {
    const component a = image_component(im, i);
    const component b = image_component(im, k);
    return strcmp(im->unknown[a.unknown].unit[a.primes].si,
                  im->unknown[b.unknown].unit[b.primes].si) == 0;
}

watch *watch_open(const image *im, const engine_kind *kind) {
    watch *w = room(1, sizeof *w);
    w->field = field_open(im, kind);
    const int64_t n = w->field->n;
    const int64_t rows = w->field->rows;
    w->step_s = im->step_s;
    w->smooth = im->contacts == 0;
    w->stride = 1;
    w->record = room(WATCH_RECORDS * n, sizeof *w->record);
    w->low = room((15 + WATCH_WINDOW) * n, sizeof *w->low);
    w->high = w->low + n;
    w->slope = w->high + n;
    w->scratch = w->slope + 2 * n;
    w->range = w->scratch + 3 * n; /* and behind it the furthest of those alike */
    w->asked = w->range + 2 * n;
    w->asked_low = w->asked + n;
    w->asked_high = w->asked_low + n;
    w->strayed = w->asked_high + n;
    w->start = w->strayed + n;
    w->past = w->start + n;
    w->alike = room(n, sizeof *w->alike);
    for (int i = 0; i < n; i++) {
        while (!is_alike(im, i, w->alike[i])) {
            w->alike[i]++;
        }
    }
    w->mass = room(rows * rows + rows, sizeof *w->mass);
    w->most = w->mass + rows * rows;
    w->worst.inertia = 1.0;
    w->singular.inertia = 1.0;
    w->balanced = im->has_energies && w->smooth;
    w->jumped = jumped_open(im);
    w->between = between_open(im, kind);
    return w;
}

void watch_close(watch *w) {
    if (w != NULL) {
        field_close(w->field);
        jumped_close(w->jumped);
        between_close(w->between);
        free(w->record);
        free(w->low);
        free(w->alike);
        free(w->mass);
        free(w);
    }
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
    w->record_s[w->records++] = watch_time_s(w, w->steps);
}

/* --- when to look ------------------------------------------------------------------------------------*/

/* How much less or more a rate changes in the last step than the accelerations at its begin say, as a part of its range. */
static double change_of_slopes(const watch *w) {
    double most = 0.0;
    for (int i = 0; i < w->field->n; i++) {
        const double range = w->range[i];
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
        look_close(w, 0);
        w->due = 0;
    }
}

void watch_end(watch *w, bool failed) {
    if (w->smooth && w->steps > 0 && (w->due != 0 || failed)) {
        look_close(w, failed ? STEPS_AHEAD : 0);
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
    memcpy(x, watch_past(w, begin), (size_t)w->field->n * sizeof *x);
    field_go(w->field, w->step_s, DOUBT_PARTS, x);
    field_slope(w->field, x, w->scratch + w->field->n);
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
    if (doubt_J > DOUBT_SHARE * sizes_J && doubt_J > DOUBT_LEAST * b->size_J) {
        w->doubted = w->steps + DOUBT_STEPS;
    }
    if (w->steps <= w->doubted && w->doubts < DOUBTS_MOST) {
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
        field_slope(w->field, x, w->slope);
        return;
    }
    for (int i = 0; i < n; i++) {
        const int next = w->field->next[i];
        w->slope[i] = next >= 0 ? x[next] : b->value[-1 - next];
    }
}

/* What has hardly moved yet is measured by what moves. */
static void find_ranges(watch *w) {
    const int n = w->field->n;
    double *furthest = w->range + n;
    for (int i = 0; i < n; i++) {
        const double range = w->high[i] - w->low[i];
        double *most = &furthest[w->alike[i]];
        *most = number_most(*most, range);
        w->range[i] = range;
    }
    for (int i = 0; i < n; i++) {
        w->range[i] = number_most(w->range[i], ALIKE_SHARE * furthest[w->alike[i]]);
    }
}

/* Where the slopes lead to, and how far the run is from there: a sum that rounding stops does not follow its slopes. */
static void follow_slopes(watch *w, const double *x) {
    const int n = w->field->n;
    if (w->steps == 0) {
        memcpy(w->start, x, (size_t)n * sizeof *x);
        return;
    }
    for (int i = 0; i < n; i++) {
        w->asked[i] += 0.5 * w->step_s * (w->slope[i] + w->slope[n + i]);
        w->asked_low[i] = number_least(w->asked_low[i], w->asked[i]);
        w->asked_high[i] = number_most(w->asked_high[i], w->asked[i]);
        w->strayed[i] = number_most(w->strayed[i], fabs(w->asked[i] - (x[i] - w->start[i])));
    }
}

void watch_enter(watch *w, const engine_kind *kind, const books *b, const void *run) {
    w->steps = kind->steps(run);
    double *x = watch_past(w, w->steps);
    kind->state(run, x, x + w->field->image->angles);
    for (int i = 0; i < w->field->n; i++) {
        w->low[i] = w->steps == 0 || x[i] < w->low[i] ? x[i] : w->low[i];
        w->high[i] = w->steps == 0 || x[i] > w->high[i] ? x[i] : w->high[i];
    }
    enter_record(w, x);
    find_ranges(w);
    jumped_enter(w->jumped, kind, run);
    between_enter(w->between, kind, run);
    if (!w->smooth) {
        return;
    }
    read_slopes(w, b, x);
    follow_slopes(w, x);
    if (w->balanced) {
        balance(w, b);
    }
    look_where_due(w);
}
