#include "step_doubling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/engine/loop.h"
#include "host/number/functions.h"

#define EVALUATIONS_OF_EVENTS 8.0 /* estimated evaluations per step by the search for events */

/* --- other roundings of constants ---------------------------------------------------------------------*/
/* Sensitivity of a scene's accelerations to the round-off of its folded constants. Compares the scene's lists with
 * variants whose constants are folded with other roundings (host/number/folding.h). Most scenes need no variants. */

/* off[k * count + i]: error of variant k in component i. share[k] sums relative errors: components' units differ. */
static void add_shares(const double *off, int ways, int count, double *share) {
    for (int i = 0; i < count; i++) {
        double most = 0.0;
        for (int k = 0; k < ways; k++) {
            most = number_most(most, off[k * count + i]);
        }
        for (int k = 0; k < ways && most > 0.0; k++) {
            share[k] += off[k * count + i] / most;
        }
    }
}

static void evaluate_list(const image *im, image_role role, const double *x, double *value) {
    const state_list l = state_list_open(im, role);
    memcpy(value, state_list_at(&l, x, x + im->angles),
           (size_t)im->list[role]->results * sizeof *value);
    state_list_close(&l);
}

static void look_at_list(const image *im, image_role role, const double *x, double *share) {
    const int results = im->list[role] != NULL ? im->list[role]->results : 0;
    double *value = alloc((1 + (int64_t)im->ways) * results, sizeof *value);
    double *off = value + results;
    if (results > 0) {
        evaluate_list(im, role, x, value);
        for (int k = 0; k < im->ways; k++) {
            evaluate_list(im->refolded[k], role, x, off + (ptrdiff_t)k * results);
        }
        for (int i = 0; i < im->ways * results; i++) {
            const double now = fabs(off[i] - value[i % results]);
            off[i] = isfinite(now) ? now : 0.0; /* infinite at a pole: ignored */
        }
    }
    add_shares(off, im->ways, results, share);
    free(value);
}

static void compare_starts(const image *im, double *share) {
    const int n = im->angles + im->reals;
    double *off = alloc((int64_t)im->ways * n, sizeof *off);
    for (int i = 0; i < im->ways * n; i++) {
        off[i] = fabs(image_start(im->refolded[i / n], i % n) - image_start(im, i % n));
    }
    add_shares(off, im->ways, n, share);
    free(off);
}

/* Returns the variant whose results near the scene's start differ most from the scene's results, or NULL. */
static const image *constant_sensitivity_furthest(const image *im) {
    static const image_role roles[] = {IMAGE_STEP, IMAGE_SIGNALS, IMAGE_FORCES, IMAGE_SETS};
    const int n = im->angles + im->reals;
    double share[IMAGE_WAYS] = {0.0};
    if (im->ways == 0) {
        return NULL;
    }
    double *x = alloc(n, sizeof *x);
    compare_starts(im, share);
    for (int at = -1; at < n; at++) {
        /* the added 1 SI unit shows errors that a start value of zero would hide */
        for (int i = 0; i < n; i++) {
            x[i] = image_start(im, i) + (i == at ? 1.0 : 0.0);
        }
        for (size_t r = 0; r < sizeof roles / sizeof roles[0]; r++) {
            look_at_list(im, roles[r], x, share);
        }
    }
    free(x);
    int furthest = 0;
    for (int k = 1; k < im->ways; k++) {
        furthest = share[k] > share[furthest] ? k : furthest;
    }
    return im->refolded[furthest];
}

#define UNIT 0x1p-53 /* unit round-off of double */

/* An acceleration below this, in SI units, counts as zero: only round-off is left where terms cancel. */
#define LEAST_ACCELERATION 1e-9

