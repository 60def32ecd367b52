/* flowpipe.c: a tube around the exact motion: its axes, zonotopes and steps (sources: flowpipe.h). */
#include "host/prove/flowpipe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

/* === axes that turn with the motion =========================================================== */
/* Axes along the longest vectors keep a box small (Lohner 1987, see flowpipe.h). */

/* Copies `of` to `a`, with columns sorted by length times radii[column], largest first. */
static void sorted(int n, const double *of, const double *radii, double *a) {
    bool *taken = alloc(n, sizeof *taken);
    for (int c = 0; c < n; c++) {
        int best = -1;
        double longest = -1.0;
        for (int j = 0; j < n; j++) {
            double length = 0.0;
            for (int i = 0; i < n; i++) {
                length += of[i * n + j] * of[i * n + j];
            }
            length *= radii[j] * radii[j];
            if (!taken[j] && length > longest) {
                longest = length;
                best = j;
            }
        }
        best = best >= 0 ? best : c; /* best = -1 if all remaining lengths are NaN */
        taken[best] = true;
        for (int i = 0; i < n; i++) {
            a[i * n + c] = of[i * n + best];
        }
    }
    free(taken);
}

/* Householder's reflection by v. The first k entries of v count as 0. */
static void reflect(int n, double *m, const double *v, int k, int from) {
    double norm = 0.0;
    for (int i = k; i < n; i++) {
        norm += v[i] * v[i];
    }
    for (int j = from; j < n && norm > 0.0; j++) {
        double sum = 0.0;
        for (int i = k; i < n; i++) {
            sum += v[i] * m[i * n + j];
        }
        for (int i = k; i < n; i++) {
            m[i * n + j] -= 2.0 * sum / norm * v[i];
        }
    }
}

