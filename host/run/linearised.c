/* linearised.c: see linearised.h. */
#include "linearised.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* Motions of a record that are looked at: those that the method is furthest off with. */
#define MOTIONS_A_RECORD 8
/* Slower than this part of a radian over the run is none. */
#define MOTION_LEAST 1e-2
/* Less than this is no part in the motion. */
#define SHARE_LEAST 1e-6
/* What left and right vectors have in common, of what they could: less is rounding. */
#define ALONE_LEAST 1e-6

/* What has gone further than so many times where it is, or goes in a step, has left: its range tells nothing of here. */
#define HERE 1e3

/* Root mean squares of the slopes over the records, times the root of two: the size of a swing. */
static void slope_sizes(const watch *w, double *size) {
    field *f = w->field;
    double *slope = room(f->n, sizeof *slope);
    for (int k = 0; k < w->records; k++) {
        field_slope(f, w->record + k * (ptrdiff_t)f->n, slope);
        for (int i = 0; i < f->n; i++) {
            size[i] += isfinite(slope[i]) ? 2.0 * slope[i] * slope[i] / w->records : 0.0;
        }
    }
    for (int i = 0; i < f->n; i++) {
        size[i] = number_root(size[i]);
    }
    free(slope);
}

/* The two unknowns with the largest participation. */
static void carriers(const watch *w, const double *share, linear_motion *m) {
    const image *im = w->field->image;
    double *sum = room(im->count, sizeof *sum);
    m->unknown[0] = -1;
    m->unknown[1] = -1;
    for (int i = 0; i < w->field->n; i++) {
        sum[image_component(im, i).unknown] += share[i];
    }
    for (int u = 0; u < im->count; u++) {
        if (m->unknown[0] < 0 || sum[u] > sum[m->unknown[0]]) {
            m->unknown[1] = m->unknown[0];
            m->unknown[0] = u;
        } else if (m->unknown[1] < 0 || sum[u] > sum[m->unknown[1]]) {
            m->unknown[1] = u;
        }
    }
    if (m->unknown[1] >= 0 && sum[m->unknown[1]] < 0.2 * sum[m->unknown[0]]) {
        m->unknown[1] = -1;
    }
    free(sum);
}

/* Its part in what moves: positions by their rates, whose squares are energies; of the first order, by their slopes. */
static double share_of(const watch *w, const double *size, const complex_number *part, double im) {
    const field *f = w->field;
    double most = 0.0;
    for (int i = 0; i < f->n; i++) {
        const bool rate_of_one = image_component(f->image, i).primes > 0;
        if (!rate_of_one && size[i] > 0.0) {
            const double ratio = (im != 0.0 ? 2.0 : 1.0) * complex_size(part[i]) / size[i];
            most = number_most(most, ratio * ratio);
        }
    }
    return number_least(most, 1.0);
}

/* The next one of value[n] by how far the method is off, among those whose off[] is not below zero; -1: none. */
static int next_of(const linearised *l, int n, const complex_number *value, double *off) {
    int found = -1;
    for (int i = 0; i < n; i++) {
        const double size = complex_size(value[i]);
        if (off[i] < 0.0 || value[i].im < 0.0 || !(size * l->span_s > MOTION_LEAST)) {
            continue;
        }
        found = found < 0 || off[i] > off[found] ||
                        (off[i] == off[found] && size > complex_size(value[found]))
                    ? i
                    : found;
    }
    return found;
}

/* The larger of what is lost of its amplitude and what its energy goes up and down by. */
static double off_of(const linearised *l, wh_method method, limits_motion m, double step_s) {
    return number_most(limits_off(method, l->form, m, step_s, l->span_s),
                       limits_ripple(method, l->form, m, step_s));
}

/* What rates make of the accelerations of the motion part[n], as far as one number can say it: that of w'C u/w'u, w and u
 * being its left and right vectors of the places' q'' = C q' - K q. It is exact where C and K share their vectors. */