double accelerations_doubt(const image *im, const double *angle_rad, const double *real,
                           int *worst) {
    const state_list own = state_list_open(im, IMAGE_BOOKS);
    const double *value = state_list_at(&own, angle_rad, real);
    double *off = alloc(im->list[IMAGE_BOOKS]->results, sizeof *off);
    evaluator_rounding(own.evaluator, angle_rad, 0.0, off);
    for (int i = 0; i < im->count; i++) {
        off[i] *= UNIT;
    }
    for (int k = 0; k < im->ways; k++) {
        const state_list l = state_list_open(im->refolded[k], IMAGE_BOOKS);
        const double *other = state_list_at(&l, angle_rad, real);
        for (int i = 0; i < im->count; i++) {
            off[i] = number_most(off[i], fabs(other[i] - value[i]));
        }
        state_list_close(&l);
    }
    double most = 0.0;
    *worst = 0;
    for (int i = 0; i < im->count; i++) {
        const double size = number_most(fabs(value[i]), off[i]);
        double part = size > LEAST_ACCELERATION ? off[i] / size : 0.0;
        if (!isfinite(size)) { /* other messages report values that are not finite */
            part = isfinite(value[i]) ? 1.0 : 0.0;
        }
        *worst = part > most ? i : *worst;
        most = number_most(most, part);
    }
    free(off);
    state_list_close(&own);
    return most;
}

/* --- the finer run's image ---------------------------------------------------------------------------*/

static whole_ratio half_of(whole_ratio step) {
    if (step.numerator % 2U == 0) {
        return (whole_ratio){step.numerator / 2U, step.denominator};
    }
    if (step.denominator < (uint64_t)1 << 59) {
        return (whole_ratio){step.numerator, 2U * step.denominator};
    }
    return ratio_of(0.5 * ratio_times(1, step));
}

/* The order of the run's method if the finer run has the same method; else 0. */
static int shared_order(const image *im) {
    const wh_method_row *row = &wh_methods[im->settings.method];
    return im->settings.matrix == MATRIX_NONE && row->order >= wh_methods[WH_METHOD_DEFAULT].order
               ? row->order
               : 0;
}

wh_method step_doubling_method(const image *im) {
    return shared_order(im) > 0 ? im->settings.method : WH_METHOD_DEFAULT;
}

/* A kink reduces the order to one, because the error of a step depends on the kink's place within it. */
int step_doubling_order(const image *im) {
    return op_list_has_kinks(im->list[IMAGE_STEP]) ? 1 : wh_methods[step_doubling_method(im)].order;
}

/* Replaces the finer run's constants by a variant. If both runs had the same ones, their round-off would not show. */
static void fold_the_other_way(image *im) {
    const image *other = constant_sensitivity_furthest(im);
    for (int role = 0; role < IMAGE_ROLES && other != NULL; role++) {
        const bool is_its_own = role != IMAGE_MATRIX || im->step_s == other->step_s;
        im->list[role] = is_its_own ? other->list[role] : im->list[role];
    }
    if (other != NULL && im->base == NULL) { /* a point of a sweep keeps its own start */
        im->start_rad = other->start_rad;
        im->start_turns = other->start_turns;
        im->start_real = other->start_real;
        im->input = other->input;
    }
}

static const image *of_finer(const image *im) { return im->finer != NULL ? im->finer : im; }

static void make_finer(step_doubling *t, const image *im) {
    t->finer = *of_finer(im);
    t->finer.fixed = NULL;
    fold_the_other_way(&t->finer);
    t->finer.settings.compensated = true;
    /* if both runs were stabilized, both would follow the same wrong motion */
    t->finer.settings.stabilized = false;
    t->each = 1;
    t->left_out = 1.0;
    if (im->settings.matrix == MATRIX_EXACT) {
        return;
    }
    t->finer.settings.method = step_doubling_method(im);
    t->finer.settings.matrix = MATRIX_NONE;
    t->finer.list[IMAGE_MATRIX] = NULL;
    t->finer.step = half_of(im->step);
    t->finer.step_s = ratio_times(1, t->finer.step);
    t->finer.steps = 2U * im->steps;
    t->each = 2;
    if (shared_order(im) > 0) {
        t->left_out = 1.0 / (1.0 - number_scaled(1.0, -step_doubling_order(im)));
    }
}

