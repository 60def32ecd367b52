/* judged.c: see judged.h. */
#include "judged.h"

#include <math.h>

#include "alongside.h"
#include "folded.h"
#include "host/number/functions.h"
#include "swing.h"

/* Of a system's swing: its part of what moves, of which JUDGED_SWING_LOST is lost. */
#define SWING_SHARE 0.01
/* Another way of folding is some four times as far off as the nearest is: two digits and more, against half of one. */
#define WAY_OVER 0.25
/* Of the size of what moves, or of one metre or radian, as host/trust/horizon.c has it: less is its rounding. */
#define STAYS 1e-9
/* Likewise, of what others of its unit move. */
#define BESIDE_OTHERS 1e-3
/* Of the range, where it varies. */
#define SWING_OFF 0.01
/* Of the range, at all steps: a run whose balance alone is off. */
#define WAY_AGREES 1e-3

judged judged_of(const image *im, const engine_kind *kind, const watch *w, const belief *balance) {
    return (judged){.image = im, .kind = kind, .watch = w, .balance = balance};
}

void judged_end(judged *j) {
    linearised_free(j->motions);
    j->motions = NULL;
}

wh_method judged_method(const image *im) {
    return im->settings.matrix == MATRIX_RK4 ? WH_RK4 : im->settings.method;
}

linearised *judged_motions(judged *j) {
    if (j->motions == NULL) {
        j->motions = linearised_of(j->watch, judged_method(j->image));
    }
    return j->motions;
}

bool judged_blurred(const judged *j) { return j->image->mass_blur > JUDGED_BLURRED; }

static double size_of(const watch *w, int c) {
    return number_most(fabs(w->low[c]), fabs(w->high[c]));
}

/* Is a slope of component c that is so much off of any consequence over the run? What does not move but for its rounding has
 * no range: it would have to go some way. */
static bool moves(const judged *j, int c, double off) {
    const watch *w = j->watch;
    const double span_s = (double)w->steps * w->step_s;
    const component of = image_component(j->image, c);
    const int found = image_find_component(j->image, of.unknown, 0);
    const int at = found >= 0 ? found : c;
    const double gone = w->high[at] - w->low[at];
    const double others = w->range[w->field->n + w->alike[at]];
    if (gone < BESIDE_OTHERS * others) { /* its rounding, beside what others of its unit do */
        return false;
    }
    const double size = size_of(w, at);
    if (gone > STAYS * number_most(size, 1.0)) {
        return off * span_s > JUDGED_FOLDED_MOVES * w->range[c];
    }
    const double way = at != c ? 0.5 * off * span_s * span_s : off * span_s;
    return way > number_most(JUDGED_FOLDED_MOVES * size, STAYS);
}

/* What stays where it starts is told by its size. */
static void ask_start(judged *j, const folded *f) {
    const watch *w = j->watch;
    const int n = j->image->angles + j->image->reals;
    for (int i = 0; i < j->image->ways * n; i++) {
        const int c = i % n;
        const double gone = w->high[c] - w->low[c];
        const double size = size_of(w, c);
        const double of = gone > STAYS * number_most(size, 1.0) ? gone : number_most(size, STAYS);
        const double off = WAY_OVER * f->start[i] / of;
        if (off > j->start_off) {
            j->start_off = off;
            j->start = c;
        }
    }
}

static void ask_folded(judged *j) {
    const watch *w = j->watch;
    folded *f = folded_open(j->image, j->kind);
    for (int k = 0; k < w->records && f != NULL; k++) {
        folded_look(f, w->record + (ptrdiff_t)k * w->field->n);
    }
    for (int i = 0; f != NULL && i < f->step.results; i++) {
        const int c = image_slope_component(j->image, i);
        for (int k = 0; k < j->image->ways; k++) {
            const double off = WAY_OVER * f->step.off[k * f->step.results + i];
            if (off > j->folded_off * f->step.size[i] && moves(j, c, off)) {
                j->folded_off = off / f->step.size[i];
                j->folded = c;
            }
        }
    }
    if (f != NULL) {
        ask_start(j, f);
        j->contacts_off = WAY_OVER * folded_contacts_off(f);
    }
    folded_close(f);
}

static void ask_once(judged *j) {
    if (!j->folded_known) {
        j->folded_known = true;
        ask_folded(j);
    }
}

bool judged_start(judged *j) {
    ask_once(j);
    return j->start_off > JUDGED_FOLDED;
}

bool judged_contacts(judged *j) {
    ask_once(j);
    return j->contacts_off > JUDGED_FOLDED;
}

bool judged_folded(judged *j) {
    ask_once(j);
    return j->folded_off > JUDGED_FOLDED && !judged_blurred(j);
}

bool judged_numbers(judged *j) {
    return j->image->unbounded || judged_folded(j) || judged_start(j) || judged_contacts(j);
}

bool judged_singular(const judged *j) {
    return j->watch->singular.done && j->watch->singular.off >= JUDGED_NOT_RESOLVED;
}

static bool on_the_way(const judged *j) {
    const belief *b = j->balance;
    return b->known && j->watch->balanced && !b->exact &&
           j->watch->most_J > JUDGED_ON_THE_WAY * b->largest_J && j->watch->most_J > b->rounding_J;
}

bool judged_lost(const judged *j) {
    const belief *b = j->balance;
    const watch *w = j->watch;
    const bool by_the_rule =
        w->balanced && w->doubts > 0 && w->most_J < BELIEF_LIMIT * b->largest_J;
    return (belief_lost(b, BELIEF_LIMIT) && !by_the_rule) || on_the_way(j);
}

/* The books' rule needs pairs of steps: what is left of an odd number is a trapezoid. */
static bool rule_in_doubt(const watch *w) {
    return w->doubts > 0 || (w->smooth && w->steps % 2U == 1U);
}

bool judged_energy(judged *j) {
    if (!j->energy_known) {
        j->energy_known = true;
        j->energy = judged_lost(j) && !(rule_in_doubt(j->watch) &&
                                        alongside_agrees(j->image, j->kind, j->watch, WAY_AGREES));
    }
    return j->energy;
}

/* What is missing of the largest entry, at the end or on the way. */
double judged_missing(const judged *j) {
    const belief *b = j->balance;
    const double way =
        j->watch->balanced && b->largest_J > 0.0 ? j->watch->most_J / b->largest_J : 0.0;
    return number_most(b->ratio, way);
}

/* A swing that varies along its way is to be off by as much, or by half of what linearising it at one place says. */
static bool is_borne_out(judged *j, const linear_motion *m) {
    const double half = 0.25 * number_least(m->off, 1.0) * number_root(m->share);
    if (!swing_varies(j->motions, m)) {
        return true;
    }
    j->swing_off = swing_off(j->watch);
    return j->swing_off >= number_most(number_least(half, SWING_OFF), 0.5 * SWING_OFF);
}

/* A system has no energy to miss: its motions are asked. */
bool judged_swing(judged *j) {
    if (!j->swing_known) {
        const bool is_asked = !j->image->has_energies && j->image->settings.matrix != MATRIX_EXACT;
        const linear_motion *m = is_asked ? judged_motions(j)->worst : NULL;
        j->swing_known = true;
        j->swing = m != NULL && m->share >= SWING_SHARE &&
                   linearised_worst(j->motions) >= JUDGED_SWING_LOST && is_borne_out(j, m);
    }
    return j->swing;
}
