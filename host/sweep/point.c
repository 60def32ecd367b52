/* point.c: running one point. */
#include "point.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/zero.h"
#include "host/run/belief.h"
#include "host/run/slow.h"
#include "host/run/start.h"
#include "host/run/undefined.h"

/* Steps between two questions whether to give up. */
#define ABANDON_STEPS 4096U

int sweep_columns(const sweep *s) {
    return s->measures->count + (s->measures->mechanism.is_system ? 0 : 1);
}

bool sweep_can_share(const grid *g, const program *p) {
    return !grid_varies_parameters(g) && p->conserved->count == 0;
}

/* --- the point in numbers ----------------------------------------------------------------------*/

/* The swept values as changes of the command line, behind the others and so over them. Numbers of
 * 17 digits: none is lost. Free `.values` and what it points to with forget(). */
static overrides changes_at(const sweep *s, uint64_t point) {
    const grid *g = s->grid;
    overrides changes = *s->changes;
    double *value = room(g->count, sizeof *value);
    const char **texts = room(g->count, sizeof(const char *));
    grid_values(g, point, value);
    changes.value_count = 0;
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        const size_t size = strlen(a->name) + NUMBER_SIZE;
        char *text = room((int64_t)size, 1);
        if (a->symbol == NULL) {
            snprintf(text, size, "%.17g", value[i]);
            if (changes.step != s->changes->step) {
                free((void *)(uintptr_t)changes.step); /* a step swept twice: the last holds */
            }
            changes.step = text;
        } else {
            snprintf(text, size, "%s=%.17g", a->name, value[i]);
            texts[changes.value_count++] = text;
        }
    }
    changes.values = texts;
    free(value);
    return changes;
}

static void forget(const sweep *s, overrides *changes) {
    for (int i = 0; i < changes->value_count; i++) {
        free((void *)(uintptr_t)changes->values[i]);
    }
    free((void *)(uintptr_t)changes->values);
    if (changes->step != s->changes->step) {
        free((void *)(uintptr_t)changes->step);
    }
}

/* --- measuring ---------------------------------------------------------------------------------*/

/* Where a measured expression is read: in the state itself, or among the outputs. */
typedef struct channel {
    enum { FROM_ANGLE, FROM_REAL, FROM_OUTPUT } where;
    int index;
} channel;

static channel channel_of(const program *p, const expr *e, int output) {
    for (int i = 0; i < p->angles && e->op == EXPR_SYMBOL; i++) {
        if (p->angle[i].unknown == e->symbol->index && p->angle[i].primes == e->primes &&
            e->symbol->order > 0) {
            return (channel){FROM_ANGLE, i};
        }
    }
    for (int i = 0; i < p->reals && e->op == EXPR_SYMBOL; i++) {
        if (p->real[i].unknown == e->symbol->index && p->real[i].primes == e->primes &&
            e->symbol->order > 0) {
            return (channel){FROM_REAL, i};
        }
    }
    return (channel){FROM_OUTPUT, output};
}

typedef struct meter {
    const sweep *sweep;
    const program *program;
    const equations *equations;
    void *run;
    books *books;      /* NULL without energies */
    channel *channels; /* [measures] */
    gauge *gauges;     /* [measures] */
    double *output;
    bool series;            /* some measure takes a sample each step */
    bool series_of_outputs; /* and one of those reads an output */
} meter;

static meter meter_open(const sweep *s, const program *p, const equations *e, const instance *inst,
                        void *run) {
    const int count = s->measures->count;
    meter m = {.sweep = s, .program = p, .equations = e, .run = run};
    m.books = books_open_of(p, e, inst);
    m.channels = room(count, sizeof *m.channels);
    m.gauges = room(count, sizeof *m.gauges);
    m.output = room(p->outputs, sizeof *m.output);
    for (int i = 0; i < count; i++) {
        const measure *each = &s->measures->list[i];
        m.channels[i] = channel_of(p, each->of, i);
        m.gauges[i] = gauge_start(each->kind);
        if (each->kind != MEASURE_FINAL) {
            m.series = true;
            m.series_of_outputs = m.series_of_outputs || m.channels[i].where == FROM_OUTPUT;
        }
    }
    return m;
}

static void meter_close(meter *m) {
    for (int i = 0; i < m->sweep->measures->count; i++) {
        gauge_end(&m->gauges[i]);
    }
    books_close(m->books);
    free(m->channels);
    free(m->gauges);
    free(m->output);
}

