/* engine_fixed.c: a run in fixed point without a compiler. c_fixed.c writes the same operations as C. */
#include "host/fixed/engine_fixed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/fixed/fixed_plan.h"
#include "host/number/functions.h"

/* === round-off of a run ======================================================================= */
/* The increments of each step are compared with those of RK4 in double from the same state. The differences are summed
 * from the start of the run, because host/check/slow.h needs the sum. */

#define RAD_PER_UNIT (6.283185307179586477 / 4294967296.0)

enum { ALL_MOST = 3 * IMAGE_COMPONENTS_MAX };

typedef struct component_loss {
    double asked; /* exact increment in the current step */
    double lost;  /* sum of exact minus fixed-point increments since the start */
    double most;
    double low, high; /* extremes of value + lost */
} component_loss;

typedef struct fixed_loss {
    const fixed_plan *plan;
    evaluator *step;
    component_loss *component; /* [angles + reals] */
    int64_t *angle;            /* angles before the step */
    int32_t *real;
    uint32_t saturated;
    double *input;
} fixed_loss;

/* The smallest increment of component i, SI. */
static double unit_of(const fixed_plan *p, int i) {
    const int angles = p->image->angles;
    return i < angles ? RAD_PER_UNIT : number_scaled(1.0, -p->format[i - angles].bits);
}

static double value_of(const fixed_plan *p, const wh_fixed_state *s, int i) {
    const int angles = p->image->angles;
    return unit_of(p, i) * (i < angles ? (double)s->angle[i] : (double)s->real[i - angles]);
}

