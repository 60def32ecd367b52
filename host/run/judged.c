/* judged.c: see judged.h. */
#include "judged.h"

#include <math.h>

#include "host/number/functions.h"
#include "swing.h"

/* Of a system's swing: its part of what moves, of which JUDGED_SWING_LOST is lost. */
#define SWING_SHARE 0.01
/* Of the range, where it varies. */
#define SWING_OFF 0.01

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
