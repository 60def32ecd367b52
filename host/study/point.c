/* point.c: running one point. */
#include "host/study/point.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/atomic_file.h"
#include "host/check/energy_residual.h"
#include "host/check/nonfinite.h"
#include "host/check/run_checks.h"
#include "host/check/step_doubling.h"
#include "host/derive/image_make.h"
#include "host/derive/lagrange.h"
#include "host/engine/start.h"
#include "host/lang/shown.h"
#include "host/number/functions.h"
#include "host/number/ratio.h"
#include "host/number/zero.h"

/* === a run of a sweep ========================================================================= */
/* One run of a sweep, measured. */

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

/* Enters the energy balance of the run. False, with a message, if an energy is not a finite number. */
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

/* Steps to the end. False if the run failed, with a message on `reason` or reported. */
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

/* The measures, followed by the balance; NAN if that is unknown. */
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

/* === a point ================================================================================== */

/* Ends that differ by this part of the time are alike. */
#define ENDS_ALIKE 1e-9

static bool has_balance(const sweep *s) { return !s->mechanism->is_system; }

int sweep_columns(const sweep *s) {
    return s->measures->count + (has_balance(s) ? 1 : 0) + (grid_step_axis(s->grid) >= 0 ? 1 : 0);
}

bool sweep_ends_are_alike(const sweep *s, double until_s) {
    const int at = grid_step_axis(s->grid);
    bool needed = false;
    for (int i = 0; i < s->measures->count; i++) {
        needed = needed || s->measures->list[i].kind == MEASURE_FINAL;
    }
    if (at < 0 || !needed) {
        return true;
    }
    double *value = alloc(s->grid->count, sizeof *value);
    double off_s = 0.0; /* the step whose end is furthest from the requested end */
    double most_s = ENDS_ALIKE * until_s;
    uint64_t steps_off = 0;
    for (uint64_t point = 0; point < s->grid->points; point++) {
        uint64_t steps;
        grid_values(s->grid, point, value);
        if (value[at] >= RATIO_LEAST &&
            ratio_count(ratio_of(until_s), ratio_of(value[at]), &steps) &&
            fabs(value[at] * (double)steps - until_s) > most_s) {
            most_s = fabs(value[at] * (double)steps - until_s);
            off_s = value[at];
            steps_off = steps;
        }
    }
    free(value);
    if (off_s > 0.0) {
        const double down = number_most(number_floor(until_s / off_s), 1.0);
        fprintf(stderr,
                "whirl sweep: error: the runs end at different times: with the step %.9g s at %.9g "
                "s, not at %.9g s, and a measure at the end would compare different moments\n"
                "hint: the nearest steps that divide %.9g s are %.9g s and %.9g s; or measure over "
                "the run, such as max(EXPR)\n",
                off_s, off_s * (double)steps_off, until_s, until_s, until_s / (down + 1.0),
                until_s / down);
    }
    return off_s == 0.0;
}

bool sweep_can_share(const grid *g, const image *im) {
    return !grid_varies_parameters(g) && im->recovered == 0;
}

/* --- the point in numbers ----------------------------------------------------------------------*/

/* The first message, without its place, source line and hint. */
static void tell_first(diags *errors, FILE *reason) {
    char *text = NULL;
    size_t length = 0;
    FILE *memory = alloc_text(&text, &length);
    diags_flush(errors, memory);
    alloc_text_end(memory);
    const char *start = strstr(text, "error: ");
    start = start == NULL ? text : start + strlen("error: ");
    fprintf(reason, "%.*s", (int)strcspn(start, "\n"), start);
    free(text);
}

static channel channel_of(const image *im, const expr *e, int output) {
    const bool moves = e->op == EXPR_SYMBOL && e->symbol->order > 0;
    const int i = moves ? image_find_component(im, e->symbol->index, e->primes) : -1;
    return i < 0            ? (channel){FROM_OUTPUT, output}
           : i < im->angles ? (channel){FROM_ANGLE, i}
                            : (channel){FROM_REAL, i - im->angles};
}

static image *image_at(const sweep *s, const instance *inst, image **plain, diags *errors) {
    image_settings other;
    if (s->shared != NULL) {
        return image_again(s->shared, inst, errors);
    }
    equations *e = equations_derive(inst, errors);
    image *im = e == NULL ? NULL : image_make(e, inst->conserve, &s->engine, IMAGE_TO_RUN, errors);
    if (im != NULL && plain != NULL && step_doubling_plain(&s->engine, &other)) {
        *plain = image_make(e, inst->conserve, &other, IMAGE_TO_RUN, errors);
    }
    equations_free(e);
    return im;
}