static fixed_loss *fixed_loss_new(const fixed_plan *p, const wh_fixed_state *start) {
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

static void fixed_loss_free(fixed_loss *l) {
    if (l != NULL) {
        evaluator_free(l->step);
        free(l->component);
        free(l->angle);
        free(l->real);
        free(l->input);
        free(l);
    }
}

/* Called before each step. A step with clamped values is skipped, because clamping is reported separately. */
static void fixed_loss_before(fixed_loss *l, const wh_fixed_state *state) {
    static const double part[] = {0.0, 0.5, 0.5, 1.0};
    static const double weight[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    const fixed_plan *p = l->plan;
    const image *im = p->image;
    const int all = im->angles + im->reals;
    const int moved = p->second ? p->coordinates : 0; /* number of positions */
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
        memcpy(slope, at + moved, (size_t)moved * sizeof *slope);
        evaluator_run(l->step, 0.0, at, at + im->angles, at + moved, l->input, slope + moved);
        for (int i = 0; i < all; i++) {
            l->component[i].asked += weight[stage] * im->step_s * slope[i];
        }
    }
    memcpy(l->angle, state->angle, (size_t)im->angles * sizeof *l->angle);
    memcpy(l->real, state->real, (size_t)im->reals * sizeof *l->real);
    l->saturated = state->saturated;
}

static void fixed_loss_after(fixed_loss *l, const wh_fixed_state *state) {
    const image *im = l->plan->image;
    for (int i = 0; i < im->angles + im->reals && state->saturated == l->saturated; i++) {
        component_loss *c = &l->component[i];
        const int64_t moved = i < im->angles
                                  ? state->angle[i] - l->angle[i]
                                  : (int64_t)state->real[i - im->angles] - l->real[i - im->angles];
        const double lost = c->asked - (double)moved * unit_of(l->plan, i);
        if (isfinite(lost)) {
            c->lost += lost;
            c->most = number_most(c->most, fabs(c->lost));
            c->low = number_least(c->low, value_of(l->plan, state, i) + c->lost);
            c->high = number_most(c->high, value_of(l->plan, state, i) + c->lost);
        }
    }
}

/* === the interpreter ========================================================================== */

typedef struct fixed_run {
    const image *image;
    const fixed_plan *plan;
    wh_fixed_scene scene;
    wh_fixed_state state;
    void *memory;
    int32_t *value; /* [list->count] */
    int32_t *sine;  /* [list->count] sines of phases */
    int32_t *cosine;
    evaluator *observe;
    fixed_loss *loss;
} fixed_run;

typedef struct fixed_at {
    const uint32_t *phase;
    const int32_t *linear;
    const int32_t *rate;
    const int32_t *input;
} fixed_at;

static int32_t taken(const fixed_run *run, fixed_operand from) {
    const bool constant = run->plan->list->op[from.op].code == FIXED_CONSTANT;
    return constant ? from.number : wh_fixed_round(run->value[from.op], from.shift);
}

static int32_t factor(const fixed_run *run, fixed_operand from) {
    const bool constant = run->plan->list->op[from.op].code == FIXED_CONSTANT;
    return wh_fixed_left(constant ? from.number : run->value[from.op], from.shift);
}

static int32_t quotient(const fixed_run *run, const fixed_op *o) {
    const int32_t b = run->value[o->b.op];
    const uint32_t size = o->negated ? 0U - (uint32_t)b : (uint32_t)b;
    const uint32_t begun = size << (unsigned)o->zeros;
    const int more = o->spread == 0 ? 0 : wh_fixed_zeros(begun);
    const int32_t a = factor(run, o->a);
    const int32_t reciprocal = wh_fixed_reciprocal(begun << (unsigned)more);
    const int32_t q = o->follows ? wh_fixed_mul(wh_fixed_left(a, more), reciprocal, o->by)
                                 : wh_fixed_mul(a, reciprocal, o->by - more);
    return o->negated ? -q : q;
}

static void evaluate(fixed_run *run, fixed_at in, int32_t *result) {
    const fixed_list *l = run->plan->list;
    engine_operations += (uint64_t)l->count;
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        int32_t v = 0;
        if (!o->used) {
            continue;
        }
        switch (o->code) {
        case FIXED_CONSTANT: v = o->a.number; break;
        case FIXED_LINEAR: v = in.linear[o->index]; break;
        case FIXED_RATE: v = in.rate[o->index]; break;
        case FIXED_INPUT: v = in.input[o->index]; break;
        case FIXED_PHASE: {
            uint32_t phase = o->offset;
            for (int k = 0; k < l->angles && o->turns != NULL; k++) {
                phase += (uint32_t)o->turns[k] * in.phase[k];
            }
            wh_fixed_sincos(phase, &run->sine[i], &run->cosine[i]);
            break;
        }
        case FIXED_SINE: v = run->sine[o->a.op]; break;
        case FIXED_COSINE: v = run->cosine[o->a.op]; break;
        case FIXED_SUM: v = wh_fixed_add(taken(run, o->a), taken(run, o->b)); break;
        case FIXED_DIFFERENCE: v = wh_fixed_sub(taken(run, o->a), taken(run, o->b)); break;
        case FIXED_PRODUCT: v = wh_fixed_mul(factor(run, o->a), factor(run, o->b), o->by); break;
        case FIXED_QUOTIENT: v = quotient(run, o); break;
        case FIXED_SAME: v = o->negated ? -taken(run, o->a) : taken(run, o->a); break;
        case FIXED_ABS: v = wh_fixed_size(taken(run, o->a)); break;
        case FIXED_SIGN: v = wh_fixed_sign(run->value[o->a.op], o->bits); break;
        case FIXED_LEAST: v = wh_fixed_least(taken(run, o->a), taken(run, o->b)); break;
        case FIXED_MOST: v = wh_fixed_most(taken(run, o->a), taken(run, o->b)); break;
        }
        run->value[i] = v;
    }
    for (int i = 0; i < l->results; i++) {
        result[i] = run->value[l->result[i]];
    }
}

static int32_t gained(fixed_gain g, int32_t x) {
    return wh_fixed_mul(wh_fixed_left(x, g.shift), g.number, g.by);
}

/* A step in progress: the leaves of the list at a stage, and the results of all stages. */
typedef struct fixed_stages {
    uint32_t phase[IMAGE_COMPONENTS_MAX];
    int32_t linear[2 * IMAGE_COMPONENTS_MAX];
    int32_t rate[IMAGE_COMPONENTS_MAX];
    int32_t half_rate[IMAGE_COMPONENTS_MAX];
    int32_t given[4][IMAGE_COMPONENTS_MAX];
} fixed_stages;

/* Returns the increment of position i at a stage, with m->guard extra digits. */
static int32_t place_more(const fixed_mover *m, const fixed_stages *k, int i, int stage) {
    return stage == 1
               ? k->half_rate[i]
               : wh_fixed_add(k->half_rate[i],
                              wh_fixed_mul_short(k->given[stage - 2][i],
                                                 (int16_t)m->half_accel.number, m->half_accel.by));
}

