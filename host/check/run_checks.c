#include "run_checks.h"

#include <math.h>
#include <stdlib.h>

#include "apart.h"
#include "horizon.h"
#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "slow.h"

#define UNLIMITED ((uint64_t)1 << 62) /* more operations than any run takes */

static run_checks *checks_of(const image *im, const engine_kind *kind, void *run, budget *of,
                             bool whole) {
    run_checks *v = alloc(1, sizeof *v);
    v->whole = whole;
    v->own.own = whole ? UNLIMITED : 0;
    v->image = im;
    v->kind = kind;
    v->run = run;
    v->part = 1.0;
    v->budget = of != NULL ? of : &v->own;
    v->books = books_open(im);
    v->jumped = pole_crossing_open(im);
    if (whole || (im->steps > 0 && step_doubling_finer_operations(im) <= budget_left(v->budget))) {
        v->doubling = step_doubling_open(im, kind, run, v->jumped);
    }
    return v;
}

run_checks *run_checks_open(const image *im, const engine_kind *kind, void *run, budget *of) {
    return checks_of(im, kind, run, of, false);
}

void run_checks_close(run_checks *v) {
    if (v != NULL) {
        step_doubling_free(v->doubling);
        pole_crossing_close(v->jumped);
        books_close(v->books);
        if (v->whole) {
            v->kind->stop(v->run);
        }
        free(v);
    }
}

/* Counts steps with too many events, and the contacts of these events. */
static void watch_events(run_checks *v) {
    uint64_t overruns;
    const double energy_J = v->books != NULL ? v->books->energy_J[1] : 0.0;
    v->kind->events(v->run, &overruns);
    if (overruns > v->overruns) {
        engine_event event[WH_EVENT_LOG];
        const int count = v->kind->happened(v->run, event);
        const uint64_t begin = v->kind->steps(v->run) - 1U;
        v->overran_s = v->overruns == 0 ? ratio_times(begin, v->image->step) : v->overran_s;
        v->overruns = overruns;
        v->taken_J += fabs(energy_J - v->energy_J);
        for (int i = 0; i < count; i++) {
            v->in_overruns[event[i].contact]++;
        }
    }
    v->energy_J = energy_J;
}

/* Remaining budget / BUDGET_LEAST, minus the remaining share of the steps. Below 0, poles are not searched. */
static double part_left(const run_checks *v) {
    const double come = (double)(v->image->steps - v->kind->steps(v->run));
    const double share = v->budget == &v->own ? come / (double)(v->image->steps + 1U) : 0.0;
    return budget_left(v->budget) / BUDGET_LEAST - share;
}

#define BEHIND (-1.0 / 16.0) /* if part_left() is below this, the finer run ends */

void run_checks_enter(run_checks *v) {
    budget_begin(v->budget);
    if (v->books != NULL) {
        books_enter(v->books, v->kind, v->run);
    }
    if (v->image->contacts > 0) {
        watch_events(v);
    }
    if (part_left(v) >= 0.0) {
        pole_crossing_enter(v->jumped, v->kind, v->run);
    } else {
        pole_crossing_pass(v->jumped);
    }
    if (part_left(v) < BEHIND) {
        step_doubling_free(v->doubling);
        v->doubling = NULL;
    }
    if (v->doubling != NULL) {
        step_doubling_enter(v->doubling);
    }
    budget_end(v->budget);
}

/* --- judging -----------------------------------------------------------------------------------------------*/

/* Reports a finding. FINDING_MASS is only a note if its value is at most HORIZON_TOLERANCE. */
static void tell(run_checks *v, finding_id id, double value, double at_s, int of) {
    const bool is_note = finding_rows[id].severity == FINDING_NOTE ||
                         (id == FINDING_MASS && value <= HORIZON_TOLERANCE);
    v->found[id] = (finding){true, value, at_s, of};
    v->warned |= is_note ? 0U : FINDING_BIT(id);
}

/* Is the run accurate to its end, compared with the finer run? */
static bool is_right(const run_checks *v) {
    if (v->doubling == NULL) {
        return false;
    }
    horizon h = horizon_of(v->doubling, HORIZON_TOLERANCE);
    const bool right = h.to_the_end;
    horizon_free(&h);
    return right;
}