/* Round-off in `axes` is harmless: worse axes only widen the result. */
static void orthogonal_axes(int n, const double *of, const double *radii, double *axes) {
    double *a = alloc((int64_t)n * n, sizeof *a);
    double *v = alloc((int64_t)n * n, sizeof *v); /* row k: vector of reflection k */
    sorted(n, of, radii, a);
    for (int k = 0; k < n; k++) {
        double norm = 0.0;
        for (int i = k; i < n; i++) {
            v[k * n + i] = a[i * n + k];
            norm += a[i * n + k] * a[i * n + k];
        }
        norm = number_root(norm);
        v[k * n + k] += v[k * n + k] < 0.0 ? -norm : norm;
        reflect(n, a, &v[k * n], k, k);
    }
    for (int i = 0; i < n * n; i++) {
        axes[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    }
    for (int k = n - 1; k >= 0; k--) {
        reflect(n, axes, &v[k * n], k, 0);
    }
    free(a);
    free(v);
}

/* Returns the largest absolute row sum of I - A^T A. */
static double off_orthogonal(int n, const double *axes) {
    double most = 0.0;
    for (int i = 0; i < n; i++) {
        double row = 0.0;
        for (int j = 0; j < n; j++) {
            enclosure sum = enclosure_of(i == j ? -1.0 : 0.0);
            for (int k = 0; k < n; k++) {
                sum = enclosure_add(sum, enclosure_mul(enclosure_of(axes[k * n + i]),
                                                       enclosure_of(axes[k * n + j])));
            }
            row = enclosure_above(row + enclosure_size(sum));
        }
        most = row > most || !isfinite(row) ? row : most;
    }
    return most;
}

/* Encloses the inverse of A = `axes`. Returns false if A is not nearly orthogonal. With E = I - A^T A, the inverse is
 * (I - E)^-1 A^T, and |(I - E)^-1 - I| <= |E| / (1 - |E|), where |E| is the largest absolute row sum. */
static bool orthogonal_inverse(int n, const double *axes, enclosure *inverse) {
    const double e = off_orthogonal(n, axes);
    if (!(e < 0.25)) {
        return false;
    }
    const double off = enclosure_above(e / enclosure_below(1.0 - e));
    for (int j = 0; j < n; j++) {
        double most = 0.0;
        for (int i = 0; i < n; i++) {
            most = enclosure_larger(most, fabs(axes[j * n + i]));
        }
        const double wide = enclosure_above(off * most);
        for (int i = 0; i < n; i++) {
            inverse[i * n + j] =
                enclosure_add(enclosure_of(axes[j * n + i]), (enclosure){-wide, wide});
        }
    }
    return true;
}

/* === the zonotope ============================================================================= */

zonotope *zonotope_new(int n, int most) {
    zonotope *z = alloc(1, sizeof *z);
    z->n = n;
    z->most = most > 4 * n ? most : 4 * n;
    z->drift = alloc(n, sizeof *z->drift);
    z->generator = alloc((int64_t)z->most * n, sizeof *z->generator);
    return z;
}

void zonotope_free(zonotope *z) {
    if (z != NULL) {
        free(z->drift);
        free(z->generator);
        free(z);
    }
}

static double sum_up(double a, double b) { return b == 0.0 ? a : enclosure_above(a + b); }

void zonotope_box(const zonotope *z, enclosure *box) {
    for (int i = 0; i < z->n; i++) {
        double radius = 0.0;
        for (int k = 0; k < z->count; k++) {
            radius = sum_up(radius, fabs(z->generator[k * z->n + i]));
        }
        box[i] = enclosure_add(enclosure_of(z->drift[i]), (enclosure){-radius, radius});
    }
}

/* Copies the n longest generators to columns[n * n]. If there are fewer, the other columns are unit vectors. */
static void longest(const zonotope *z, double *columns, double *radii) {
    const int n = z->n;
    double *length = alloc(n, sizeof *length);
    for (int i = 0; i < n * n; i++) {
        columns[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    }
    for (int k = 0; k < z->count; k++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++) {
            sum += z->generator[k * n + i] * z->generator[k * n + i];
        }
        int least = 0;
        for (int j = 1; j < n; j++) {
            least = length[j] < length[least] ? j : least;
        }
        if (sum > length[least]) {
            length[least] = sum;
            for (int i = 0; i < n; i++) {
                columns[i * n + least] = z->generator[k * n + i];
            }
        }
    }
    for (int j = 0; j < n; j++) {
        radii[j] = length[j] > 0.0 ? 1.0 : 1e-300;
    }
    free(length);
}

static void reach(const zonotope *z, const enclosure *inverse, int from, double *radius) {
    const int n = z->n;
    for (int i = 0; i < n; i++) {
        radius[i] = 0.0;
        for (int k = from; k < z->count; k++) {
            enclosure sum = enclosure_of(0.0);
            for (int j = 0; j < n; j++) {
                const double g = z->generator[k * n + j];
                sum = enclosure_add(sum, enclosure_times(inverse[i * n + j], g));
            }
            radius[i] = sum_up(radius[i], enclosure_size(sum));
        }
    }
}

/* Finds axes along the longest generators, and their inverse. If the inverse has no enclosure, uses the unit axes. */
static void find_axes(const zonotope *z, double *axes, enclosure *inverse) {
    const int n = z->n;
    double *columns = alloc((int64_t)n * n, sizeof *columns);
    double *radii = alloc(n, sizeof *radii);
    longest(z, columns, radii);
    orthogonal_axes(n, columns, radii, axes);
    if (!orthogonal_inverse(n, axes, inverse)) {
        for (int i = 0; i < n * n; i++) {
            axes[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
            inverse[i] = enclosure_of(axes[i]);
        }
    }
    free(columns);
    free(radii);
}

void zonotope_frame(const zonotope *z, double *axes, enclosure *off) {
    const int n = z->n;
    enclosure *inverse = alloc((int64_t)n * n, sizeof *inverse);
    double *radius = alloc(n, sizeof *radius);
    find_axes(z, axes, inverse);
    reach(z, inverse, 0, radius);
    for (int i = 0; i < n; i++) {
        enclosure along = enclosure_of(0.0);
        for (int k = 0; k < n; k++) {
            along =
                enclosure_add(along, enclosure_mul(inverse[i * n + k], enclosure_of(z->drift[k])));
        }
        off[i] = enclosure_add(along, (enclosure){-radius[i], radius[i]});
    }
    free(inverse);
    free(radius);
}

typedef struct ranked {
    double size;
    int which;
} ranked;

static int by_size(const void *a, const void *b) {
    const ranked *x = a;
    const ranked *y = b;
    return x->size > y->size ? -1 : x->size < y->size ? 1 : x->which - y->which;
}

static void sort_by_size(zonotope *z) {
    const int n = z->n;
    ranked *order = alloc(z->count, sizeof *order);
    double *sorted = alloc((int64_t)z->count * n, sizeof *sorted);
    for (int k = 0; k < z->count; k++) {
        order[k].which = k;
        for (int i = 0; i < n; i++) {
            order[k].size += fabs(z->generator[k * n + i]);
        }
    }
    qsort(order, (size_t)z->count, sizeof *order, by_size);
    for (int k = 0; k < z->count; k++) {
        memcpy(&sorted[k * n], &z->generator[order[k].which * n], (size_t)n * sizeof *sorted);
    }
    memcpy(z->generator, sorted, (size_t)z->count * (size_t)n * sizeof *sorted);
    free(order);
    free(sorted);
}

/* Replaces the smaller half of the generators by a box along axes. The box's round-off is added to rounding[n]. */
static void reduce(zonotope *z, double *rounding) {
    const int n = z->n;
    double *axes = alloc((int64_t)n * n, sizeof *axes);
    enclosure *inverse = alloc((int64_t)n * n, sizeof *inverse);
    double *radius = alloc(n, sizeof *radius);
    sort_by_size(z);
    find_axes(z, axes, inverse);
    const int kept = z->most / 2;
    reach(z, inverse, kept, radius);
    z->count = kept;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            const enclosure corner = enclosure_times(enclosure_of(axes[i * n + j]), radius[j]);
            z->generator[z->count * n + i] = enclosure_middle(corner);
            rounding[i] = sum_up(rounding[i], enclosure_radius(corner));
        }
        z->count++;
    }
    free(axes);
    free(inverse);
    free(radius);
}

