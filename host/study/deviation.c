/* deviation.c: see deviation.h. */
#include "deviation.h"

#include <math.h>
#include <stddef.h>

#include "host/base/interrupts.h"
#include "host/engine/loop.h"
#include "long_list.h"

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

/* Evaluations so far; of a scene with contacts reading a record is one, too, which is none of a step's. */
typedef struct counted {
    double in_steps;
    double most; /* in one of these */
} counted;

/* One step. They differ where there are contacts; a step as one matrix evaluates one list. */
static bool take_step(const engine_kind *kind, void *run, const image *im, counted *c) {
    uint64_t declared;
    const bool matrix = im->list[IMAGE_MATRIX] != NULL;
    const uint64_t before = kind->evaluations(run, &declared);
    const bool good = loop_steps(kind, run, 1) == WH_OK;
    const double taken = matrix ? 1.0 : (double)(kind->evaluations(run, &declared) - before);
    c->in_steps += taken;
    c->most = taken > c->most ? taken : c->most;
    return good;
}

deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what) {
    deviation d = {.column = what.column};
    counted c = {0.0, 0.0};
    records *now = records_open(NULL, im, kind);
    void *run = kind->start(im);
    records_read(now, run, 0.0);
    bool good = enter(r, now, 0, what, &d);
    const int each = (int)pace.records;
    for (int i = each; i <= r->records && good && !interrupted; i += each) {
        for (uint64_t k = 0; k < pace.steps && good; k++) {
            good = take_step(kind, run, im, &c);
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
    d.evaluations = time_s > 0.0 ? c.in_steps / time_s : 0.0;
    d.evaluations_most = im->contacts > 0 ? c.most
                         : matrix         ? 1.0
                                          : (double)wh_methods[im->settings.method].stages;
    d.usable = good && (kind->saturated == NULL || kind->saturated(run) == 0);
    kind->stop(run);
    records_close(now);
    return d;
}
