/* retrial.c: see retrial.h. */
#include "retrial.h"

#include <math.h>

#include "again.h"
#include "host/number/functions.h"

/* Parts of a step that are tried, one after the other. */
static const uint64_t parts_tried[] = {2, 5, 10, 20, 50, 100, 200, 500, 1000};

enum { TRIALS = (int)(sizeof parts_tried / sizeof parts_tried[0]) };

/* What may be spent on them. */
#define OPERATIONS_MOST 1e8
/* Where no finer run tells: overruns that took no more of the largest entry than this, and were no more of the steps, are
 * the last bounces before a rest. */
#define TAKEN_LITTLE 1e-3
#define STEPS_FEW 0.01

typedef struct trials {
    const busy *of;
    const engine_kind *kind;
    const volatile sig_atomic_t *stop;
    busy *made[TRIALS]; /* NULL: none */
    int count;
    double spent;
    double last; /* what the last of them took */
} trials;

static whole_ratio part_of(whole_ratio step, uint64_t parts) {
    uint64_t rest = parts;
    for (uint64_t k = 2; k <= rest; k++) {
        while (rest % k == 0 && step.numerator % k == 0) {
            step.numerator /= k;
            rest /= k;
        }
    }
    return step.denominator < (uint64_t)1 << 49
               ? (whole_ratio){step.numerator, step.denominator * rest}
               : ratio_of(ratio_times(1, step) / (double)rest);
}

static double operations(const trials *t, const void *run, const image *im) {
    uint64_t most;
    return (double)t->kind->evaluations(run, &most) * (im->list[IMAGE_STEP]->count + AGAIN_BESIDE);
}

static bool is_stopped(const trials *t) { return t->stop != NULL && *t->stop; }

/* The run again in such parts of its step; NULL when it fails or takes too long. */
static busy *run_again(trials *t, uint64_t parts) {
    image finer = *t->of->image;
    finer.step = part_of(finer.step, parts);
    finer.step_s = ratio_times(1, finer.step);
    finer.steps *= parts;
    busy *b = busy_open(&finer, parts);
    void *run = t->kind->start(&finer);
    bool good = true;
    busy_enter(b, t->kind, run, 0.0);
    for (uint64_t i = 0; i < finer.steps && good; i++) {
        good = t->kind->step(run) == WH_OK;
        busy_enter(b, t->kind, run, 0.0);
        if (i % 256 == 0) {
            good =
                good && !is_stopped(t) && t->spent + operations(t, run, &finer) < OPERATIONS_MOST;
        }
    }
    t->last = operations(t, run, &finer);
    t->spent += t->last;
    t->kind->stop(run);
    b->image = t->of->image; /* as `finer` ends here */
    if (!good) {
        busy_close(b);
        return NULL;
    }
    return b;
}

/* Twice as many steps take twice as long. */
static bool is_dear(const trials *t) {
    const double grows =
        t->count == 0 ? 1.0 : (double)parts_tried[t->count] / (double)parts_tried[t->count - 1];
    const busy *b = t->of;
    const double least = 5.0 * (b->image->list[IMAGE_STEP]->count + AGAIN_BESIDE) *
                         (double)b->steps * (double)parts_tried[0];
    return t->spent + (t->count == 0 ? least : grows * t->last) > OPERATIONS_MOST;
}

/* The coarsest of those before `finest` that have no overruns and agree with it; -1: none. */
static int agrees(const trials *t, int finest) {
    for (int i = 0; i < finest; i++) {
        if (t->made[i]->overruns == 0 && busy_off(t->made[i], t->made[finest]) < RETRIAL_CURED) {
            return i;
        }
    }
    return -1;
}

/* The coarsest with neither overruns nor chatter; -1: none. */
static int calm(const trials *t) {
    for (int i = 0; i < t->count; i++) {
        if (t->made[i]->overruns == 0 && t->made[i]->chatters < 0) {
            return i;
        }
    }
    return -1;
}

static bool is_little(const busy *b, double largest_J) {
    return b->chatters < 0 && b->taken_J <= TAKEN_LITTLE * largest_J &&
           (double)b->overruns <= 1.0 + STEPS_FEW * (double)b->steps;
}

static void judge(const trials *t, double largest_J, int finest, int found, retrial *made) {
    const busy *b = t->of;
    const int rests = calm(t);
    made->finest = t->count > 0 ? parts_tried[t->count - 1] : 1;
    made->known = finest >= 0;
    made->off = made->known ? busy_off(b, t->made[finest]) : 0.0;
    made->told =
        made->known ? made->off > RETRIAL_TOLD : b->overruns > 0 && !is_little(b, largest_J);
    made->agreed = found >= 0;
    made->parts = found >= 0 ? parts_tried[found] : rests >= 0 ? parts_tried[rests] : 0;
}

retrial retrial_of(const busy *b, const engine_kind *kind, double largest_J,
                   const volatile sig_atomic_t *stop) {
    trials t = {.of = b, .kind = kind, .stop = stop};
    retrial made = {.finest = 1};
    int finest = -1; /* without overruns */
    int found = -1;
    if (b == NULL || (b->overruns == 0 && b->chatters < 0) || b->steps < b->image->steps) {
        return made;
    }
    while (t.count < TRIALS && found < 0 && !is_dear(&t)) {
        busy *next = run_again(&t, parts_tried[t.count]);
        if (next == NULL) {
            break;
        }
        t.made[t.count++] = next;
        if (next->overruns > 0) {
            continue;
        }
        finest = t.count - 1;
        if (b->overruns == 0 && busy_off(b, next) < RETRIAL_CURED) {
            break; /* there is nothing to cure */
        }
        found = agrees(&t, finest);
    }
    judge(&t, largest_J, finest, found, &made);
    for (int i = 0; i < t.count; i++) {
        busy_close(t.made[i]);
    }
    return made;
}
