#include "flowpipe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/prove/zonotope.h"

/* The step is as long as the remainder, relative to the largest value of a state so far, stays below this, */
#define REMAINDER 0x1p-54
/* but a step shorter than this is useless, s. */
#define STEP_LEAST_S 1e-9
#define STEP_FIRST_S 0.01
enum { TRIALS = 60, GENERATORS = 3000 };

struct flowpipe {
    const exact_motion *motion;
    int states;
    int order;
    int first;        /* coefficients up to this one use derivatives, */
    taylor *middle;   /* from the centre; the later ones are so small */
    taylor *all;      /* that they are evaluated over the whole box */
    taylor *over;     /* over a whole step, one order more */
    double *centre;   /* [states] x is centre plus off, */
    zonotope *off;    /* which lies in a box... */
    enclosure *box;   /* [states] of x, along the state axes, */
    double *axes;     /* [states * states] and along these axes */
    enclosure *along; /* [states] */
    enclosure *turn;  /* [first + 1][states * states] coefficients of the derivatives times the axes
                       */
    enclosure *stay;  /* [states] over the step */
    double *largest;  /* [states] */
    double open_s;    /* length of the open step; 0: not open */
    double guess_s;   /* for the next step */
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
    zonotope_map(t->off, t->turn, t->along); /* the set is empty: the map does not matter */
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

/* --- enclosure of the motion over a step ------------------------------------------------------------- */

/* sum of [0, h]^k x_k over k <= order, from the whole box. */
static enclosure polynomial_over(const flowpipe *t, int i, enclosure span) {
    enclosure sum = taylor_of(t->all, i, t->order)[0];
    for (int k = t->order - 1; k >= 0; k--) {
        sum = enclosure_add(taylor_of(t->all, i, k)[0], enclosure_mul(span, sum));
    }
    return sum;
}

static enclosure power_of(enclosure h, int n) { return enclosure_whole_power(h, n); }

/* tau^(order + 1) times the next coefficient over `stay`: Lagrange's remainder. */
static enclosure remainder_of(const flowpipe *t, int i, enclosure tau) {
    return enclosure_mul(power_of(tau, t->order + 1), taylor_of(t->over, i, t->order + 1)[0]);
}

static enclosure widened(enclosure a, double by) { return enclosure_add(a, (enclosure){-by, by}); }

/* Does every motion from the box stay in `stay` for h_s? Assume that one leaves it first at t. Its Taylor polynomial
 * with Lagrange's remainder over `stay` up to t would put it inside: a contradiction. *excess: the largest remainder
 * relative to the wanted one. */
static bool stays(flowpipe *t, double h_s, double *excess) {
    const enclosure span = {0.0, h_s};
    *excess = (double)INFINITY;
    for (int i = 0; i < t->states; i++) {
        const enclosure to = polynomial_over(t, i, span);
        t->stay[i] = widened(to, REMAINDER * (enclosure_size(to) + t->largest[i]) * 16.0 + 1e-300);
    }
    if (!find(t, t->over, t->stay)) {
        return false;
    }
    bool good = true;
    double most = 0.0;
    for (int i = 0; i < t->states; i++) {
        const enclosure rest = remainder_of(t, i, span);
        const enclosure to = enclosure_add(polynomial_over(t, i, span), rest);
        const double wish =
            REMAINDER * enclosure_larger(t->largest[i], enclosure_size(t->stay[i])) + 1e-300;
        good = good && enclosure_inside(to, t->stay[i]);
        most = enclosure_larger(most, enclosure_size(rest) / wish);
    }
    *excess = most;
    return good;
}

/* The next trial's length from the remainder's order, with bounded change. */
static double changed(double h_s, double excess, int order) {
    const double factor =
        excess > 0.0 ? 0.9 * number_power(1.0 / excess, 1.0 / (double)(order + 1)) : 2.0;
    return h_s * enclosure_larger(0.4, enclosure_lesser(factor, 1.5));
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
        t->guess_s = changed(h_s, stay ? excess : enclosure_larger(excess, 1e6), t->order);
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

/* --- in the step -------------------------------------------------------------------------------------*/

/* The displacement of the centre: its polynomial minus its start, the later coefficients, and the remainder. */
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

static enclosure slope_at(const flowpipe *t, int i, int j, enclosure tau) {
    enclosure sum = taylor_of(t->all, i, t->first)[1 + j];
    for (int k = t->first - 1; k >= 0; k--) {
        sum = enclosure_add(taylor_of(t->all, i, k)[1 + j], enclosure_mul(tau, sum));
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

static bool all_finite(const flowpipe *t) {
    bool good = true;
    for (int i = 0; i < t->states; i++) {
        good = good && enclosure_is_finite(t->box[i]);
    }
    return good;
}

/* Move the centre by the middle of the displacement; the remainder of its enclosure goes to `left`. The displacement is
 * small, so little precision is lost. */
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
    for (int i = 0; i < n * n; i++) {
        slope[i] = slope_at(t, i / n, i % n, tau_s);
    }
    go_to(t, tau_s, left);
    zonotope_map(t->off, slope, left);
    zonotope_box(t->off, t->box);
    t->products +=
        2.0 * (double)n * (double)n * (double)t->off->count; /* here, and at its opening */
    for (int i = 0; i < n; i++) {
        /* derivatives cover the segment from the centre to the motion */
        const enclosure centre = enclosure_of(t->centre[i]);
        t->box[i] = enclosure_hull(enclosure_add(centre, t->box[i]), centre);
    }
    free(slope);
    free(left);
    t->open_s = 0.0;
    t->steps++;
    return all_finite(t);
}