/* Computes vector = map * vector + more. Adds the radius of the result to `rounding`. */
static void map_vector(int n, const enclosure *map, double *vector, const enclosure *more,
                       enclosure *to, double *rounding) {
    for (int i = 0; i < n; i++) {
        to[i] = more != NULL ? more[i] : enclosure_of(0.0);
        for (int j = 0; j < n; j++) {
            if (vector[j] != 0.0) {
                to[i] = enclosure_add(to[i], enclosure_times(map[i * n + j], vector[j]));
            }
        }
    }
    for (int i = 0; i < n; i++) {
        vector[i] = enclosure_middle(to[i]);
        rounding[i] = sum_up(rounding[i], enclosure_radius(to[i]));
    }
}

void zonotope_map(zonotope *z, const enclosure *map, const enclosure *more) {
    const int n = z->n;
    double *rounding = alloc(n, sizeof *rounding);
    enclosure *to = alloc(n, sizeof *to);
    map_vector(n, map, z->drift, more, to, rounding);
    for (int k = 0; k < z->count; k++) {
        map_vector(n, map, &z->generator[k * n], NULL, to, rounding);
    }
    if (z->count + 2 * n > z->most) {
        reduce(z, rounding);
    }
    for (int i = 0; i < n; i++) {
        double *made = &z->generator[z->count * n];
        memset(made, 0, (size_t)n * sizeof *made);
        made[i] = rounding[i];
        z->count += rounding[i] != 0.0 ? 1 : 0;
    }
    free(rounding);
    free(to);
}

/* === the tube ================================================================================= */

#define REMAINDER 0x1p-54 /* largest remainder of a step, relative to a state's largest value */
#define STEP_LEAST_S 1e-9 /* the tube ends if a step would have to be shorter */
#define STEP_FIRST_S 0.01
enum { TRIALS = 60, GENERATORS = 3000 };

struct flowpipe {
    const exact_motion *motion;
    int states;
    int order;
    int first;        /* coefficients above this order have no derivatives */
    taylor *middle;   /* Taylor coefficients at the centre */
    taylor *all;      /* Taylor coefficients over `box`, with derivatives up to `first` */
    taylor *over;     /* Taylor coefficients over `stay`, up to `order` + 1 */
    double *centre;   /* [states] a point of the tube is `centre` plus `off` */
    zonotope *off;    /* deviation from the centre */
    enclosure *box;   /* [states] box that contains `centre` plus `off` */
    double *axes;     /* [states * states] axes that turn with the motion */
    enclosure *along; /* [states] box of `off` along `axes` */
    enclosure *turn;  /* [first + 1][states * states] slopes of Taylor coefficients along `axes` */
    enclosure *stay;  /* [states] contains the motion during the whole step */
    double *largest;  /* [states] largest absolute value so far */
    double open_s;    /* length of the open step; 0: none */
    double guess_s;   /* guess for the next step, s */
    uint64_t steps;
    double products;
};