static complex_number rates_of(const field *f, const double *matrix, complex_number value,
                               const complex_number *left, const complex_number *part) {
    complex_number by_rates = {0.0, 0.0};
    complex_number all = {0.0, 0.0};
    double size = 0.0;
    for (int p = 0; p < f->n; p++) {
        const int v = f->next[p];
        if (v < 0) {
            continue;
        }
        all = complex_plus_times(all, left[v], part[p]);
        size += complex_size(left[v]) * complex_size(part[p]);
        for (int q = 0; q < f->n; q++) {
            const double entry = f->next[q] >= 0 ? matrix[v * f->n + f->next[q]] : 0.0;
            const complex_number moved = {entry * part[q].re, entry * part[q].im};
            by_rates = complex_plus_times(by_rates, left[v], moved);
        }
    }
    return complex_size(all) > ALONE_LEAST * size ? complex_over(by_rates, all)
                                                  : limits_plain(value).rates;
}

limits_motion linearised_as(const linear_motion *m) { return (limits_motion){m->value, m->rates}; }

static void add_record(const watch *w, int record, const double *size, linearised *l) {
    field *f = w->field;
    const int n = f->n;
    double *matrix = room((int64_t)n * n + 4 * (int64_t)n, sizeof *matrix);
    double *slope = matrix + (ptrdiff_t)n * n;
    double *share = slope + n;
    double *off = share + n;
    double *range = off + n;
    complex_number *value = room(3 * (int64_t)n, sizeof *value);
    complex_number *part = value + n;
    complex_number *left = part + n;
    const double *x = w->record + record * (ptrdiff_t)n;
    field_slope(f, x, slope);
    for (int i = 0; i < n; i++) {
        const double here = number_most(fabs(x[i]), fabs(slope[i]) * w->step_s);
        range[i] = number_least(w->high[i] - w->low[i], HERE * here);
        range[i] = number_most(range[i], 1e-3 * fabs(x[i]));
    }
    if (field_jacobian(f, x, range, matrix) && modes_values(n, matrix, value)) {
        for (int i = 0; i < n; i++) {
            off[i] = off_of(l, l->method, limits_plain(value[i]), l->step_s);
        }
        const int most = n > LINEARISED_SMALL ? MOTIONS_A_RECORD / 4 : MOTIONS_A_RECORD;
        for (int k = 0; k < most && l->motions < LINEARISED_MOST; k++) {
            const int i = next_of(l, n, value, off);
            if (i < 0) {
                break;
            }
            linear_motion m = {.value = value[i], .time_s = w->record_s[record]};
            off[i] = -1.0;
            if (modes_part(n, matrix, value[i], slope, part, left, share)) {
                m.rates = rates_of(f, matrix, value[i], left, part);
                m.off = off_of(l, l->method, linearised_as(&m), l->step_s);
                m.ripple = limits_ripple(l->method, l->form, linearised_as(&m), l->step_s);
                m.ripple = m.ripple >= m.off ? m.ripple : 0.0;
                m.share = share_of(w, size, part, value[i].im);
                carriers(w, share, &m);
                l->motion[l->motions++] = m;
            }
        }
    }
    free(matrix);
    free(value);
}

static double weight(const linear_motion *m) { return m->share * number_least(m->off, 1.0); }

/* Of a swing and the moments in which it stands on its head, the swing. */
static double interest(const linear_motion *m) {
    return (m->value.im > 0.1 * complex_size(m->value) ? 3.0 : 1.0) * weight(m);
}

static void choose(linearised *l) {
    for (int i = 0; i < l->motions; i++) {
        const linear_motion *m = &l->motion[i];
        if (m->share < SHARE_LEAST) {
            continue;
        }
        if (l->worst == NULL || interest(m) > interest(l->worst)) {
            l->worst = m;
        }
        if (l->fastest == NULL || complex_size(m->value) > complex_size(l->fastest->value)) {
            l->fastest = m;
        }
    }
}

linearised *linearised_of(const watch *w, wh_method method) {
    linearised *l = room(1, sizeof *l);
    *l = (linearised){.form = w->field->image->form,
                      .span_s = (double)(w->steps + (w->steps == 0)) * w->step_s,
                      .step_s = w->step_s,
                      .method = method};
    double *size = room(w->field->n, sizeof *size);
    const int apart = w->field->n > LINEARISED_SMALL ? WATCH_RECORDS / 2 - 1 : 1;
    slope_sizes(w, size);
    for (int k = 0; k < w->records; k += apart) {
        add_record(w, k, size, l);
    }
    free(size);
    choose(l);
    return l;
}

void linearised_free(linearised *l) { free(l); }
