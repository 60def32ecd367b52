/* stepping.c: one run of a sweep, measured. */
#include "stepping.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/check/run_checks.h"
#include "host/number/functions.h"

typedef struct meter {
    const measuring *wanted;
    const image *image;
    void *run;
    run_checks *verdict;
    gauge *gauges; /* [measures] */
    double *output;
    bool series;            /* some measure takes a sample each step */
    bool series_of_outputs; /* and one of those reads an output */
} meter;

static meter meter_open(const measuring *w, const image *im, void *run) {
    const int count = w->count;
    meter m = {.wanted = w, .image = im, .run = run};
    m.verdict = run_checks_open(im, NULL, w->kind, run, NULL);
    m.gauges = alloc(count, sizeof *m.gauges);
    m.output = alloc(im->outputs, sizeof *m.output);
    for (int i = 0; i < count; i++) {
        const measured *each = &w->list[i];
        m.gauges[i] = gauge_start(each->kind);
        if (each->kind != MEASURE_FINAL) {
            m.series = true;
            m.series_of_outputs = m.series_of_outputs || each->from.where == FROM_OUTPUT;
        }
    }
    return m;
}

static void meter_close(meter *m) {
    for (int i = 0; i < m->wanted->count; i++) {
        gauge_end(&m->gauges[i]);
    }
    run_checks_close(m->verdict);
    free(m->gauges);
    free(m->output);
}

/* Take a sample of the present state: of the series, or of the final values. */
static void meter_enter(meter *m, bool final) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    const engine_kind *kind = m->wanted->kind;
    kind->state(m->run, angle_rad, real);
    if (final || m->series_of_outputs) {
        kind->outputs(m->run, m->output);
    }
    for (int i = 0; i < m->wanted->count; i++) {
        if ((m->gauges[i].kind == MEASURE_FINAL) != final) {
            continue;
        }
        const channel c = m->wanted->list[i].from;
        gauge_enter(&m->gauges[i], c.where == FROM_ANGLE  ? angle_rad[c.index]
                                   : c.where == FROM_REAL ? real[c.index]
                                                          : m->output[c.index]);
    }
}

static bool keeps_samples(const measuring *w) {
    for (int i = 0; i < w->count; i++) {
        if (w->list[i].kind == MEASURE_PERIOD) {
            return true;
        }
    }
    return false;
}

/* Enter what the run is judged by. False when an energy is not a finite number, said. */
static bool balance(meter *m, diags *errors, FILE *reason) {
    const books *b = m->verdict->books;
    run_checks_enter(m->verdict);
    if (b == NULL || !b->undefined) {
        return true;
    }
    if (!nonfinite_energies(m->image, m->wanted->kind, b->angle_rad, b->real, b->undefined_s,
                            errors)) {
        fprintf(reason, "the energies are not finite numbers at t = %.9g s", b->undefined_s);
    }
    return false;
}

typedef struct walk {
    meter *meter;
    uint64_t from; /* the step from which series count */
    diags *errors;
    FILE *reason;
    bool good;
} walk;

static bool see(void *of, uint64_t step) {
    walk *w = of;
    w->good = balance(w->meter, w->errors, w->reason);
    if (w->good && w->meter->series && step >= w->from) {
        meter_enter(w->meter, false);
    }
    return w->good;
}

/* Step to the end. False when the run failed, said on `reason` or reported. */
static bool run_through(meter *m, diags *errors, FILE *reason) {
    const engine_kind *kind = m->wanted->kind;
    const image *im = m->image;
    const uint64_t steps = im->steps;
    uint64_t from = 0;
    const bool counted = ratio_count_from(m->wanted->from_s, im->step, &from);
    if (m->series && (!counted || from > steps)) {
        fprintf(reason, "--from %.9g s lies behind the last step", m->wanted->from_s);
        return false;
    }
    if (keeps_samples(m->wanted) && steps >= from && steps - from >= PERIOD_SAMPLES_MAX) {
        fprintf(reason, "period() takes at most %.0e samples: a later --from or a larger step",
                (double)PERIOD_SAMPLES_MAX);
        return false;
    }
    walk w = {m, from, errors, reason, true};
    const loop l = {
        .kind = kind, .run = m->run, .steps = steps, .own = &m->verdict->own, .see = see, .of = &w};
    wh_status status;
    if (loop_run(&l, &status) == LOOP_FAILED && !nonfinite_step(im, kind, m->run, status, errors)) {
        fprintf(reason, "diverged in the step after t = %.9g s",
                ratio_times(kind->steps(m->run), im->step));
    }
    if (status != WH_OK || !w.good) {
        return false;
    }
    meter_enter(m, true);
    return true;
}

/* The measures, and behind them the balance; NAN where it is not known. */
static bool read_measures(const meter *m, double *value, FILE *reason, point_notes *notes) {
    const measuring *w = m->wanted;
    const double epsilon = w->kind == &engine_float ? (double)FLT_EPSILON : DBL_EPSILON;
    for (int i = 0; i < w->count; i++) {
        if (m->gauges[i].undefined) {
            fprintf(reason, "what the measure '%s' takes is not a finite number throughout",
                    w->list[i].name);
            return false;
        }
        value[i] = gauge_result(&m->gauges[i], m->image->step_s, epsilon);
        const bool no_period = isnan(value[i]) && m->gauges[i].kind == MEASURE_PERIOD;
        if (!isfinite(value[i]) && !no_period) {
            fprintf(reason, "the measure '%s' is not a finite number: what it takes is too large",
                    w->list[i].name);
            return false;
        }
    }
    run_checks_end(m->verdict, WH_OK);
    value[w->count] = m->verdict->balance.known ? m->verdict->balance.ratio : (double)NAN;
    for (int id = 0; id < FINDINGS; id++) {
        notes->found |= m->verdict->found[id].told ? FINDING_BIT(id) : 0U;
    }
    notes->against = m->verdict->against;
    notes->fails = run_checks_fails(m->verdict, w->strict);
    return true;
}

bool stepping_measure(const measuring *w, const image *im, double *value, diags *errors,
                      FILE *reason, point_notes *notes) {
    void *run = w->kind->start(im);
    notes->end_s = ratio_times(im->steps, im->step);
    meter m = meter_open(w, im, run);
    const bool good = run_through(&m, errors, reason) && read_measures(&m, value, reason, notes);
    meter_close(&m);
    w->kind->stop(run);
    return good;
}
