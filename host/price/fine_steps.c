/* fine_steps.c: see fine_steps.h. */
#include "fine_steps.h"

#include <string.h>

#include "host/number/functions.h"
#include "host/run/loop.h"

/* As many times finer than the scene's step, if they may take the operations. */
#define FINER 16.0
/* Evaluations of a step: RK4's, and what looking for events takes besides. */
#define EVALUATIONS 4.0
#define EVALUATIONS_CONTACTS 12.0

uint64_t fine_steps_of(const reference_wish *w) {
    const image *im = w->image;
    if (w->by.steps > 0) {
        return w->by.steps;
    }
    const double spacing_s = ratio_times(1, w->spacing);
    const double each =
        (im->contacts > 0 ? EVALUATIONS_CONTACTS : EVALUATIONS) * im->list[IMAGE_STEP]->count;
    const double wanted = number_ceiling(FINER * spacing_s / im->step_s / 2.0);
    const double affordable = number_floor(w->operations / each / w->records / 2.0);
    return 2U * (uint64_t)number_most(1.0, number_least(wanted, affordable));
}

int fine_steps_run(const reference_wish *w, const records *shape, uint64_t steps,
                   long double *row) {
    image copy = *w->image;
    copy.settings = (image_settings)IMAGE_SETTINGS_DEFAULT;
    copy.settings.compensated = true;
    copy.list[IMAGE_MATRIX] = NULL;
    if (w->by.steps > 0) {
        copy.settings.method = w->by.method;
    }
    copy.step = (whole_ratio){w->spacing.numerator, w->spacing.denominator * steps};
    copy.step_s = ratio_times(1, copy.step);
    copy.steps = steps * (uint64_t)w->records;
    records *r = records_open(NULL, &copy, &engine_double);
    void *run = engine_double.start(&copy);
    int done = 0;
    for (;; done++) {
        records_read(r, run, ratio_times((uint64_t)done, w->spacing));
        for (int i = 0; i < shape->columns; i++) {
            row[(size_t)done * (size_t)shape->columns + (size_t)i] = (long double)r->row[i];
        }
        if (done == w->records || (w->stop != NULL && *w->stop) ||
            loop_steps(&engine_double, run, steps) != WH_OK) {
            break;
        }
    }
    engine_double.stop(run);
    records_close(r);
    return done;
}