/* Take a sample of the present state: of the series, or of the final values. */
static void meter_enter(meter *m, bool final) {
    double angle_rad[PROGRAM_COMPONENTS_MAX];
    double real[2 * PROGRAM_COMPONENTS_MAX];
    const engine_kind *kind = m->sweep->kind;
    kind->state(m->run, angle_rad, real);
    if (final || m->series_of_outputs) {
        kind->outputs(m->run, m->output);
    }
    for (int i = 0; i < m->sweep->measures->count; i++) {
        if ((m->gauges[i].kind == MEASURE_FINAL) != final) {
            continue;
        }
        const channel c = m->channels[i];
        gauge_enter(&m->gauges[i], c.where == FROM_ANGLE  ? angle_rad[c.index]
                                   : c.where == FROM_REAL ? real[c.index]
                                                          : m->output[c.index]);
    }
}

static bool keeps_samples(const measures *m) {
    for (int i = 0; i < m->count; i++) {
        if (m->list[i].kind == MEASURE_PERIOD) {
            return true;
        }
    }
    return false;
}

/* Why the step or the energies are no numbers, if it can be told. */
static bool tell_undefined(const meter *m, const instance *inst, wh_status status, diags *errors) {
    const engine_kind *kind = m->sweep->kind;
    if (status != WH_OK) {
        return undefined_step(m->equations, m->program, inst, kind, m->run, status, errors);
    }
    char when[60];
    snprintf(when, sizeof when, "at t = %.9g s", m->books->undefined_s);
    const undefined_at at = {.equations = m->equations,
                             .program = m->program,
                             .instance = inst,
                             .angle_rad = m->books->angle_rad,
                             .real = m->books->real,
                             .turns = kind == &engine_float,
                             .when = when};
    return undefined_angle(&at, errors) || undefined_term(&at, errors);
}

/* Enter the books. False when an energy is not a finite number, said. */
static bool balance(meter *m, const instance *inst, diags *errors, FILE *reason) {
    if (m->books == NULL) {
        return true;
    }
    books_enter(m->books, m->sweep->kind, m->run);
    if (m->books->undefined && !tell_undefined(m, inst, WH_OK, errors)) {
        fprintf(reason, "the energies are not finite numbers at t = %.9g s", m->books->undefined_s);
    }
    return !m->books->undefined;
}

/* Step to the end. False when the run failed, said on `reason` or reported. */
static bool run_through(meter *m, const instance *inst, bool (*abandon)(void), diags *errors,
                        FILE *reason) {
    const engine_kind *kind = m->sweep->kind;
    const uint64_t steps = inst->steps;
    /* the first step at or after from_s, which rounding may put just beside a step */
    const double from = number_ceiling(m->sweep->from_s / inst->step_s * (1.0 - 1e-12));
    if (m->series && from > (double)steps) {
        fprintf(reason, "--from %.9g s lies behind the last step", m->sweep->from_s);
        return false;
    }
    if (keeps_samples(m->sweep->measures) && (double)steps - from >= (double)PERIOD_SAMPLES_MAX) {
        fprintf(reason, "period() takes at most %.0e samples: a later --from or a larger step",
                (double)PERIOD_SAMPLES_MAX);
        return false;
    }
    for (uint64_t step = 0;; step++) {
        if (!balance(m, inst, errors, reason)) {
            return false;
        }
        if (m->series && (double)step >= from) {
            meter_enter(m, false);
        }
        if (step == steps || (step % ABANDON_STEPS == 0 && abandon != NULL && abandon())) {
            break;
        }
        const wh_status status = kind->step(m->run);
        if (status != WH_OK) {
            if (!tell_undefined(m, inst, status, errors)) {
                fprintf(reason, "diverged in the step after t = %.9g s",
                        ratio_times(step, inst->step));
            }
            return false;
        }
    }
    meter_enter(m, true);
    return true;
}

/* The measures, and behind them the balance; NAN where it is not known. */
static bool read_measures(const meter *m, const instance *inst, double *measured, FILE *reason,
                          point_notes *notes) {
    const sweep *s = m->sweep;
    const double epsilon = s->kind == &engine_float ? (double)FLT_EPSILON : DBL_EPSILON;
    for (int i = 0; i < s->measures->count; i++) {
        if (m->gauges[i].undefined) {
            fprintf(reason, "what the measure '%s' takes is not a finite number throughout",
                    s->measures->list[i].name);
            return false;
        }
        measured[i] = gauge_result(&m->gauges[i], inst->step_s, epsilon);
        const bool no_period = isnan(measured[i]) && m->gauges[i].kind == MEASURE_PERIOD;
        if (!isfinite(measured[i]) && !no_period) {
            fprintf(reason, "the measure '%s' is not a finite number: what it takes is too large",
                    s->measures->list[i].name);
            return false;
        }
    }
    const belief kept = belief_of(m->books, s->kind, m->run);
    measured[s->measures->count] = kept.known ? kept.ratio : (double)NAN;
    notes->unbelieved = belief_lost(&kept, BELIEF_LIMIT);
    return true;
}

