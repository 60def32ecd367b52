#include "pole_crossing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "denominators.h"
#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "pole.h"

/* No test if the way to a pole is less than this part of the moving value, where only round-off grows. */
#define RESOLVED 2e-13

struct pole_crossing {
    const image *image;
    int components;
    denominators of;
    double *from; /* [components] angles, then reals: the state before the step, */
    double *to;   /* and after it */
    uint64_t events;
    bool leapt; /* in this step there were some */
    bool blind; /* the state before it is not known */
    uint64_t unseen;
    missed *contacts;
    int found; /* a question, or -1 */
    missed_found through;
    double found_s;
};

pole_crossing *pole_crossing_open(const image *im) {
    pole_crossing *j = alloc(1, sizeof *j);
    j->image = im;
    j->components = im->angles + im->reals;
    j->of = denominators_open(im);
    j->contacts = missed_open(im);
    j->found = -1;
    j->through = MISSED_NOTHING;
    j->from = alloc(j->components, sizeof *j->from);
    j->to = alloc(j->components, sizeof *j->to);
    if (j->of.count == 0 && j->contacts == NULL) {
        pole_crossing_close(j);
        return NULL;
    }
    return j;
}

void pole_crossing_close(pole_crossing *j) {
    if (j != NULL) {
        missed_close(j->contacts);
        denominators_close(&j->of);
        free(j->from);
        free(j->to);
        free(j);
    }
}

/* --- the way of a step --------------------------------------------------------------------------------*/

/* Rates that jump at an impact pass through no pole. */
static bool counts(const pole_crossing *j, const divisor *d) { return !(j->leapt && d->leaps); }

/* How far this component goes in the step: turn angles are given within a turn. */
static double way_of(const pole_crossing *j, int i) {
    const double way = j->to[i] - j->from[i];
    return i < j->image->angles ? number_centred(way, 6.283185307179586) : way;
}

static void state_at(const pole_crossing *j, double share,
                     double state[static 3 * IMAGE_COMPONENTS_MAX]) {
    for (int i = 0; i < j->components; i++) {
        state[i] = j->from[i] + share * way_of(j, i);
    }
}

static void go_to(void *of, double share, double *sign, double *value) {
    pole_crossing *j = of;
    double state[3 * IMAGE_COMPONENTS_MAX];
    state_at(j, share, state);
    denominators_see_all(&j->of, state, value);
    for (int i = 0; i < j->of.count; i++) {
        const divisor *d = &j->of.divisor[i];
        sign[i] = counts(j, d) ? denominators_value(&j->of, d) : 0.0;
    }
}

/* How far this component goes in the step, as a part of itself. */
static double relative_way_of(const pole_crossing *j, int c) {
    const double size = number_most(fabs(j->from[c]), fabs(j->to[c]));
    return size > 0.0 ? fabs(way_of(j, c)) / size : 0.0;
}

/* The largest relative way of the components that this divisor depends on; a derived divisor may
 * depend on any. */
static double relative_way(const pole_crossing *j, const divisor *d) {
    double most = 0.0;
    for (int c = 0; c < j->components && d->derived; c++) {
        most = number_most(most, relative_way_of(j, c));
    }
    if (d->derived) {
        return most;
    }
    bool *of = blamed_parts(j->image, d->node);
    for (int i = 0; i <= d->node; i++) {
        const diagnostics_node *n = &j->image->blame.node[i];
        if (of[i] && n->code == DIAGNOSTICS_STATE) {
            most =
                number_most(most, relative_way_of(j, image_find_component(j->image, n->a, n->b)));
        }
    }
    free(of);
    return most;
}

/* The first question with a pole on the way, or -1. */
static int pole_between(pole_crossing *j) {
    double *nearest = alloc(j->of.count, sizeof *nearest);
    for (int i = 0; i < j->of.count; i++) {
        nearest[i] = RESOLVED / relative_way(j, &j->of.divisor[i]);
    }
    const int value = pole_on(&(pole_way){.of = j,
                                          .signs = j->of.count,
                                          .values = denominators_values(&j->of),
                                          .nearest = nearest,
                                          .at = go_to});
    free(nearest);
    return value >= 0 ? denominators_question(&j->of, value) : -1;
}

/* --- step by step ------------------------------------------------------------------------------------*/

static bool had_events(pole_crossing *j, const engine_kind *kind, const void *run) {
    uint64_t overruns = 0;
    const uint64_t events = kind->events(run, &overruns) + overruns;
    const bool some = events != j->events;
    j->events = events;
    return some;
}

static bool changes_sign(const divisor *d) {
    return (d->before < 0.0 && d->now > 0.0) || (d->before > 0.0 && d->now < 0.0);
}

/* May a nonlinear one have touched zero without a change of sign? */
static bool may_touch(pole_crossing *j) {
    double state[3 * IMAGE_COMPONENTS_MAX];
    if (!j->of.some_bend) {
        return false;
    }
    state_at(j, POLE_ASIDE, state);
    denominators_see(&j->of, state);
    for (int i = 0; i < j->of.count; i++) {
        j->of.divisor[i].aside = denominators_value(&j->of, &j->of.divisor[i]);
    }
    state_at(j, 1.0 - POLE_ASIDE, state);
    denominators_see(&j->of, state);
    bool may = false;
    for (int i = 0; i < j->of.count && !may; i++) {
        const divisor *d = &j->of.divisor[i];
        const double value[4] = {d->before, d->aside, denominators_value(&j->of, d), d->now};
        may = d->bends && counts(j, d) && pole_may_touch(value);
    }
    return may;
}

void pole_crossing_enter(pole_crossing *j, const engine_kind *kind, const void *run) {
    if (pole_crossing_some(j) || j == NULL) {
        return;
    }
    const uint64_t steps = kind->steps(run);
    bool changed = false;
    j->leapt = had_events(j, kind, run);
    j->through = missed_enter(j->contacts, kind, run, j->leapt, j->blind);
    j->found_s = j->through.what >= 0 ? ratio_times(steps - 1, j->image->step) : 0.0;
    memcpy(j->from, j->to, (size_t)j->components * sizeof *j->to);
    kind->state(run, j->to, j->to + j->image->angles);
    denominators_see(&j->of, j->to);
    for (int i = 0; i < j->of.count; i++) {
        divisor *d = &j->of.divisor[i];
        d->before = d->now;
        d->now = denominators_value(&j->of, d);
        changed = changed || (changes_sign(d) && counts(j, d));
    }
    const bool looks = steps > 0 && !j->blind;
    j->unseen += j->blind ? 1U : 0U;
    j->blind = false;
    if (looks && j->through.what < 0 && (changed || may_touch(j))) {
        j->found = pole_between(j);
        j->found_s = ratio_times(steps - 1, j->image->step);
    }
}

void pole_crossing_pass(pole_crossing *j) {
    if (j != NULL && !pole_crossing_some(j)) { /* the start is no step */
        j->blind = true;
        j->unseen++;
    }
}

uint64_t pole_crossing_unseen(const pole_crossing *j) { return j != NULL ? j->unseen : 0; }

bool pole_crossing_some(const pole_crossing *j) {
    return j != NULL && (j->found >= 0 || j->through.what >= 0);
}

missed_found pole_crossing_through(const pole_crossing *j, double *begin_s) {
    *begin_s = j != NULL ? j->found_s : 0.0;
    return j != NULL ? j->through : MISSED_NOTHING;
}

const diagnostics_question *pole_crossing_over(const pole_crossing *j, double *begin_s) {
    *begin_s = j->found_s;
    return &j->image->blame.question[j->found];
}