double step_doubling_finer_operations(const image *im) {
    const double each = im->settings.matrix == MATRIX_EXACT ? 1.0 : 2.0;
    return (double)im->steps * each * wh_methods[step_doubling_method(im)].stages *
           (double)engine_evaluation(of_finer(im));
}

double step_doubling_operations(const image *im) {
    const double stages = wh_methods[im->settings.method].stages;
    const double events = im->contacts > 0 ? EVALUATIONS_OF_EVENTS : 0.0;
    const double each = stages + 3.0 * events;
    return (double)im->steps * each * (double)engine_evaluation(im) +
           step_doubling_finer_operations(im);
}

/* --- passages -----------------------------------------------------------------------------------------*/

void passages_enter(passages *p, double before_s, double size) {
    const double now = isfinite(size) ? size : (double)INFINITY;
    if (!(now > p->most)) {
        return;
    }
    const double last = p->count > 0 ? p->passed[p->count - 1].size : 0.0;
    p->most = now;
    if (!(now > last * (1.0 + PASSAGE_GRAIN))) {
        return;
    }
    if (p->count == p->room) {
        p->room = p->room > 0 ? 2 * p->room : 64;
        p->passed = alloc_more(p->passed, p->room, sizeof *p->passed);
    }
    p->passed[p->count++] = (passage){before_s, now};
}

void passages_free(passages *p) {
    free(p->passed);
    *p = (passages){0};
}

double passages_until_s(const passages *p, double level) {
    for (int i = 0; i < p->count; i++) {
        if (p->passed[i].size > level) {
            return p->passed[i].time_s;
        }
    }
    return (double)INFINITY;
}

/* --- round-off alone ---------------------------------------------------------------------------------*/

typedef struct rounded {
    state_list list; /* IMAGE_STEP */
    double *off;
    double *most;   /* [results]: largest finite bound of the samples, in units of UNIT */
    uint64_t *lost; /* [results]: number of samples whose bound is not finite */
    uint64_t looks; /* number of samples */
} rounded;

static rounded *rounded_open(const image *im) {
    const int results = im->list[IMAGE_STEP]->results;
    rounded *r = alloc(1, sizeof *r);
    r->list = state_list_open(im, IMAGE_STEP);
    r->off = alloc(results, sizeof *r->off);
    r->most = alloc(results, sizeof *r->most);
    r->lost = alloc(results, sizeof *r->lost);
    return r;
}

static void rounded_look(rounded *r, const void *run) {
    const image *im = r->list.image;
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    engine_double.state(run, angle_rad, real);
    const double *result = state_list_at(&r->list, angle_rad, real);
    evaluator_rounding(r->list.evaluator, angle_rad, 0.0, r->off);
    for (int i = 0; i < im->list[IMAGE_STEP]->results; i++) {
        const component c = image_component(im, i);
        /* the highest derivatives come from solving the equations */
        const bool is_highest =
            im->form == WH_SECOND_ORDER || c.primes + 1 == im->unknown[c.unknown].order;
        r->off[i] += is_highest ? im->mass_blur / UNIT * fabs(result[i]) : 0.0;
        r->most[i] = isfinite(r->off[i]) ? number_most(r->most[i], r->off[i]) : r->most[i];
        r->lost[i] += isfinite(r->off[i]) ? 0U : 1U;
    }
    r->looks++;
}

static void rounded_close(rounded *r) {
    state_list_close(&r->list);
    free(r->off);
    free(r->most);
    free(r->lost);
    free(r);
}