/* A residual below the error of the integration rule is not reported if the finer run agrees with the run. */
static void judge_energy(run_checks *v) {
    const energy_residual *b = &v->balance;
    if (!b->known || b->exact) {
        if (energy_residual_lost(b, v->part * finding_rows[FINDING_ENERGY].limit)) {
            tell(v, FINDING_ENERGY, b->ratio, -1.0, -1);
        }
        return;
    }
    const double way_J = v->image->contacts == 0 ? v->books->most_J : 0.0;
    const bool on_the_way =
        way_J > v->part * RUN_CHECKS_ON_THE_WAY * b->largest_J && way_J > b->rounding_J;
    const bool in_doubt = number_most(fabs(b->left_J), way_J) <= books_rule_J(v->books);
    const bool by_the_rule = v->image->contacts == 0 && in_doubt && is_right(v);
    const bool is_lost = energy_residual_lost(b, v->part * finding_rows[FINDING_ENERGY].limit);
    const bool is_reported = (is_lost || on_the_way) && !by_the_rule;
    if (is_reported) {
        tell(v, FINDING_ENERGY, number_most(b->ratio, on_the_way ? way_J / b->largest_J : 0.0),
             b->jump_s, -1);
    }
}

/* In float, a coordinate is not judged if its share of the energy is below this. */
#define FAINT 0x1p-48

static bool is_faint(const run_checks *v, int unknown) {
    const step_doubling *t = v->doubling;
    const int rate = image_find_component(v->image, unknown, 1);
    if (v->books == NULL || v->kind != &engine_float || rate < 0) {
        return false;
    }
    double own = 0.0;
    double fastest = 0.0;
    for (int k = 1; k < t->columns; k++) {
        const record_column *c = &t->shape->column[k];
        const step_doubling_column *at = &t->column[k];
        if (c->unknown == unknown && c->primes == 1) {
            own = number_most(fabs(at->low), fabs(at->high)) / at->one;
            fastest = number_most(own, at->off.most / at->one);
        }
    }
    const double mass = books_momentum(v->books, unknown) / own;
    return own > 0.0 && mass > 0.0 && mass * fastest * fastest < FAINT * v->books->size_J;
}

/* Is column k an angle of a float run, with an error of at most SLOW_LEAST_RAD? */
static bool is_of_units(const run_checks *v, int k, const horizon_column *c) {
    const step_doubling_column *t = &v->doubling->column[k];
    const int own = image_find_component(v->image, v->doubling->shape->column[k].unknown, 0);
    return v->kind == &engine_float && v->doubling->shape->column[k].primes == 0 && own >= 0 &&
           own < v->image->angles && c->off <= SLOW_LEAST_RAD * t->one;
}

/* Is column k judged? With contacts, rates are not: an impact may be in different steps of the two runs. */
static bool is_asked(const run_checks *v, int k) {
    const record_column *c = &v->doubling->shape->column[k];
    return (v->image->contacts == 0 || c->primes == 0) && horizon_moves(v->doubling, k) &&
           !is_faint(v, c->unknown);
}

static bool is_worse(const horizon_column *a, const horizon_column *b) {
    return a->until_s < b->until_s ||
           (a->until_s == b->until_s && a->off * b->range > b->off * a->range);
}

/* The rule of FINDING_ACCURACY in finding.h. */
static bool is_off(const run_checks *v, double until_s, double early_s) {
    return early_s <= RUN_CHECKS_BEGIN * v->doubling->end_s ||
           until_s >= RUN_CHECKS_GROWS * early_s;
}

/* Did the error of a position grow within a few steps? Errors of a resolved chaotic motion grow more slowly. */
static bool is_sudden(const run_checks *v, int k, double until_s, double early_s) {
    const double steps_s = RUN_CHECKS_SUDDEN_STEPS * v->image->step_s;
    return v->image->contacts == 0 && v->doubling->shape->column[k].primes == 0 &&
           early_s > 2.0 * steps_s && until_s - early_s <= steps_s;
}

/* Returns the column with the first error above the tolerance, or -1. Sets *until_s to the time of this error. */
static int first_error(const run_checks *v, bool sudden, double *until_s) {
    const double tolerance = sudden ? HORIZON_TOLERANCE : RUN_CHECKS_TOLERANCE;
    const double early_tolerance =
        sudden ? HORIZON_TOLERANCE / RUN_CHECKS_SUDDEN : RUN_CHECKS_EARLY_TOLERANCE;
    int found = -1;
    horizon h = horizon_of(v->doubling, v->part * tolerance);
    horizon early = horizon_of(v->doubling, v->part * early_tolerance);
    for (int k = 1; k < v->doubling->columns; k++) {
        const horizon_column *c = &h.column[k];
        const double early_s = early.column[k].until_s;
        if (c->verdict == HORIZON_UNTIL && is_asked(v, k) && !is_of_units(v, k, c) &&
            (sudden ? is_sudden(v, k, c->until_s, early_s) : is_off(v, c->until_s, early_s)) &&
            (found < 0 || is_worse(c, &h.column[found]))) {
            found = k;
            *until_s = c->until_s;
        }
    }
    horizon_free(&h);
    horizon_free(&early);
    return found;
}

