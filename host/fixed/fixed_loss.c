#include "fixed_loss.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/engine/engine.h"
#include "host/number/functions.h"

#define RAD_PER_UNIT (6.283185307179586477 / 4294967296.0)

enum { ALL_MOST = 3 * IMAGE_COMPONENTS_MAX };

typedef struct component_loss {
    double asked; /* of the step in progress */
    double lost;  /* since the start */
    double most;
    double low, high; /* range without round-off */
} component_loss;

struct fixed_loss {
    const fixed_plan *plan;
    evaluator *step;
    component_loss *component; /* [angles + reals] */
    int64_t *angle;            /* before the step */
    int32_t *real;
    uint32_t saturated;
    double *input;
};

double fixed_loss_unit(const fixed_plan *p, int i) {
    const int angles = p->image->angles;
    return i < angles ? RAD_PER_UNIT : number_scaled(1.0, -p->format[i - angles].bits);
}

static double value_of(const fixed_plan *p, const wh_fixed_state *s, int i) {
    const int angles = p->image->angles;
    return fixed_loss_unit(p, i) * (i < angles ? (double)s->angle[i] : (double)s->real[i - angles]);
}

fixed_loss *fixed_loss_new(const fixed_plan *p, const wh_fixed_state *start) {
    const image *im = p->image;
    fixed_loss *l = alloc(1, sizeof *l);
    l->plan = p;
    l->step = evaluator_new(im->list[IMAGE_STEP]);
    evaluator_wrap(l->step);
    l->component = alloc(im->angles + im->reals, sizeof *l->component);
    l->angle = alloc(im->angles, sizeof *l->angle);
    l->real = alloc(im->reals, sizeof *l->real);
    l->input = alloc(im->inputs, sizeof *l->input);
    for (int i = 0; i < im->angles + im->reals; i++) {
        l->component[i].low = value_of(p, start, i);
        l->component[i].high = l->component[i].low;
    }
    return l;
}

void fixed_loss_free(fixed_loss *l) {
    if (l != NULL) {
        evaluator_free(l->step);
        free(l->component);
        free(l->angle);
        free(l->real);
        free(l->input);
        free(l);
    }
}

/* The derivatives of all components, angles first, per second. */
static void slopes(const fixed_loss *l, const double *at, double *slope) {
    const fixed_plan *p = l->plan;
    const int angles = p->image->angles;
    const int moved = p->second ? p->coordinates : 0; /* by their rates, which follow them */
    for (int i = 0; i < moved; i++) {
        slope[i] = at[moved + i];
    }
    evaluator_run(l->step, 0.0, at, at + angles, at + moved, l->input, slope + moved);
}

void fixed_loss_before(fixed_loss *l, const wh_fixed_state *state) {
    static const double part[] = {0.0, 0.5, 0.5, 1.0};
    static const double weight[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    const fixed_plan *p = l->plan;
    const image *im = p->image;
    const int all = im->angles + im->reals;
    double slope[ALL_MOST] = {0.0};
    double at[ALL_MOST];
    for (int i = 0; i < im->inputs; i++) {
        l->input[i] = number_scaled(state->input[i], -p->format[im->reals + i].bits);
    }
    for (int i = 0; i < all; i++) {
        l->component[i].asked = 0.0;
    }
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < all; i++) {
            at[i] = value_of(p, state, i) + part[stage] * im->step_s * slope[i];
        }
        slopes(l, at, slope);
        for (int i = 0; i < all; i++) {
            l->component[i].asked += weight[stage] * im->step_s * slope[i];
        }
    }
    for (int i = 0; i < im->angles; i++) {
        l->angle[i] = state->angle[i];
    }
    for (int i = 0; i < im->reals; i++) {
        l->real[i] = state->real[i];
    }
    l->saturated = state->saturated;
}

void fixed_loss_after(fixed_loss *l, const wh_fixed_state *state) {
    const image *im = l->plan->image;
    for (int i = 0; i < im->angles + im->reals && state->saturated == l->saturated; i++) {
        component_loss *c = &l->component[i];
        const int64_t moved = i < im->angles
                                  ? state->angle[i] - l->angle[i]
                                  : (int64_t)state->real[i - im->angles] - l->real[i - im->angles];
        const double lost = c->asked - (double)moved * fixed_loss_unit(l->plan, i);
        if (isfinite(lost)) {
            c->lost += lost;
            c->most = number_most(c->most, fabs(c->lost));
            c->low = number_least(c->low, value_of(l->plan, state, i) + c->lost);
            c->high = number_most(c->high, value_of(l->plan, state, i) + c->lost);
        }
    }
}

double fixed_loss_off(const fixed_loss *l, int i, double *span) {
    *span = l->component[i].high - l->component[i].low;
    return l->component[i].most;
}