/* The unknown's derivative of order `primes`: its index in the results of IMAGE_STEP, or -1. */
static int result_of(const image *im, int unknown, int primes) {
    if (im->form == WH_SECOND_ORDER) {
        return primes == 2 ? im->place[unknown] : -1;
    }
    return image_find_component(im, unknown, primes - 1);
}

/* Bounds a column's round-off: the round-off of its derivative (a later column), multiplied by the run's duration. */
static void take_rounding(step_doubling *t) {
    const rounded *r = t->rounded;
    for (int k = t->columns - 1; k > 0; k--) {
        const record_column *c = &t->shape->column[k];
        step_doubling_column *to = &t->column[k];
        double slope = 0.0;
        for (int i = k + 1; i < t->columns; i++) {
            const record_column *above = &t->shape->column[i];
            if (above->unknown == c->unknown && above->primes == c->primes + 1) {
                slope = t->column[i].rounding * above->unit->scale / above->unit->divisor;
            }
        }
        const int result = result_of(r->list.image, c->unknown, c->primes + 1);
        if (result >= 0) {
            /* Infinite bounds, as at a pole, count only if most samples have one. */
            slope += 2U * r->lost[result] > r->looks ? (double)INFINITY : UNIT * r->most[result];
        }
        const double size = number_most(fabs(to->low), fabs(to->high));
        to->rounding = image_shown(c->unit, slope * t->end_s) + UNIT * size;
    }
}

static double range_of(const step_doubling_column *c) { return c->high - c->low; }

static void take_places(step_doubling *t) {
    for (int k = 1; k < t->columns; k++) {
        const record_column *c = &t->shape->column[k];
        step_doubling_column *to = &t->column[k];
        to->place = k;
        to->one = image_shown(c->unit, 1.0);
        to->written = t->finer.unknown[c->unknown].start_written;
        for (int i = 1; i < t->columns; i++) {
            const record_column *other = &t->shape->column[i];
            to->has_rate =
                to->has_rate || (other->unknown == c->unknown && other->primes == c->primes + 1);
            to->place = other->unknown == c->unknown && other->primes == 0 ? i : to->place;
            if (other->primes == 0 && strcmp(other->unit->shown, c->unit->shown) == 0) {
                to->alike = number_most(to->alike, range_of(&t->column[i]));
            }
        }
    }
}

#define UNWRAPPED 0.9 /* an angle above this part of the sine's range may soon leave it */

/* --- side by side ------------------------------------------------------------------------------------*/

/* With contacts, a difference counts only if two successive comparisons find it. */
static void look(step_doubling *t, double time_s) {
    const image *im = t->shape->image;
    const bool events = im->contacts > 0 && im->steps > 1U;
    records_read(t->shape, t->run, time_s);
    records_read(t->finers, t->finer_run, time_s);
    for (int k = 1; k < t->columns; k++) {
        step_doubling_column *c = &t->column[k];
        const double value = t->finers->row[k];
        const double off = fabs(t->shape->row[k] - value);
        const double now = isfinite(off) ? off : (double)INFINITY;
        const double ranged = t->refolded ? t->shape->row[k] : value;
        c->start = t->looks == 0 ? value : c->start;
        if (t->cut_s < 0.0) { /* after cut_s the finer run may diverge */
            c->low = t->looks == 0 || ranged < c->low ? ranged : c->low;
            c->high = t->looks == 0 || ranged > c->high ? ranged : c->high;
        }
        if (events) {
            passages_enter(&c->off, t->before_s, number_least(now, c->last));
        } else {
            passages_enter(&c->off, t->look_s, now);
        }
        c->last = now;
    }
    if (t->looks % 64U == 0) {
        rounded_look(t->rounded, t->finer_run);
    }
    t->looks++;
    t->before_s = t->look_s;
    t->look_s = time_s;
}

static bool step_finer(step_doubling *t) {
    bool good = true;
    for (uint64_t i = 0; i < t->each && good; i++) {
        const uint64_t before = engine_operations;
        good = loop_steps(&engine_double, t->finer_run, 1) == WH_OK;
        t->operations += engine_operations - before;
    }
    return good;
}

