#include "aliasing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/check/horizon.h"
#include "host/number/functions.h"

/* Steps of the third run in one of the run's: more than one, so that it is the more accurate, and near no simple ratio. */
#define STEPS 1.41
/* The third run may differ by this many times the difference of the run and the finer one, because of its steps
 * alone. */
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
static bool third_image(const step_doubling *t, uint64_t steps, image *im) {
    const image *run = t->shape->image;
    *im = t->finer;
    im->steps = 1U + (uint64_t)(STEPS * (double)steps);
    while (!is_prime(im->steps)) {
        im->steps++;
    }
    im->step = run->step;
    if (__builtin_mul_overflow(im->step.numerator, steps, &im->step.numerator) ||
        __builtin_mul_overflow(im->step.denominator, im->steps, &im->step.denominator)) {
        return false;
    }
    im->step_s = ratio_times(1, im->step);
    return true;
}

/* Rates jump at contacts, and two runs do not jump at the same time. */
static bool is_compared(const step_doubling *t, const horizon_column *c, int k) {
    return (t->shape->image->contacts == 0 || t->shape->column[k].primes == 0) &&
           c->verdict != HORIZON_ROUNDING;
}

static void compare(step_doubling *t, const horizon *h, const double *now, const double *other,
                    double step_s) {
    for (int k = 1; k < t->columns; k++) {
        const horizon_column *c = &h->column[k];
        const double off = fabs(other[k] - now[k]);
        const double range = number_most(c->range, off);
        const double within = h->tolerance * range; /* so far the run and the finer one agree */
        const double least = within + ITS_OWN * (number_least(c->off, within) + c->rounding) +
                             ALIKE * t->column[k].one;
        if (is_compared(t, c, k) && off > least && off / range > t->aliased.part) {
            t->aliased = (step_doubling_aliased){.column = k,
                                                 .part = off / range,
                                                 .value = now[k],
                                                 .other = other[k],
                                                 .at_s = now[0],
                                                 .step_s = step_s};
        }
    }
}

/* The steps until which the finer run trusts every column. */
static uint64_t trusted_steps(const step_doubling *t, const horizon *h) {
    const image *im = t->shape->image;
    double until_s = t->end_s;
    for (int k = 1; k < t->columns; k++) {
        if (h->column[k].verdict == HORIZON_UNTIL) {
            until_s = number_least(until_s, h->column[k].until_s);
        }
    }
    return until_s < t->end_s ? (uint64_t)(until_s / im->step_s) : im->steps;
}

/* The state at the end of all steps of this image: row[columns]. */
static loop_end end_of(const step_doubling *t, const image *im, const budget *of, double *row) {
    wh_status status;
    records *r = records_open(NULL, im, &engine_double);
    void *run = engine_double.start(im);
    const loop l = {.kind = &engine_double, .run = run, .steps = im->steps, .pays = of};
    const loop_end end = loop_run(&l, &status);
    records_read(r, run, ratio_times(im->steps, im->step));
    memcpy(row, r->row, (size_t)t->columns * sizeof *row);
    engine_double.stop(run);
    records_close(r);
    return end;
}

void aliasing_find(step_doubling *t, budget *of) {
    const image *im = t->shape->image;
    if (t->status != WH_OK || im->steps == 0 || t->shape->kind->steps(t->run) != im->steps) {
        return; /* it has failed, or was interrupted */
    }
    budget_begin(of);
    image third;
    loop_end end = LOOP_DONE;
    horizon h = horizon_of(t, HORIZON_TOLERANCE);
    const uint64_t steps = trusted_steps(t, &h);
    if (steps > 0 && im->settings.matrix == MATRIX_NONE && third_image(t, steps, &third)) {
        image finer = t->finer;
        double *row = alloc(2 * (int64_t)t->columns, sizeof *row);
        finer.steps = steps * t->each;
        const bool whole = steps == im->steps;
        const double runs = (double)(third.steps + (whole ? 0 : finer.steps));
        const double wanted = runs / (double)(im->steps * t->each) * (double)t->operations;
        end = wanted > budget_left(of) ? LOOP_SPENT : end_of(t, &third, of, row);
        if (end == LOOP_DONE && !whole) {
            end = end_of(t, &finer, of, row + t->columns);
        }
        if (end == LOOP_DONE) {
            compare(t, &h, whole ? t->finer_end : row + t->columns, row, third.step_s);
        }
        free(row);
    }
    horizon_free(&h);
    budget_end(of);
    t->unaliased = end != LOOP_DONE && end != LOOP_FAILED;
}
