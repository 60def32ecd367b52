/* deviation.c: see deviation.h. */
#include "deviation.h"

#include <math.h>
#include <stddef.h>

#include "long_functions.h"

/* Enter a record: false when the run is of no use any more. */
static bool enter(const reference *r, const records *now, int record, deviation_of_what what,
                  deviation *d) {
    const long double *row = r->row + (size_t)record * (size_t)r->columns;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (what.column >= 0 ? k != what.column : !c->counts) {
            continue;
        }
        const long double unit = what.column >= 0 ? 1.0L : c->largest;
        const double off = (double)(long_size((long double)now->row[k] - row[k]) / unit);
        if (d->column < 0 || !(off <= d->error)) { /* also what is no number */
            d->error = off;
            d->column = k;
            d->known = (double)(c->off / unit);
        }
    }
    return d->error <= what.give_up;
}

/* One step; *most: evaluations of the one that took most, where that is not the same for all. */
static bool take_step(const engine_kind *kind, void *run, const image *im, double *most) {
    uint64_t declared;
    const bool differ = im->contacts > 0;
    const uint64_t before = differ ? kind->evaluations(run, &declared) : 0;
    const bool good = kind->step(run) == WH_OK;
    const double taken = differ ? (double)(kind->evaluations(run, &declared) - before) : 1.0;
    *most = taken > *most ? taken : *most;
    return good;
}

deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what,
                            const volatile sig_atomic_t *stop) {
    deviation d = {.column = what.column};
    records *now = records_open(NULL, im, kind);
    void *run = kind->start(im);
    records_read(now, run, 0.0);
    bool good = enter(r, now, 0, what, &d);
    const int each = (int)pace.records;
    for (int i = each; i <= r->records && good && (stop == NULL || !*stop); i += each) {
        for (uint64_t k = 0; k < pace.steps && good; k++) {
            good = take_step(kind, run, im, &d.evaluations_most);
        }
        if (good) {
            records_read(now, run, 0.0);
            good = enter(r, now, i, what, &d);
        }
    }
    uint64_t most;
    const bool matrix = im->list[IMAGE_MATRIX] != NULL; /* of which a step evaluates one list */
    const uint64_t evaluations = matrix ? kind->steps(run) : kind->evaluations(run, &most);
    d.operations =
        (double)evaluations * (double)im->list[matrix ? IMAGE_MATRIX : IMAGE_STEP]->count;
    const double time_s = ratio_times(kind->steps(run), im->step);
    d.evaluations = time_s > 0.0 ? (double)evaluations / time_s : 0.0;
    if (im->contacts == 0) {
        d.evaluations_most = matrix ? 1.0 : (double)wh_methods[im->settings.method].stages;
    }
    d.usable = good && (kind->saturated == NULL || kind->saturated(run) == 0);
    kind->stop(run);
    records_close(now);
    return d;
}
