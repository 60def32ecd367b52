/* digits.c: see digits.h. */
#include "digits.h"

#include <math.h>

#include "again.h"
#include "host/number/functions.h"
#include "judged.h"

/* Off by this part of a range is told; of the energy, of its largest entry. */
#define PART_TOLD 1e-2
/* What compensated sums may leave, to be named: their lists are others than those at hand, and round a little otherwise. */
#define PART_CURED 3e-3
/* And more than their digits are off: else it would be told of them, too. */
#define PART_QUIET 8e-3
/* What more digits leave of the energy, and how much of the largest entry they have at least. */
#define PART_KEPT 1e-3
#define ENTRY_KEPT 0.3
/* Of what the slopes asked for, a motion that more digits have, too; and of all that the run did: less is rounding's own. */
#define ASKED_KEPT 0.1
#define RANGE_KEPT 1e-3
/* What hardly varies, of the size that it has: of a rate; a motion that is none; and what energy goes to and fro that is. */
#define RATE_LEAST 1e-3
#define MOTION_LEAST 3e-7
#define SWING_LEAST 1e-7
/* Last places that a sum may be off anyway. */
#define PLACES_LEAST 4.0
/* What computing an energy may be off, in so many of its bounds. */
#define COMPUTING_MORE 4.0
/* So many times further away than it moves, a place has rates whose terms are larger by as much or its square: its steps may
 * be what its slopes ask for, and these are wrong. */
#define FAR_FLOAT 30.0
#define FAR_DOUBLE 1e5
/* So far away squares have no digits left in double either; and what moves by so little of its distance stands still. */
#define NONE_DOUBLE 1e7
#define STILL_DOUBLE 1e12
/* What may be spent on a run again. */
#define OPERATIONS_MOST 1e8

/* --- what is suspected ---------------------------------------------------------------------------------------*/

static double furthest(const watch *w, int i) {
    return number_most(fabs(w->low[i]), fabs(w->high[i]));
}

/* The distance of numbers of this kind at that size. */
static double place_at(const engine_kind *kind, double size) {
    int exponent;
    (void)number_split(size, &exponent);
    return size > 0.0 ? number_scaled(1.0, exponent - (kind == &engine_float ? 24 : 53)) : 0.0;
}

static double asked_range(const watch *w, int i) { return w->asked_high[i] - w->asked_low[i]; }

/* What a component is measured by, which has such a range. */
static double measure(const watch *w, int i, double range) {
    const bool rate = image_component(w->field->image, i).primes > 0;
    return rate ? number_most(range, RATE_LEAST * furthest(w, i)) : range;
}

/* How far the number puts it off where it starts. */
static double start_off(const image *im, const engine_kind *kind, int i) {
    if (kind != &engine_float || i < im->angles) {
        return 0.0;
    }
    const double start = im->start_real[i - im->angles];
    return fabs(start - (double)(float)start);
}

/* How far its own steps were from what its slopes asked for; 0 for what a last place may be off. A float's turn angles are
 * slow.h's. */
static double strayed(const image *im, const engine_kind *kind, const watch *w, int i) {
    const bool told_elsewhere = kind == &engine_float && i < im->angles;
    const double least = PLACES_LEAST * place_at(kind, furthest(w, i));
    return told_elsewhere || !(w->strayed[i] > least) ? 0.0 : w->strayed[i];
}

static bool loses(const engine_kind *kind, const belief *b, double told) {
    return kind == &engine_float && b->known && !b->slow && fabs(b->left_J) > told * b->entry_J &&
           b->entry_J > SWING_LEAST * b->size_J &&
           fabs(b->left_J) > COMPUTING_MORE * b->computing_J;
}

static bool is_far(const image *im, const engine_kind *kind, const watch *w, int i) {
    const component c = image_component(im, i);
    const double times = kind == &engine_float ? FAR_FLOAT : FAR_DOUBLE;
    return i >= im->angles && image_find_component(im, c.unknown, c.primes + 1) >= 0 &&
           furthest(w, i) > times * (w->high[i] - w->low[i]);
}