/* Sets the leaves at a stage. */
static void go_to_stage(fixed_run *run, fixed_stages *k, int stage) {
    const fixed_plan *p = run->plan;
    const int angles = run->image->angles;
    const int twice = stage == 3 ? 1 : 0; /* stage 3 takes a whole step: increments are doubled */
    for (int i = 0; i < p->coordinates; i++) {
        const fixed_mover *m = &p->mover[i];
        const int32_t added = wh_fixed_round(k->given[stage - 1][i], m->to_kept - twice);
        const int32_t more =
            p->second ? wh_fixed_round(place_more(m, k, i, stage), m->guard - twice) : added;
        if (i < angles) {
            k->phase[i] = (uint32_t)run->state.angle[i] + (uint32_t)more;
        } else {
            k->linear[i - angles] = wh_fixed_add(run->state.real[i - angles], more);
        }
        if (p->second) {
            k->rate[i] = wh_fixed_add(run->state.real[p->linears + i], added);
        }
    }
}

static void add_limited(fixed_run *run, int at, int32_t more) {
    const wh_fixed_format *f = &run->plan->format[at];
    int32_t *real = &run->state.real[at];
    *real = wh_fixed_limit(wh_fixed_add(*real, more), f->low, f->high, &run->state.saturated);
}

/* (k1 + 2 k2 + 2 k3 + k4)/3 with the state's binary point */
static int32_t sixths(const fixed_mover *m, const fixed_stages *k, int i) {
    const int32_t middle = k->given[1][i] + k->given[2][i];
    return gained(m->third, k->given[0][i] + k->given[3][i] + 2 * middle);
}

static void end_step(fixed_run *run, const fixed_stages *k) {
    const fixed_plan *p = run->plan;
    const int angles = run->image->angles;
    for (int i = 0; i < p->coordinates; i++) {
        const fixed_mover *m = &p->mover[i];
        const int32_t added = sixths(m, k, i);
        int32_t more = added;
        if (p->second) {
            const int32_t three = k->given[0][i] + k->given[1][i] + k->given[2][i];
            more = wh_fixed_round(wh_fixed_add(2 * k->half_rate[i], gained(m->third_accel, three)),
                                  m->guard);
        }
        if (i < angles) {
            run->state.angle[i] += more;
        } else {
            add_limited(run, i - angles, more);
        }
        if (p->second) {
            add_limited(run, p->linears + i, added);
        }
    }
}

static wh_status advance(const wh_fixed_scene *scene, wh_fixed_state *state) {
    fixed_run *run = (fixed_run *)(uintptr_t)scene->model;
    const fixed_plan *p = run->plan;
    const int angles = run->image->angles;
    const int32_t *input = state->input;
    fixed_stages k = {0};
    for (int i = 0; i < angles; i++) {
        k.phase[i] = (uint32_t)state->angle[i];
    }
    for (int i = 0; i < p->coordinates && p->second; i++) {
        k.half_rate[i] = gained(p->mover[i].half_rate, state->real[p->linears + i]);
    }
    /* a first-order list reads no rates, so the pointer to rates is not used */
    evaluate(run, (fixed_at){k.phase, state->real, state->real + p->linears, input}, k.given[0]);
    for (int stage = 1; stage < 4; stage++) {
        go_to_stage(run, &k, stage);
        evaluate(run, (fixed_at){k.phase, k.linear, k.rate, input}, k.given[stage]);
    }
    end_step(run, &k);
    state->steps++;
    return WH_OK;
}

static void *run_start(const image *im) {
    const fixed_plan *p = im->fixed;
    fixed_run *run = alloc(1, sizeof *run);
    run->image = im;
    run->plan = p;
    run->value = alloc(p->list->count, sizeof *run->value);
    run->sine = alloc(p->list->count, sizeof *run->sine);
    run->cosine = alloc(p->list->count, sizeof *run->cosine);
    run->scene = (wh_fixed_scene){.name = im->name,
                                  .angles = (uint8_t)im->angles,
                                  .reals = (uint8_t)im->reals,
                                  .inputs = (uint8_t)im->inputs,
                                  .steps = im->steps,
                                  .format = p->format,
                                  .start_angle = p->start_angle,
                                  .start_real = p->start_real,
                                  .start_input = p->start_input,
                                  .model = run,
                                  .advance = advance};
    const size_t bytes = WH_FIXED_BYTES(im->angles, (size_t)im->reals + (size_t)im->inputs);
    run->memory = alloc((int64_t)(bytes + 7U) / 8, sizeof(uint64_t));
    if (wh_fixed_start(&run->scene, &run->state, run->memory, bytes) != WH_OK) {
        abort();
    }
    run->loss = fixed_loss_new(p, &run->state);
    run->observe = im->list[IMAGE_OBSERVE] != NULL ? evaluator_new(im->list[IMAGE_OBSERVE]) : NULL;
    if (run->observe != NULL) {
        evaluator_wrap(run->observe);
    }
    return run;
}