/* Did the finer run fail because an angle left the range of double's sine? */
static bool is_unwrapped(const step_doubling *t) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    bool found = false;
    engine_double.state(t->finer_run, angle_rad, real);
    for (int i = 0; i < t->finer.angles && t->shape->kind == &engine_float; i++) {
        found = found || fabs(angle_rad[i]) > UNWRAPPED * ANGLE_SINE_MOST_RAD;
    }
    return found;
}

static bool has_overrun(const step_doubling *t) {
    uint64_t ours = 0;
    uint64_t finers = 0;
    t->shape->kind->events(t->run, &ours);
    engine_double.events(t->finer_run, &finers);
    return ours > 0 || finers > 0;
}

/* Steps the finer run to the end of the step that the run has just made. */
static void follow(step_doubling *t, uint64_t begin) {
    const bool failed = t->finer_failed_s < 0.0 && !step_finer(t);
    const bool overran = t->overrun_s < 0.0 && has_overrun(t);
    const bool leapt = t->jumped_s < 0.0 && pole_crossing_some(t->jumped);
    if (!failed && !overran && !leapt) {
        return;
    }
    const double begin_s = ratio_times(begin, t->shape->image->step);
    for (int k = 1; k < t->columns; k++) { /* from now on nothing is known */
        passages_enter(&t->column[k].off, t->look_s, (double)INFINITY);
    }
    t->cut_s = t->cut_s < 0.0 ? t->look_s : t->cut_s;
    if (failed) {
        t->finer_failed_s = begin_s;
        t->unwrapped = is_unwrapped(t);
    }
    t->overrun_s = overran ? begin_s : t->overrun_s;
    if (leapt) {
        t->jumped_s = begin_s;
        t->missed = pole_crossing_through(t->jumped).what >= 0;
    }
}

void step_doubling_enter(step_doubling *t) {
    const image *im = t->shape->image;
    const uint64_t step = t->shape->kind->steps(t->run);
    if (step > 0) {
        follow(t, step - 1U);
    }
    if (step == 0 || (t->finer_failed_s < 0.0 && (step % t->stride == 0 || step == im->steps))) {
        look(t, ratio_times(step, im->step));
    }
}

step_doubling *step_doubling_open(const image *im, const engine_kind *kind, void *run,
                                  const pole_crossing *jumped) {
    step_doubling *t = alloc(1, sizeof *t);
    make_finer(t, im);
    t->refolded = im->ways > 0;
    t->shape = records_open(NULL, im, kind);
    t->columns = t->shape->columns - im->own_outputs;
    t->column = alloc(t->columns, sizeof *t->column);
    t->finer_failed_s = -1.0;
    t->overrun_s = -1.0;
    t->cut_s = -1.0;
    t->jumped_s = -1.0;
    t->run = run;
    t->jumped = jumped;
    t->finers = records_open(NULL, &t->finer, &engine_double);
    t->finer_run = engine_double.start(&t->finer);
    t->rounded = rounded_open(&t->finer);
    t->stride = 1U + (im->steps - (im->steps > 0)) / STEP_DOUBLING_LOOKS;
    return t;
}

void step_doubling_end(step_doubling *t, wh_status status) {
    t->status = status;
    t->end_s = ratio_times(t->shape->kind->steps(t->run), t->shape->image->step);
    take_rounding(t);
    take_places(t);
}

void step_doubling_free(step_doubling *t) {
    if (t == NULL) {
        return;
    }
    rounded_close(t->rounded);
    records_close(t->finers);
    engine_double.stop(t->finer_run);
    for (int k = 0; k < t->columns; k++) {
        passages_free(&t->column[k].off);
    }
    records_close(t->shape);
    free(t->column);
    free(t);
}