bool digits_far(const image *im, const engine_kind *kind, const watch *w) {
    bool found = false;
    for (int i = 0; i < w->field->n; i++) {
        found = found || is_far(im, kind, w, i);
    }
    return found;
}

bool digits_none(const image *im, const engine_kind *kind, const watch *w) {
    bool found = false;
    for (int i = 0; i < w->field->n && kind == &engine_double; i++) {
        const double times = furthest(w, i) / (w->high[i] - w->low[i]);
        found = found || (is_far(im, kind, w, i) && times > NONE_DOUBLE && times < STILL_DOUBLE);
    }
    return found;
}

static bool is_suspect(const image *im, const engine_kind *kind, const watch *w, const belief *b) {
    bool found = loses(kind, b, PART_TOLD) || digits_far(im, kind, w);
    for (int i = 0; i < w->field->n; i++) {
        const double range = w->high[i] - w->low[i];
        found = found || strayed(im, kind, w, i) > PART_TOLD * measure(w, i, asked_range(w, i)) ||
                start_off(im, kind, i) > PART_TOLD * measure(w, i, range);
    }
    return found;
}

/* --- what the other run bears out ----------------------------------------------------------------------------*/

/* It, and what it is a rate of. */
static bool is_motion(const image *im, const watch *w, int i) {
    const component c = image_component(im, i);
    const int home = image_find_component(im, c.unknown, 0);
    return w->high[i] - w->low[i] > MOTION_LEAST * furthest(w, i) &&
           w->high[home] - w->low[home] > MOTION_LEAST * furthest(w, home);
}

/* At the records. */
static double apart(const watch *w, const watch *other, int i) {
    const int n = w->field->n;
    double most = 0.0;
    for (int k = 0; k < w->records && w->records == other->records; k++) {
        most = number_most(most, fabs(w->record[k * n + i] - other->record[k * n + i]));
    }
    return most;
}

/* Trapezoids leave the same in both. What strays is off by what the records are apart, too, wherever it is. */
static void judge_component(const image *im, const engine_kind *kind, const watch *w,
                            const watch *other, int i, double told, digits *d) {
    const double range = other->high[i] - other->low[i];
    const double by = measure(other, i, range);
    const double far = strayed(im, kind, w, i) - other->strayed[i];
    const double last_place = place_at(kind, furthest(other, i));
    const bool by_sums = far <= (double)im->steps * last_place;
    const double stray =
        range >= ASKED_KEPT * asked_range(w, i) && (by_sums || kind == &engine_float) ? far : 0.0;
    const double step_off = number_most(stray, start_off(im, kind, i));
    const bool asks = told >= PART_TOLD && (digits_far(im, kind, w) || step_off > told * by);
    const double off = asks ? number_most(step_off, apart(w, other, i)) : step_off;
    const bool moves = range > RANGE_KEPT * (w->high[i] - w->low[i]) &&
                       (is_motion(im, other, i) || kind == &engine_double);
    if (moves && off > told * by && (d->component < 0 || off / by > d->off / d->range)) {
        d->component = i;
        d->off = off;
        d->range = by;
        d->place = last_place;
        /* once it is told, few places count, too */
        d->by_sums = step_off > told * by || w->strayed[i] - other->strayed[i] > told * by;
    }
}

static bool keeps(const belief *more, const belief *few) {
    return more->known && fabs(more->left_J) < PART_KEPT * more->entry_J &&
           more->entry_J > ENTRY_KEPT * few->entry_J;
}

static digits judge_all(const image *im, const engine_kind *kind, const watch *w, const belief *b,
                        const again *more, double told) {
    digits d = {.component = -1};
    for (int i = 0; i < w->field->n; i++) {
        judge_component(im, kind, w, more->watch, i, told, &d);
    }
    d.energy = loses(kind, b, told) && keeps(&more->balance, b);
    d.left_J = b->left_J;
    d.part = b->entry_J > 0.0 ? fabs(b->left_J) / b->entry_J : 0.0;
    return d;
}

