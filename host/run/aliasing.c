/* aliasing.c: see aliasing.h. */
#include "aliasing.h"

#include <math.h>

#include "horizon.h"
#include "host/number/functions.h"
#include "loop.h"

/* Steps of the third run in one of the run's: more than one, so that it is the more accurate, and near no simple ratio. */
#define STEPS 1.41
/* By so many times the most that the run and the finer one differ by, the third may be off for its steps alone. */
#define ITS_OWN 2.0
/* SI: no column that is as near as this differs. */
#define ALIKE 1e-9

static bool is_prime(uint64_t n) {
    for (uint64_t i = 3; i * i <= n; i += 2) {
        if (n % i == 0) {
            return false;
        }
    }
    return n % 2U == 1U;
}

/* False: its step is no ratio of two numbers. */
static bool third_image(const twins *t, image *im) {
    const image *run = t->shape->image;
    *im = t->finer;
    im->steps = 1U + (uint64_t)(STEPS * (double)run->steps);
    while (!is_prime(im->steps)) {
        im->steps++;
    }
    im->step = run->step;
    if (__builtin_mul_overflow(im->step.numerator, run->steps, &im->step.numerator) ||
        __builtin_mul_overflow(im->step.denominator, im->steps, &im->step.denominator)) {
        return false;
    }
    im->step_s = ratio_times(1, im->step);
    return true;
}

/* Beside contacts rates jump, and two runs do not jump together. */
static bool is_compared(const twins *t, const horizon_column *c, int k) {
    return (t->shape->image->contacts == 0 || t->shape->column[k].primes == 0) &&
           c->verdict != HORIZON_ROUNDING;
}

static void compare(twins *t, const horizon *h, const double *now, const double *other) {
    for (int k = 1; k < t->columns; k++) {
        const horizon_column *c = &h->column[k];
        const double off = fabs(other[k] - now[k]);
        const double range = number_most(c->range, off);
        const double least =
            h->tolerance * range + ITS_OWN * (c->off + c->rounding) + ALIKE * t->column[k].one;
        if (is_compared(t, c, k) && off > least && off / range > t->aliased.part) {
            t->aliased = (twins_aliased){k, off / range, now[k], other[k], t->aliased.step_s};
        }
    }
}

void aliasing_find(twins *t, const double *now, const volatile sig_atomic_t *stop) {
    image im;
    wh_status status;
    horizon h = horizon_of(t, HORIZON_TOLERANCE);
    if (t->cut_s < 0.0 && t->shape->image->settings.matrix == MATRIX_NONE && third_image(t, &im)) {
        records *r = records_open(NULL, &im, &engine_double);
        void *run = engine_double.start(&im);
        const loop l = {.kind = &engine_double, .run = run, .steps = im.steps, .stop = stop};
        t->aliased.step_s = im.step_s;
        if (loop_run(&l, &status) == LOOP_DONE) {
            records_read(r, run, t->end_s);
            compare(t, &h, now, r->row);
        }
        engine_double.stop(run);
        records_close(r);
    }
    horizon_free(&h);
}