/* An error that begins at or after cut_s is reported only if the finer run failed. */
static void judge_accuracy(run_checks *v) {
    const step_doubling *t = v->doubling;
    double until_s = 0.0;
    int k = first_error(v, false, &until_s);
    const bool is_cut = t->cut_s >= 0.0 && until_s >= t->cut_s && t->finer_failed_s < 0.0;
    if (k < 0 || is_cut || !(until_s < finding_rows[FINDING_ACCURACY].limit * t->end_s)) {
        k = t->cut_s >= 0.0 ? -1 : first_error(v, true, &until_s);
    }
    if (k >= 0) {
        tell(v, FINDING_ACCURACY, until_s / t->end_s, until_s, k);
    }
}

static void judge_events(run_checks *v) {
    const double steps = (double)v->kind->steps(v->run);
    const bool rests = v->taken_J <= RUN_CHECKS_RESTS * v->balance.largest_J &&
                       (double)v->overruns <= 1.0 + RUN_CHECKS_RESTS_STEPS * steps;
    if (v->overruns > 0 && !(v->balance.known && rests)) {
        tell(v, FINDING_EVENTS, (double)v->overruns, v->overran_s, -1);
    }
}

static void judge(run_checks *v) {
    if (v->image->mass_blur > finding_rows[FINDING_MASS].limit) {
        tell(v, FINDING_MASS, v->image->mass_blur, -1.0, -1);
    }
    if (v->image->unbounded) {
        tell(v, FINDING_CONSTANTS, 1.0, -1.0, -1);
    }
    judge_energy(v);
    if (v->doubling != NULL && v->kind->steps(v->run) > 0) {
        const step_doubling_aliased *aliased = &v->doubling->aliased;
        if (aliased->column > 0) {
            tell(v, FINDING_ALIASED, aliased->part, aliased->at_s, aliased->column);
        } else {
            judge_accuracy(v);
        }
    }
    if (pole_crossing_some(v->jumped)) {
        const missed_found through = pole_crossing_through(v->jumped);
        tell(v, through.what >= 0 ? FINDING_MISSED : FINDING_POLE,
             through.what < 0 || through.sure ? 1.0 : 0.5, pole_crossing_begin_s(v->jumped),
             through.what);
    }
    judge_events(v);
    const double part = apart_say(NULL, NULL, v->image);
    if (part > 0.0) {
        tell(v, FINDING_APART, part, 0.0, -1);
    }
    double slow;
    if (slow_count(v->kind, v->image, v->run, &slow) > 0) {
        tell(v, FINDING_DIGITS, slow, -1.0, -1);
    }
}

void run_checks_end(run_checks *v, wh_status status) {
    budget_begin(v->budget);
    if (v->doubling != NULL) {
        step_doubling_end(v->doubling, status);
        aliasing_find(v->doubling, v->budget);
    }
    v->balance = energy_residual_of(v->books, v->kind, v->run);
    if (status == WH_OK) {
        judge(v);
    }
    budget_end(v->budget);
}

/* --- a whole run ----------------------------------------------------------------------------------------*/

typedef struct observer {
    run_checks *checks;
    void (*progress)(double share, void *context);
    void *context;
} observer;

static bool see(void *of, uint64_t step) {
    const observer *o = of;
    const uint64_t steps = o->checks->image->steps;
    run_checks_enter(o->checks);
    if ((step & 255U) == 0 && o->progress != NULL) {
        o->progress((double)step / (double)(steps + (steps == 0)), o->context);
    }
    return true;
}

run_checks *run_checks_whole(const image *im, const engine_kind *kind,
                             void (*progress)(double share, void *context), void *context) {
    observer o = {checks_of(im, kind, kind->start(im), NULL, true), progress, context};
    const loop l = {.kind = kind, .run = o.checks->run, .steps = im->steps, .see = see, .of = &o};
    wh_status status;
    o.checks->interrupted = loop_run(&l, &status) == LOOP_INTERRUPTED;
    run_checks_end(o.checks, status);
    return o.checks;
}

unsigned run_checks_fails(const run_checks *v, double strict) {
    const unsigned energy = FINDING_BIT(FINDING_ENERGY);
    return strict == STRICT_FINDINGS ? v->warned
           : strict < 0.0
               ? 0U
               : (v->warned & ~energy) | (energy_residual_lost(&v->balance, strict) ? energy : 0U);
}

unsigned run_checks_unlooked(const run_checks *v) {
    const unsigned jumps = FINDING_BIT(FINDING_POLE) | FINDING_BIT(FINDING_MISSED);
    const unsigned finer = FINDING_BIT(FINDING_ACCURACY);
    const bool unaliased = v->doubling == NULL || v->doubling->unaliased;
    return v->image->steps == 0 ? 0U
                                : (pole_crossing_unseen(v->jumped) > 0 ? jumps : 0U) |
                                      (v->doubling == NULL ? finer : 0U) |
                                      (unaliased ? FINDING_BIT(FINDING_ALIASED) : 0U);
}