static void run_stop(void *of) {
    fixed_run *run = of;
    free(run->value);
    free(run->sine);
    free(run->cosine);
    free(run->memory);
    evaluator_free(run->observe);
    fixed_loss_free(run->loss);
    free(run);
}

static wh_status run_step(void *of) {
    fixed_run *run = of;
    fixed_loss_before(run->loss, &run->state);
    const wh_status status = wh_fixed_step(&run->scene, &run->state);
    fixed_loss_after(run->loss, &run->state);
    return status;
}

static void run_set_input(void *of, int input, double value) {
    fixed_run *run = of;
    const wh_fixed_format *f = &run->plan->format[run->image->reals + input];
    const double low = f->low;
    const double high = f->high;
    const double wished = number_nearest(number_scaled(value, f->bits));
    const double held = wished < low ? low : wished > high ? high : wished;
    /* up to one unit beyond an end counts as inside, as in wh_fixed_of() */
    run->state.saturated += wished < low - 1.0 || wished > high + 1.0;
    run->state.input[input] = (int32_t)held;
}

static void run_state(const void *of, double *angle_rad, double *real) {
    const fixed_run *run = of;
    for (int i = 0; i < run->scene.angles; i++) {
        angle_rad[i] = (double)run->state.angle[i] * RAD_PER_UNIT;
    }
    for (int i = 0; i < run->scene.reals; i++) {
        real[i] = number_scaled(run->state.real[i], -run->plan->format[i].bits);
    }
}

static void run_outputs(void *of, double *output) {
    const fixed_run *run = of;
    const image *im = run->image;
    double angle[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    double input[256];
    run_state(of, angle, real);
    for (int i = 0; i < im->inputs; i++) {
        input[i] = number_scaled(run->state.input[i], -run->plan->format[im->reals + i].bits);
    }
    if (run->observe != NULL) {
        evaluator_run(run->observe, ratio_times(run->state.steps, im->step), angle, real,
                      real + run->plan->linears, input, output);
    }
}

static uint64_t run_hash(const void *of) {
    const fixed_run *run = of;
    return wh_fixed_hash(&run->scene, &run->state);
}

static uint64_t run_steps(const void *of) { return ((const fixed_run *)of)->state.steps; }

static int run_fault(const void *of) {
    (void)of;
    return -1;
}

static uint64_t run_events(const void *of, uint64_t *overruns) {
    (void)of;
    *overruns = 0;
    return 0;
}

static int run_happened(const void *of, engine_event *list) {
    (void)of;
    (void)list;
    return 0;
}

static void run_modes(const void *of, int *mode) {
    (void)of;
    (void)mode;
}

static uint64_t run_evaluations(const void *of, uint64_t *most) {
    *most = 0;
    return 4 * run_steps(of);
}

static double run_component_off(const void *of, int i, double *span) {
    const component_loss *c = &((const fixed_run *)of)->loss->component[i];
    *span = c->high - c->low;
    return c->most;
}

static double run_unit(const void *of, int i) { return unit_of(((const fixed_run *)of)->plan, i); }

static uint64_t run_saturated(const void *of) { return ((const fixed_run *)of)->state.saturated; }

const engine_kind engine_fixed = {
    .name = "fixed",
    .digits = 9,
    .start = run_start,
    .stop = run_stop,
    .step = run_step,
    .set_input = run_set_input,
    .state = run_state,
    .outputs = run_outputs,
    .hash = run_hash,
    .steps = run_steps,
    .fault = run_fault,
    .events = run_events,
    .happened = run_happened,
    .modes = run_modes,
    .evaluations = run_evaluations,
    .component_off = run_component_off,
    .saturated = run_saturated,
    .unit = run_unit,
};
