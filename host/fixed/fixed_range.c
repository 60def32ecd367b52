/* fixed_range.c: declared ranges, and a reference run for the others. */
#include "fixed_range.h"

#include <math.h>
#include <stdlib.h>

#include <stdio.h>

#include "host/base/alloc.h"
#include "host/base/interrupts.h"
#include "host/engine/loop.h"

static enclosure twice(enclosure seen) {
    if (seen.low == 0.0 && seen.high == 0.0) {
        return (enclosure){-1.0, 1.0};
    }
    if (seen.low == 0.0 || seen.high == 0.0) { /* begun at rest: either way */
        return (enclosure){-2.0 * enclosure_size(seen), 2.0 * enclosure_size(seen)};
    }
    return (enclosure){seen.low < 0.0 ? 2.0 * seen.low : 0.5 * seen.low,
                       seen.high > 0.0 ? 2.0 * seen.high : 0.5 * seen.high};
}

/* Often enough to be seen, rarely enough to cost little. */
static void show(uint64_t step, uint64_t steps) {
    if ((step & 0x3fffU) == 0x3fffU) {
        fprintf(stderr, "\rranges, from a run in double: %5.1f %%",
                100.0 * (double)step / (double)steps);
    }
}

typedef struct looking {
    const image *image;
    void *run;
    double *angle_rad;
    double *real;
    enclosure *seen;
    bool progress;
} looking;

static bool see(void *of, uint64_t step) {
    const looking *at = of;
    if (at->progress) {
        show(step, at->image->steps);
    }
    engine_double.state(at->run, at->angle_rad, at->real);
    for (int i = 0; i < at->image->reals; i++) {
        const enclosure now = {at->real[i], at->real[i]};
        at->seen[i] = step == 0 ? now : enclosure_hull(at->seen[i], now);
    }
    return true;
}

static bool look(const image *im, enclosure *seen, bool progress, diags *errors) {
    void *run = engine_double.start(im);
    double *angle = alloc(im->angles, sizeof *angle);
    double *real = alloc(im->reals, sizeof *real);
    looking at = {im, run, angle, real, seen, progress};
    const loop l = {.kind = &engine_double, .run = run, .steps = im->steps, .see = see, .of = &at};
    wh_status status;
    (void)loop_run(&l, &status);
    if (progress) {
        fputs("\r                                      \r", stderr);
    }
    engine_double.stop(run);
    free(angle);
    free(real);
    if (status != WH_OK) {
        diag_error(errors, im->at, "declare the ranges: range NAME = A .. B",
                   "the run of '%s' in double, from which ranges are taken, diverged", im->name);
    }
    return status == WH_OK && !interrupted;
}

bool fixed_ranges(const image *im, enclosure *range, bool *declared, bool progress, diags *errors) {
    bool good = true;
    bool all = true;
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const image_range *r = &im->range[i];
        declared[i] = r->declared;
        all = all && (r->declared || i >= im->reals);
    }
    if (!all) {
        good = look(im, range, progress, errors);
    }
    for (int i = 0; i < im->reals + im->inputs && good; i++) {
        if (declared[i]) {
            range[i] = (enclosure){im->range[i].low, im->range[i].high};
        } else if (i < im->reals) {
            range[i] = twice(range[i]);
        } else {
            const double value = im->input[i - im->reals].value;
            range[i] = twice((enclosure){value, value});
        }
    }
    return good;
}