/* At every record, all of it is where the better run is, and nothing would be told of it, its energies included. */
static bool goes_along(const again *a, const again *better) {
    const watch *w = a->watch;
    const int n = w->field->n;
    judged j = judged_of(&a->image, a->kind, w, &a->balance);
    bool along = a->done && w->records == better->watch->records && !judged_energy(&j);
    for (int i = 0; i < n; i++) {
        const double by = measure(better->watch, i, better->watch->high[i] - better->watch->low[i]);
        for (int k = 0; k < w->records && along; k++) {
            along =
                fabs(w->record[k * n + i] - better->watch->record[k * n + i]) <=
                number_least(PART_CURED * by + place_at(a->kind, furthest(w, i)), PART_QUIET * by);
        }
    }
    if (along) {
        const digits d = judge_all(&a->image, a->kind, w, &a->balance, better, PART_CURED);
        along = d.component < 0 && !d.energy;
    }
    return along;
}

/* The run as it would be so. */
static bool would_do(const image *im, const engine_kind *kind, const again *better,
                     const volatile sig_atomic_t *stop) {
    again a;
    again_run(&a, im, kind, stop);
    const bool along = goes_along(&a, better);
    again_forget(&a);
    return along;
}

digits digits_of(const image *im, const engine_kind *kind, const watch *w, const belief *b,
                 const volatile sig_atomic_t *stop) {
    digits d = {.component = -1};
    const bool is_float = kind == &engine_float;
    if (!w->smooth || w->steps < im->steps || (!is_float && kind != &engine_double) ||
        (!is_float && im->settings.compensated) || !is_suspect(im, kind, w, b)) {
        return d;
    }
    if (!((double)im->steps * again_operations_a_step(im) <= OPERATIONS_MOST)) {
        d.not_known = true;
        return d;
    }
    image summed = *im;
    summed.settings.compensated = true;
    again more;
    again_run(&more, &summed, &engine_double, stop);
    if (more.done) {
        d = judge_all(im, kind, w, b, &more, PART_TOLD);
        d.compensated = !is_float && d.component >= 0 && d.by_sums;
    }
    if (is_float && (d.energy || d.component >= 0)) {
        judged j = judged_of(&summed, &engine_double, more.watch, &more.balance);
        d.in_both = !judged_energy(&j);
        d.compensated = !im->settings.compensated && would_do(&summed, kind, &more, stop);
        d.in_double = would_do(im, &engine_double, &more, stop);
    }
    again_forget(&more);
    return d;
}

/* A rate is off for what its acceleration is made of where its own sums do not explain it. */
static void say_component(FILE *out, const image *im, const char *kind, const digits *d) {
    const component c = image_component(im, d->component);
    const image_unknown *u = &im->unknown[c.unknown];
    const image_unit *unit = &u->unit[c.primes];
    const bool by_slope = d->off > d->place * (double)im->steps;
    char rounds[80];
    snprintf(rounds, sizeof rounds, "to %.2g %.40s where it is", image_shown(unit, d->place),
             unit->shown);
    fprintf(out,
            "whirl run: warning: %s has too few digits for '%s%.*s': it rounds %s, which puts it "
            "up to %.2g %s off, %.2g %% of its range\n",
            kind, u->name, c.primes, "''''''''''",
            by_slope ? "the terms that its slope is the small sum of" : rounds,
            image_shown(unit, d->off), unit->shown, 100.0 * d->off / d->range);
}

void digits_say(FILE *out, const image *im, const engine_kind *kind, const digits *d) {
    if (d->component >= 0) {
        say_component(out, im, kind->name, d);
    } else if (d->energy) {
        fprintf(
            out,
            "whirl run: warning: float has too few digits for this run: rounding left %.3g J of "
            "its energy over, %.2g of the largest entry of its books\n",
            d->left_J, d->part);
    } else {
        return;
    }
    const char *would = d->compensated ? (d->in_double ? "--compensated or --number double would do"
                                                       : "--compensated would do")
                        : d->in_double ? "--number double would do"
                        : d->energy && d->in_both ? "--number double --compensated would do"
                        : d->component < 0
                            ? "more digits alone do not do: the step is too coarse, too"
                            : "";
    fprintf(out, "hint: %s%s%s\n", would, would[0] != '\0' && d->component >= 0 ? "; " : "",
            d->component >= 0
                ? "coordinates whose origin is near to where they move need fewer digits"
                : "");
}
