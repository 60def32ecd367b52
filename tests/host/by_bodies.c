#include "by_bodies.h"

#include <math.h>

static bodies_state slope_of(const by_bodies *b, const bodies_state *s) {
    bodies_state slope = {{0.0L}, {0.0L}};
    b->accelerate(b->of, s, slope.v_mps);
    for (int i = 0; i < b->bodies; i++) {
        slope.x_m[i] = s->v_mps[i];
    }
    return slope;
}

static void add(bodies_state *to, long double by, const bodies_state *s) {
    for (int i = 0; i < BODIES_MOST; i++) {
        to->x_m[i] += by * s->x_m[i];
        to->v_mps[i] += by * s->v_mps[i];
    }
}

static void step(const by_bodies *b, bodies_state *s) {
    static const long double node[4] = {0.0L, 0.5L, 0.5L, 1.0L};
    static const long double weight[4] = {1.0L / 6.0L, 1.0L / 3.0L, 1.0L / 3.0L, 1.0L / 6.0L};
    const long double h = (long double)b->step_s;
    bodies_state next = *s;
    bodies_state slope = {{0.0L}, {0.0L}};
    for (int stage = 0; stage < 4; stage++) {
        bodies_state at = *s;
        add(&at, node[stage] * h, &slope);
        slope = slope_of(b, &at);
        add(&next, weight[stage] * h, &slope);
    }
    *s = next;
}

void by_bodies_run(const by_bodies *b, const long double *start_m, long double *end_m,
                   double *range_m) {
    bodies_state s = {{0.0L}, {0.0L}};
    double low[BODIES_MOST] = {0.0};
    double high[BODIES_MOST] = {0.0};
    for (int i = 0; i < b->bodies; i++) {
        s.x_m[i] = start_m[i];
    }
    for (int k = 0; k <= b->steps; k++) {
        if (k > 0) {
            step(b, &s);
        }
        b->count(b->of, s.x_m, end_m);
        for (int i = 0; i < b->bodies; i++) {
            low[i] = k == 0 ? (double)end_m[i] : fmin(low[i], (double)end_m[i]);
            high[i] = k == 0 ? (double)end_m[i] : fmax(high[i], (double)end_m[i]);
            range_m[i] = high[i] - low[i];
        }
    }
}