flowpipe *flowpipe_new(const exact_motion *m, int order) {
    const int n = m->states;
    flowpipe *t = alloc(1, sizeof *t);
    *t = (flowpipe){.motion = m,
                    .states = n,
                    .order = order,
                    .first = order / 2,
                    .middle = taylor_new(m, order / 2, -1),
                    .all = taylor_new(m, order, order / 2),
                    .over = taylor_new(m, order + 1, -1),
                    .centre = alloc(n, sizeof(double)),
                    .axes = alloc((int64_t)n * n, sizeof(double)),
                    .off = zonotope_new(n, GENERATORS),
                    .along = alloc(n, sizeof(enclosure)),
                    .box = alloc(n, sizeof(enclosure)),
                    .turn = alloc((int64_t)(order / 2 + 1) * n * n, sizeof(enclosure)),
                    .stay = alloc(n, sizeof(enclosure)),
                    .largest = alloc(n, sizeof(double)),
                    .guess_s = STEP_FIRST_S};
    for (int i = 0; i < n; i++) {
        t->centre[i] = enclosure_middle(m->start[i]);
        t->along[i] = enclosure_sub(m->start[i], enclosure_of(t->centre[i]));
        t->box[i] = m->start[i];
    }
    zonotope_map(t->off, t->turn, t->along); /* the deviation was 0 and becomes `along` */
    return t;
}

void flowpipe_free(flowpipe *t) {
    if (t != NULL) {
        taylor_free(t->middle);
        taylor_free(t->all);
        taylor_free(t->over);
        free(t->centre);
        free(t->axes);
        zonotope_free(t->off);
        free(t->along);
        free(t->box);
        free(t->turn);
        free(t->stay);
        free(t->largest);
        free(t);
    }
}

uint64_t flowpipe_steps(const flowpipe *t) { return t->steps; }
double flowpipe_products(const flowpipe *t) { return t->products; }

static bool find(flowpipe *t, taylor *series, const enclosure *x) {
    t->products += taylor_products(series);
    return taylor_find(series, x);
}

/* Encloses the Taylor polynomial of state i, or if entry > 0, its derivative by state (entry - 1). */
static enclosure polynomial(const flowpipe *t, int i, int entry, int order, enclosure tau) {
    enclosure sum = taylor_of(t->all, i, order)[entry];
    for (int k = order - 1; k >= 0; k--) {
        sum = enclosure_add(taylor_of(t->all, i, k)[entry], enclosure_mul(tau, sum));
    }
    return sum;
}

/* Lagrange's remainder of the Taylor polynomial. */
static enclosure remainder_of(const flowpipe *t, int i, enclosure tau) {
    return enclosure_mul(enclosure_whole_power(tau, t->order + 1),
                         taylor_of(t->over, i, t->order + 1)[0]);
}

/* Computes `stay`. Returns true if each motion from `box` is proved to remain in `stay` for h_s. */
static bool stays(flowpipe *t, double h_s, double *excess) {
    const enclosure span = {0.0, h_s};
    *excess = (double)INFINITY;
    for (int i = 0; i < t->states; i++) {
        const enclosure to = polynomial(t, i, 0, t->order, span);
        t->stay[i] =
            enclosure_widened(to, REMAINDER * (enclosure_size(to) + t->largest[i]) * 16.0 + 1e-300);
    }
    if (!find(t, t->over, t->stay)) {
        return false;
    }
    bool good = true;
    double most = 0.0;
    for (int i = 0; i < t->states; i++) {
        const enclosure rest = remainder_of(t, i, span);
        const enclosure to = enclosure_add(polynomial(t, i, 0, t->order, span), rest);
        const double request =
            REMAINDER * enclosure_larger(t->largest[i], enclosure_size(t->stay[i])) + 1e-300;
        good = good && enclosure_inside(to, t->stay[i]);
        most = enclosure_larger(most, enclosure_size(rest) / request);
    }
    *excess = most;
    return good;
}

static void find_turns(flowpipe *t) {
    const int n = t->states;
    for (int k = 0; k <= t->first; k++) {
        for (int i = 0; i < n; i++) {
            const enclosure *slope = &taylor_of(t->all, i, k)[1];
            for (int j = 0; j < n; j++) {
                enclosure sum = enclosure_of(0.0);
                for (int l = 0; l < n; l++) {
                    sum = enclosure_add(sum, enclosure_times(slope[l], t->axes[l * n + j]));
                }
                t->turn[(k * n + i) * n + j] = sum;
            }
        }
    }
}

