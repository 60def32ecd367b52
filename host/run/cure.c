/* cure.c: see cure.h. */
#include "cure.h"

#include <math.h>

#include "again.h"
#include "digits.h"
#include "host/number/functions.h"
#include "judged.h"

/* What may be spent on all cures of a run. */
#define OPERATIONS_MOST 5e8
/* A cure leaves no more of the largest entry over: some way off what is warned of. */
#define LEAVES 3e-4

/* The same scene with it; false where no whole number of steps counts that. */
static bool image_with(const image *im, const cure_wish *what, image *made) {
    *made = *im;
    made->settings.method = what->method;
    made->settings.compensated = what->compensated;
    made->settings.matrix = MATRIX_NONE;
    made->list[IMAGE_MATRIX] = NULL;
    if (what->step_s != im->step_s) {
        if (!(what->step_s >= RATIO_LEAST)) {
            return false;
        }
        made->step = ratio_of(what->step_s);
        made->step_s = ratio_times(1, made->step);
        return ratio_count(ratio_of(im->until_s), made->step, &made->steps) && made->steps > 0;
    }
    return true;
}

/* The run just done was looked at: is there nothing to say? */
static cure_outcome outcome_of(const again *a, const volatile sig_atomic_t *stop) {
    const watch *w = a->watch;
    judged j = judged_of(&a->image, a->kind, w, &a->balance);
    const bool by_rule = w->balanced && w->doubts > 0;
    const bool known = a->books == NULL || !a->books->undefined;
    const bool silent = known && !judged_energy(&j) && !judged_singular(&j) && !judged_swing(&j) &&
                        between_seen(w->between).component < 0 &&
                        (by_rule || !a->balance.known || judged_missing(&j) <= LEAVES);
    judged_end(&j);
    if (!silent) {
        return CURE_DOES_NOT;
    }
    if (digits_none(&a->image, a->kind, w)) {
        return CURE_ROUNDS;
    }
    const digits few = digits_of(&a->image, a->kind, w, &a->balance, stop);
    return few.energy || few.component >= 0 || few.not_known ? CURE_ROUNDS : CURE_DOES;
}

/* Also makes the image; of what can not be tried infinity. */
static double share_of(const cures *c, const cure_wish *what, image *with) {
    const bool can = c->image->fixed == NULL && image_with(c->image, what, with);
    return can ? again_operations_a_step(with) * (double)with->steps / OPERATIONS_MOST
               : (double)INFINITY;
}

double cure_share(const cures *c, const cure_wish *what) {
    image with;
    return share_of(c, what, &with);
}

cure_outcome cure_try(cures *c, const cure_wish *what) {
    image with;
    if (!(c->spent + share_of(c, what, &with) <= 1.0)) {
        return CURE_NOT_TRIED;
    }
    again a;
    again_run(&a, &with, what->in_double ? &engine_double : c->kind, c->stop);
    c->spent += again_operations_a_step(&with) * (double)a.steps / OPERATIONS_MOST;
    c->ended = a.done;
    watch_end(a.watch, !a.done && !a.stopped);
    const cure_outcome outcome = a.stopped ? CURE_NOT_TRIED
                                 : a.done  ? outcome_of(&a, c->stop)
                                           : CURE_DOES_NOT;
    again_forget(&a);
    return outcome;
}
