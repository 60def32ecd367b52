/* cure.c: see cure.h. */
#include "cure.h"

#include "digits.h"
#include "host/number/functions.h"
#include "judged.h"

/* What may be spent on all cures of a run, and what an evaluation is beside its operations. */
#define OPERATIONS_MOST 5e8
#define OPERATIONS_BESIDE 40.0
/* Books, and what looks for events evaluates, in a step's evaluations. */
#define WATCHED_AS 2.0
#define EVENTS_AS 8.0
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

static double operations_a_step(const image *im) {
    const double evaluation = im->list[IMAGE_STEP]->count + OPERATIONS_BESIDE;
    const tape *kept = im->list[IMAGE_BOOKS];
    const double watched = kept != NULL ? kept->count + OPERATIONS_BESIDE : evaluation;
    const double stages =
        wh_methods[im->settings.method].stages + (im->contacts > 0 ? EVENTS_AS : 0.0);
    return stages * evaluation + WATCHED_AS * watched;
}

/* The run just done was looked at: is there nothing to say? */
static cure_outcome outcome_of(const image *im, const engine_kind *kind, watch *w, books *b,
                               const void *run, const volatile sig_atomic_t *stop) {
    const belief balance = belief_of(b, kind, run);
    judged j = judged_of(im, kind, w, &balance);
    const bool by_rule = w->balanced && w->doubts > 0;
    const bool silent = !judged_lost(&j) && !judged_singular(&j) && !judged_swing(&j) &&
                        (by_rule || !balance.known || judged_missing(&j) <= LEAVES);
    judged_end(&j);
    if (!silent) {
        return CURE_DOES_NOT;
    }
    const digits few = digits_of(im, kind, w, &balance, stop);
    return few.energy || few.component >= 0 ? CURE_ROUNDS : CURE_DOES;
}

cure_outcome cure_try(cures *c, const cure_wish *what) {
    image again;
    if (c->image->fixed != NULL || !image_with(c->image, what, &again)) {
        return CURE_NOT_TRIED;
    }
    const double each = operations_a_step(&again);
    if (!(c->spent + each * (double)again.steps <= OPERATIONS_MOST)) {
        return CURE_NOT_TRIED;
    }
    const engine_kind *kind = what->in_double ? &engine_double : c->kind;
    void *run = kind->start(&again);
    books *b = books_open(&again);
    watch *w = watch_open(&again, kind);
    bool good = true;
    bool stopped = false;
    uint64_t step = 0;
    for (; step <= again.steps && good && !stopped; step++) {
        good = step == 0 || kind->step(run) == WH_OK;
        if (good && b != NULL) {
            books_enter(b, kind, run);
        }
        if (good) {
            watch_enter(w, kind, b, run);
        }
        stopped = (step & 255U) == 0 && c->stop != NULL && *c->stop;
    }
    c->spent += each * (double)step;
    watch_end(w, !good);
    const cure_outcome outcome =
        good && !stopped ? outcome_of(&again, kind, w, b, run, c->stop) : CURE_DOES_NOT;
    watch_close(w);
    books_close(b);
    kind->stop(run);
    return stopped ? CURE_NOT_TRIED : outcome;
}