double flowpipe_open(flowpipe *t, double most_s) {
    const int n = t->states;
    enclosure *centre = alloc(n, sizeof *centre);
    for (int i = 0; i < n; i++) {
        centre[i] = enclosure_of(t->centre[i]);
        t->largest[i] = enclosure_larger(t->largest[i], enclosure_size(t->box[i]));
    }
    t->open_s = 0.0;
    bool good = find(t, t->middle, centre) && find(t, t->all, t->box);
    free(centre);
    double h_s = enclosure_lesser(t->guess_s, most_s);
    for (int trial = 0; good && trial < TRIALS && h_s >= STEP_LEAST_S; trial++) {
        double excess;
        const bool stay = stays(t, h_s, &excess);
        excess = stay ? excess : enclosure_larger(excess, 1e6);
        /* The remainder grows as h_s^(order + 1): `factor` brings it just below its limit. */
        const double factor =
            excess > 0.0 ? 0.9 * number_power(1.0 / excess, 1.0 / (double)(t->order + 1)) : 2.0;
        t->guess_s = h_s * enclosure_larger(0.4, enclosure_lesser(factor, 1.5));
        if (stay) {
            t->open_s = h_s;
            zonotope_frame(t->off, t->axes, t->along);
            find_turns(t);
            break;
        }
        h_s = t->guess_s < h_s ? t->guess_s : 0.5 * h_s;
    }
    return t->open_s;
}

/* Encloses the displacement of the centre: the terms of its Taylor polynomial from order 1 on, and the remainder. */
static enclosure way_at(const flowpipe *t, int i, enclosure tau) {
    enclosure sum = taylor_of(t->all, i, t->order)[0];
    for (int k = t->order - 1; k > 0; k--) {
        const taylor *from = k <= t->first ? t->middle : t->all;
        sum = enclosure_add(taylor_of(from, i, k)[0], enclosure_mul(tau, sum));
    }
    return enclosure_add(enclosure_mul(tau, sum), remainder_of(t, i, tau));
}

static enclosure turn_at(const flowpipe *t, int entry, enclosure tau) {
    const int all = t->states * t->states;
    enclosure sum = t->turn[t->first * all + entry];
    for (int k = t->first - 1; k >= 0; k--) {
        sum = enclosure_add(t->turn[k * all + entry], enclosure_mul(tau, sum));
    }
    return sum;
}

void flowpipe_at(const flowpipe *t, enclosure tau_s, enclosure *x) {
    for (int i = 0; i < t->states; i++) {
        x[i] = enclosure_add(enclosure_of(t->centre[i]), way_at(t, i, tau_s));
        for (int j = 0; j < t->states; j++) {
            const enclosure turn = turn_at(t, i * t->states + j, tau_s);
            x[i] = enclosure_add(x[i], enclosure_mul(turn, t->along[j]));
        }
    }
}

/* Moves the centre by the middle of its displacement. left[states] encloses the rest of the displacement. */
static void go_to(flowpipe *t, enclosure tau, enclosure *left) {
    for (int i = 0; i < t->states; i++) {
        const enclosure way = way_at(t, i, tau);
        const double before = t->centre[i];
        t->centre[i] += enclosure_middle(way);
        left[i] =
            enclosure_add(enclosure_sub(enclosure_of(before), enclosure_of(t->centre[i])), way);
    }
}

bool flowpipe_on(flowpipe *t, enclosure tau_s) {
    const int n = t->states;
    enclosure *slope = alloc((int64_t)n * n, sizeof *slope);
    enclosure *left = alloc(n, sizeof *left);
    bool finite = true;
    for (int i = 0; i < n * n; i++) {
        slope[i] = polynomial(t, i / n, 1 + i % n, t->first, tau_s);
    }
    go_to(t, tau_s, left);
    zonotope_map(t->off, slope, left);
    zonotope_box(t->off, t->box);
    t->products += 2.0 * (double)n * (double)n * (double)t->off->count;
    for (int i = 0; i < n; i++) {
        /* the mean value theorem needs a box that contains the centre */
        const enclosure centre = enclosure_of(t->centre[i]);
        t->box[i] = enclosure_hull(enclosure_add(centre, t->box[i]), centre);
        finite = finite && enclosure_is_finite(t->box[i]);
    }
    free(slope);
    free(left);
    t->open_s = 0.0;
    t->steps++;
    return finite;
}