static bool measure_run(const sweep *s, const program *p, const equations *e, const instance *inst,
                        bool (*abandon)(void), double *measured, diags *errors, FILE *reason,
                        point_notes *notes) {
    void *run = s->kind->start(p, inst, &s->engine);
    meter m = meter_open(s, p, e, inst, run);
    const bool good = run_through(&m, inst, abandon, errors, reason) &&
                      read_measures(&m, inst, measured, reason, notes);
    if (good && p->contacts != NULL) {
        s->kind->events(run, &notes->overruns);
    }
    notes->slow = good ? slow_count(s->kind, p, run) : 0;
    meter_close(&m);
    s->kind->stop(run);
    return good;
}

/* The first message, without its place, source line and hint. */
static void tell_first(diags *errors, FILE *reason) {
    char *text = NULL;
    size_t length = 0;
    FILE *memory = room_text(&text, &length);
    diags_flush(errors, memory);
    room_text_end(memory);
    const char *start = strstr(text, "error: ");
    start = start == NULL ? text : start + strlen("error: ");
    fprintf(reason, "%.*s", (int)strcspn(start, "\n"), start);
    free(text);
}

static bool measure_point(const sweep *s, uint64_t point, bool (*abandon)(void), double *measured,
                          FILE *reason, point_notes *notes) {
    diags *errors = diags_new();
    overrides changes = changes_at(s, point);
    instance *inst = instance_make(&s->measures->mechanism, s->scene, &changes, errors);
    equations *e = NULL;
    program *own = NULL;
    bool good = inst != NULL;
    if (good && s->shared == NULL) {
        e = equations_derive(inst, errors);
        own = e == NULL ? NULL : program_make(e, inst->conserve, errors);
        good = own != NULL;
    }
    const program *p = own != NULL ? own : s->shared;
    good = good && start_has_method(p, inst, s->engine.method, errors) &&
           start_is_possible(p, inst, s->kind, errors);
    if (good) {
        good = measure_run(s, p, own != NULL ? e : s->equations, inst, abandon, measured, errors,
                           reason, notes);
    }
    if (diags_count(errors) > 0) {
        tell_first(errors, reason);
    }
    program_free(own);
    equations_free(e);
    instance_free(inst);
    forget(s, &changes);
    diags_free(errors);
    return good;
}

/* --- rows --------------------------------------------------------------------------------------*/

/* A field of a header: quoted where RFC 4180 wants it. */
static void header_field(FILE *out, const char *text) {
    if (strpbrk(text, ",\"\r\n") == NULL) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text != '\0'; text++) {
        if (*text == '"') {
            fputc('"', out);
        }
        fputc(*text, out);
    }
    fputc('"', out);
}

void sweep_header(const sweep *s, FILE *out) {
    for (int i = 0; i < s->grid->count; i++) {
        header_field(out, s->grid->axes[i].column);
        fputc(',', out);
    }
    for (int i = 0; i < s->measures->count; i++) {
        header_field(out, s->measures->list[i].name);
        fputs(i + 1 < sweep_columns(s) ? "," : "\r\n", out);
    }
    if (sweep_columns(s) > s->measures->count) {
        fputs(BELIEF_COLUMN "\r\n", out);
    }
}

void sweep_swept_fields(const sweep *s, uint64_t point, FILE *out) {
    double *value = room(s->grid->count, sizeof *value);
    char text[NUMBER_SIZE];
    grid_values(s->grid, point, value);
    for (int i = 0; i < s->grid->count; i++) {
        fprintf(out, "%s%s", i > 0 ? "," : "", number_shortest(value[i], text));
    }
    free(value);
}

bool sweep_point(const sweep *s, uint64_t point, bool (*abandon)(void), FILE *row, FILE *reason,
                 point_notes *notes) {
    double *measured = room(s->measures->count + 1, sizeof *measured);
    *notes = (point_notes){0};
    const bool good = measure_point(s, point, abandon, measured, reason, notes);
    sweep_swept_fields(s, point, row);
    for (int i = 0; i < s->measures->count; i++) {
        fputc(',', row);
        if (good) {
            fprintf(row, "%.*g", s->kind->digits, number_shown(measured[i]));
        }
    }
    if (sweep_columns(s) > s->measures->count) {
        fputc(',', row);
        if (good && !isnan(measured[s->measures->count])) {
            fprintf(row, "%.3e", measured[s->measures->count]);
        }
    }
    fputs("\r\n", row);
    free(measured);
    return good;
}