image *sweep_image(const sweep *s, uint64_t point, image **plain, diags *errors) {
    overrides changes = changes_at(s->grid, s->changes, point);
    instance *inst = instance_make(s->mechanism, s->scene, &changes, errors);
    image *im = inst != NULL ? image_at(s, inst, plain, errors) : NULL;
    instance_free(inst); /* only the image is needed from here on */
    changes_forget(s->changes, &changes);
    if (im != NULL && !(start_has_method(im, s->engine.method, errors) &&
                        start_is_possible(im, s->kind, errors))) {
        image_free(im);
        im = NULL;
    }
    return im;
}

static bool measure_image(const sweep *s, const image *im, double *value, diags *errors,
                          FILE *reason, point_notes *notes) {
    const int count = s->measures->count;
    measured *list = alloc(count, sizeof *list);
    for (int i = 0; i < count; i++) {
        const measure *each = &s->measures->list[i];
        list[i] = (measured){each->kind, each->name, channel_of(im, each->of, i)};
    }
    const measuring wanted = {s->kind, s->from_s, list, count, s->strict};
    const bool good = stepping_measure(&wanted, im, value, errors, reason, notes);
    free(list);
    return good;
}

static bool measure_point(const sweep *s, uint64_t point, double *value, FILE *reason,
                          point_notes *notes) {
    diags *errors = diags_new();
    image *im = sweep_image(s, point, NULL, errors);
    const bool good = im != NULL && measure_image(s, im, value, errors, reason, notes);
    if (diags_count(errors) > 0) {
        tell_first(errors, reason);
    }
    image_free(im);
    diags_free(errors);
    return good;
}

/* --- rows --------------------------------------------------------------------------------------*/

char *sweep_unit(const symbol *of, int primes) {
    if (of == NULL || unit_is_si(of->declared)) {
        return alloc_words("%s", "");
    }
    char *name = shown_unit_name(of, primes);
    char *unit = alloc_words(" [%s]", name);
    free(name);
    return unit;
}

static double in_unit(const symbol *of, double si) {
    return of == NULL || unit_is_si(of->declared) ? si
                                                  : si * of->declared.divisor / of->declared.scale;
}

static void header_field(FILE *out, const char *name, const symbol *of, int primes) {
    char *unit = sweep_unit(of, primes);
    char *text = alloc_words("%s%s", name, unit);
    atomic_file_field(out, text);
    free(text);
    free(unit);
}

void sweep_header(const sweep *s, FILE *out) {
    for (int i = 0; i < s->grid->count; i++) {
        const axis *a = &s->grid->axes[i];
        header_field(out, a->column, a->symbol, a->primes);
        fputc(',', out);
    }
    for (int i = 0; i < s->measures->count; i++) {
        const measure *m = &s->measures->list[i];
        header_field(out, m->name, measure_symbol(m), m->of->primes);
        fputs(i + 1 < s->measures->count ? "," : "", out);
    }
    fputs(has_balance(s) ? "," ENERGY_RESIDUAL_COLUMN : "", out);
    fputs(grid_step_axis(s->grid) >= 0 ? ",end_s\r\n" : "\r\n", out);
}

char *sweep_swept_value(const axis *a, double si, char text[NUMBER_SIZE]) {
    const double shown = in_unit(a->symbol, si);
    if (shown == si) {
        return number_shortest(si, text);
    }
    snprintf(text, NUMBER_SIZE, "%.15g", number_shown(shown)); /* 4 in, not 3.9999999999999996 in */
    return text;
}

void sweep_swept_fields(const sweep *s, uint64_t point, FILE *out) {
    double *value = alloc(s->grid->count, sizeof *value);
    char text[NUMBER_SIZE];
    grid_values(s->grid, point, value);
    for (int i = 0; i < s->grid->count; i++) {
        fprintf(out, "%s%s", i > 0 ? "," : "",
                sweep_swept_value(&s->grid->axes[i], value[i], text));
    }
    free(value);
}

bool sweep_point(const sweep *s, uint64_t point, FILE *row, FILE *reason, point_notes *notes) {
    double *value = alloc(s->measures->count + 1, sizeof *value);
    *notes = (point_notes){0};
    const bool good = measure_point(s, point, value, reason, notes);
    sweep_swept_fields(s, point, row);
    for (int i = 0; i < s->measures->count; i++) {
        fputc(',', row);
        if (good) {
            const symbol *of = measure_symbol(&s->measures->list[i]);
            fprintf(row, "%.*g", s->kind->digits, number_shown(in_unit(of, value[i])));
        }
    }
    if (has_balance(s)) {
        fputc(',', row);
        if (good && !isnan(value[s->measures->count])) {
            fprintf(row, "%.3e", value[s->measures->count]);
        }
    }
    if (grid_step_axis(s->grid) >= 0) {
        fputc(',', row);
        if (good) {
            fprintf(row, "%.15g", notes->end_s);
        }
    }
    fputs("\r\n", row);
    free(value);
    return good;
}
