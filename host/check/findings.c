#include "findings.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "apart.h"
#include "core/contact.h"
#include "core/step/refuse.h"
#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/check/nonfinite.h"
#include "host/check/summary.h"
#include "host/number/functions.h"
#include "host/os/system.h"
#include "slow.h"

/* --- single findings ------------------------------------------------------------------------------------*/

static void say_mass(FILE *out, const run_checks *v) {
    fprintf(
        out,
        "%s of '%s' is nearly singular: even in double, round-off may cause an error of %.2g %% in its solution (limit 0.01 %%)",
        v->image->has_energies ? "the mass matrix" : "the matrix of the highest derivatives",
        v->image->mechanism, 100.0 * number_least(v->image->mass_blur, 1.0));
}

static void say_constants(FILE *out, const run_checks *v) {
    fprintf(
        out,
        "a constant of '%s' adds a small number to a large one, and rounding loses the small one: even in double, the error has no bound",
        v->image->mechanism);
}

/* Was the energy residual larger before the end? */
static bool is_before_the_end(const run_checks *v) {
    return v->found[FINDING_ENERGY].value > 2.0 * v->balance.ratio;
}

double findings_limit(const run_checks *v, finding_id id) {
    return id == FINDING_ENERGY && is_before_the_end(v) ? RUN_CHECKS_ON_THE_WAY
                                                        : finding_rows[id].limit;
}

static void say_energy(FILE *out, const run_checks *v) {
    const energy_residual *b = &v->balance;
    const double part = v->found[FINDING_ENERGY].value;
    const bool before = is_before_the_end(v);
    fprintf(
        out,
        "the energy balance fails: its residual %s %.3g J, %.2e of the largest entry of the energy balance",
        before ? "reached" : "is", before ? part * b->largest_J : b->left_J,
        before ? part : b->ratio);
    if (v->found[FINDING_ENERGY].reported) { /* else the residual exceeds only --strict's limit */
        fprintf(out, " (limit %g)", findings_limit(v, FINDING_ENERGY));
    }
    if (b->jump_s >= 0.0) {
        fprintf(out, ", most of it lost at about t = %.6g s", b->jump_s);
    }
}

static void say_accuracy(FILE *out, const run_checks *v) {
    const finding *f = &v->found[FINDING_ACCURACY];
    const horizon h = horizon_of(v->doubling, RUN_CHECKS_TOLERANCE);
    const horizon_column *c = &h.column[f->component];
    const record_column *column = &v->doubling->shape->column[f->component];
    const char *unit = column->unit->shown;
    char name[RECORDS_SHOWN_NAME];
    fprintf(out, "%s is accurate to %g of its range only until t = %.6g s of %.6g s",
            records_shown_name(column, name),
            c->until_s > f->at_s ? HORIZON_TOLERANCE : RUN_CHECKS_TOLERANCE, f->at_s,
            v->doubling->end_s);
    if (isfinite(c->off)) {
        fprintf(out, ": a finer run, in double, differs by up to %.2g %s", c->off, unit);
        if (c->range > 0.0) {
            fprintf(out, ", %.2g of the range", c->off / c->range);
        } else {
            fputs("; in this run it does not move", out);
        }
    } else {
        fputs(": a finer run, in double, diverges", out);
    }
    horizon_free((horizon *)&h);
}

static void say_pole(FILE *out, const run_checks *v) {
    char statement[STATEMENT_SIZE];
    const diagnostics_question *q = pole_crossing_over(v->jumped);
    statement_text(q->where, statement, sizeof statement);
    fprintf(
        out,
        "the step after t = %.6g s jumped over a pole, where %s grows without bound: %s; no motion continues through a pole",
        v->found[FINDING_POLE].at_s, q->what, statement);
}

static void say_missed(FILE *out, const run_checks *v) {
    const finding *f = &v->found[FINDING_MISSED];
    const image *im = v->image;
    char statement[STATEMENT_SIZE];
    if (pole_crossing_through(v->jumped).edge) {
        statement_text(im->contact[f->component].at, statement, sizeof statement);
        fprintf(out,
                "in the step after t = %.6g s a body slides over an edge of the stop that it rests "
                "on, but Whirl keeps the body on the stop: %s",
                f->at_s, statement);
        return;
    }
    fprintf(out, "the step after t = %.6g s %s ", f->at_s,
            f->value < 1.0 ? "may have passed" : "passed");
    if (f->component < im->contacts) {
        statement_text(im->contact[f->component].at, statement, sizeof statement);
        fprintf(out, "%s: %s",
                im->contact[f->component].kind == WH_FRICTION ? "over a brief change of a friction"
                                                              : "through a contact",
                statement);
    } else {
        const component c = image_component(im, f->component - im->contacts);
        fprintf(out,
                "over a force on %s that is far larger within the step than at the step's "
                "ends",
                im->unknown[c.unknown].name);
    }
}

static void say_aliased(FILE *out, const run_checks *v) {
    const step_doubling_aliased *a = &v->doubling->aliased;
    const record_column *column = &v->doubling->shape->column[a->column];
    const char *unit = column->unit->shown;
    const bool plain = strcmp(unit, "1") == 0;
    char name[RECORDS_SHOWN_NAME];
    fprintf(
        out,
        "the step aliases a fast force or motion: a run with steps of %.4g s, which do not alias "
        "it, gives %s = %.6g%s%s at t = %.6g s; this run gives %.6g",
        a->step_s, records_shown_name(column, name), a->other, plain ? "" : " ", plain ? "" : unit,
        a->at_s, a->value);
}

/* The contact with the most events in the overruns, not counting contact `besides`; -1: none. */
static int busiest(const run_checks *v, int besides) {
    int found = -1;
    for (int k = 0; k < v->image->contacts; k++) {
        if (k != besides && v->in_overruns[k] > 0 &&
            (found < 0 || v->in_overruns[k] > v->in_overruns[found])) {
            found = k;
        }
    }
    return found;
}

static void say_events(FILE *out, const run_checks *v) {
    char statement[STATEMENT_SIZE];
    const int first = busiest(v, -1);
    const int most[2] = {first, first < 0 ? -1 : busiest(v, first)};
    fprintf(out,
            "%" PRIu64 " step%s of %" PRIu64
            ", the first at t = %.6g s, had more than %d moments with events",
            v->overruns, v->overruns == 1 ? "" : "s", v->kind->steps(v->run), v->overran_s,
            WH_EVENTS_MAX);
    for (int i = 0; i < 2 && most[i] >= 0; i++) {
        statement_text(v->image->contact[most[i]].at, statement, sizeof statement);
        fprintf(out, "%s'%s'", i == 0 ? ", most of them from " : " and ", statement);
    }
    fprintf(out, ": Whirl completed %s with all loaded contacts at rest or sticking",
            v->overruns == 1 ? "that step" : "those steps");
}

static bool is_without_restitution(const image *im, int k) {
    const op_list *t = im->list[IMAGE_FORCES];
    const op *o = k >= 0 && im->contact[k].kind == WH_STOP
                      ? &t->ops[t->result[k * (WH_LAW_ROWS + 2 * im->coordinates) + WH_LAW_FIRST]]
                      : NULL;
    return o != NULL && o->code == OP_CONSTANT && o->value == 0.0;
}

static void say_apart(FILE *out, const run_checks *v) { (void)apart_say(out, NULL, v->image); }

static void say_digits(FILE *out, const run_checks *v) {
    slow_message(out, v->image, v->kind, v->run);
}

static void (*const say[FINDINGS])(FILE *, const run_checks *) = {
    [FINDING_CONSTANTS] = say_constants, [FINDING_MASS] = say_mass,
    [FINDING_ENERGY] = say_energy,       [FINDING_ACCURACY] = say_accuracy,
    [FINDING_POLE] = say_pole,           [FINDING_MISSED] = say_missed,
    [FINDING_ALIASED] = say_aliased,     [FINDING_EVENTS] = say_events,
    [FINDING_APART] = say_apart,         [FINDING_DIGITS] = say_digits,
};

/* --- trying remedies --------------------------------------------------------------------------------------*/
/* Options with which a run has no findings. Whirl names only options that it has tried. */

typedef enum remedy_outcome {
    REMEDY_DOES,    /* a run with these options has no findings */
    REMEDY_NONE,    /* no tried option helped */
    REMEDY_UNTRIED, /* no option was tried */
    REMEDY_DEAR     /* the budget was exhausted, or the user interrupted */
} remedy_outcome;

/* A remedy must stay below this part of the limits, because the user's next run may round differently. */
#define LEAVES 0.3
#define PARTS_MOST 20000.0    /* largest tried divisor of the run's step */
#define COMPENSATED_FROM 10.0 /* in float, sums are compensated if the divisor is at least this */

typedef struct request {
    double step_s;
    wh_method method;
    bool compensated;
    bool in_double;
} request;

typedef struct search {
    const image *image;
    const engine_kind *kind;
    budget *budget;
    double part;   /* factor on the limits of energy and accuracy */
    double a_step; /* operations of one step of the run, including the checks of this step */
    double stages; /* stages of the run's method */
    bool over_budget;
    request good; /* the settings of the trial without findings (try()) */
} search;

/* *made: the scene with the settings `w`. Returns false if the step is too small, or does not divide the duration. */
static bool image_with(const image *im, const request *w, image *made) {
    *made = *im;
    made->settings.method = w->method;
    made->settings.compensated = w->compensated;
    made->settings.matrix = MATRIX_NONE;
    made->list[IMAGE_MATRIX] = NULL;
    if (w->step_s == im->step_s) {
        return true;
    }
    if (!(w->step_s >= RATIO_LEAST)) {
        return false;
    }
    made->step = ratio_of(w->step_s);
    made->step_s = ratio_times(1, made->step);
    return ratio_count(ratio_of(im->until_s), made->step, &made->steps) && made->steps > 0;
}

/* Is a trial inaccurate? In double, only errors near its start count: a chaotic motion always has later errors. */
static bool is_off_at_once(const run_checks *v) {
    if (v->doubling == NULL) {
        return false;
    }
    const bool whole = v->kind == &engine_float;
    horizon h = horizon_of(v->doubling, whole ? RUN_CHECKS_TOLERANCE : HORIZON_TOLERANCE);
    const bool off = h.first >= 0 && h.column[h.first].verdict == HORIZON_UNTIL &&
                     (whole || h.until_s < RUN_CHECKS_BEGIN * v->doubling->end_s);
    horizon_free(&h);
    return off;
}

/* Called after each step of a trial. Ends the trial (false) after a jump over a pole or through a contact. */
static bool see(void *of, uint64_t step) {
    run_checks *v = of;
    (void)step;
    run_checks_enter(v);
    return !pole_crossing_some(v->jumped);
}

/* Runs the scene with settings *w. After a good run, sets s->good to *w. */
static bool try(search *s, const request *w) {
    image with;
    if (!image_with(s->image, w, &with)) {
        return false;
    }
    /* with contacts the number of events, and so of operations, is unknown */
    const double operations = with.contacts > 0 ? 0.0
                                                : (double)with.steps * s->a_step *
                                                      wh_methods[w->method].stages / s->stages;
    s->over_budget = s->over_budget || interrupted || operations > budget_left(s->budget);
    if (s->over_budget) {
        return false;
    }
    const engine_kind *kind = w->in_double ? &engine_double : s->kind;
    void *run = kind->start(&with);
    run_checks *v = run_checks_open(&with, kind, run, s->budget);
    v->part = s->part;
    const loop l = {
        .kind = kind, .run = run, .steps = with.steps, .pays = s->budget, .see = see, .of = v};
    wh_status status = WH_OK;
    /* v->doubling is NULL if the budget did not allow the finer run. Then the trial's error is unknown. */
    const loop_end end = v->doubling != NULL ? loop_run(&l, &status) : LOOP_SPENT;
    run_checks_end(v, status);
    const bool good = end == LOOP_DONE && (v->warned & ~FINDING_OF_SCENE) == 0 &&
                      (v->books == NULL || !v->books->undefined) && !is_off_at_once(v);
    s->good = good ? *w : s->good;
    s->over_budget = end == LOOP_SPENT || end == LOOP_INTERRUPTED;
    run_checks_close(v);
    kind->stop(run);
    return good;
}

static bool try_either(search *s, request w) {
    if (try(s, &w)) {
        return true;
    }
    w.in_double = true;
    w.compensated = s->image->settings.compensated;
    return s->kind == &engine_float && try(s, &w);
}

/* Tries ever finer steps: 1, 2 and 5 times powers of ten. */
static bool try_steps(search *s, request w, double parts) {
    w.step_s = step_nice_s(s->image->step_s / number_most(parts, 2.0));
    while (w.step_s > 0.0 && w.step_s * PARTS_MOST > s->image->step_s && !s->over_budget) {
        request now = w;
        now.compensated = w.compensated || (s->kind == &engine_float &&
                                            w.step_s * COMPENSATED_FROM <= s->image->step_s);
        if (try_either(s, now)) {
            return true;
        }
        w.step_s = step_nice_s(0.7 * w.step_s);
    }
    return false;
}

static remedy_outcome find(search *s, double parts) {
    const image *im = s->image;
    const wh_method own = im->settings.matrix == MATRIX_RK4 ? WH_RK4 : im->settings.method;
    request w = {im->step_s, own, im->settings.compensated, false};
    if (im->fixed != NULL || im->settings.matrix == MATRIX_EXACT || im->steps == 0) {
        return REMEDY_UNTRIED;
    }
    request other[2] = {w, w};
    other[0].compensated = true;
    other[1].in_double = true;
    for (int i = w.compensated ? 1 : 0; i < (s->kind == &engine_float ? 2 : 1); i++) {
        if (try(s, &other[i])) {
            return REMEDY_DOES;
        }
    }
    if (wh_methods[own].order < wh_methods[WH_METHOD_DEFAULT].order) {
        w.method = WH_METHOD_DEFAULT; /* try_steps() below uses this method, too */
        if (try_either(s, w)) {
            return REMEDY_DOES;
        }
        parts = 1.0;
    }
    return try_steps(s, w, parts) ? REMEDY_DOES : s->over_budget ? REMEDY_DEAR : REMEDY_NONE;
}

/* Prints a hint with the options that help. The first finer step is the run's step / `parts`. */
static remedy_outcome say_options(FILE *out, const run_checks *v, double parts) {
    const double steps = number_most((double)v->kind->steps(v->run), 1.0);
    budget_begin(v->budget);
    search s = {.image = v->image,
                .kind = v->kind,
                .budget = v->budget,
                .part = LEAVES,
                .a_step = (double)(v->budget->own + v->budget->spent) / steps,
                .stages = wh_methods[v->image->settings.method].stages};
    const remedy_outcome found = find(&s, parts);
    budget_end(v->budget);
    if (found == REMEDY_DOES) {
        char step[STEP_WORD];
        const image_settings *own = &s.image->settings;
        const request *w = &s.good;
        const bool other = w->method != own->method || own->matrix != MATRIX_NONE;
        const bool finer = w->step_s != s.image->step_s;
        fprintf(out, "hint:%s%s%s%s%s%s cures this (tried)\n", other ? " --method " : "",
                other ? wh_methods[w->method].word : "", finer ? " --step " : "",
                finer ? step_text(w->step_s, step) : "",
                w->compensated && !own->compensated ? " --compensated" : "",
                w->in_double ? " --number double" : "");
    }
    return found;
}

bool remedy_not_needed(const image *im, const engine_kind *kind) {
    budget all = {0};
    search s = {.image = im, .kind = kind, .budget = &all, .part = 1.0, .stages = 1.0};
    const request own = {im->step_s, im->settings.method, im->settings.compensated, false};
    budget_begin(&all);
    return try(&s, &own);
}

/* --- remedies ---------------------------------------------------------------------------------------------*/

static bool is_reported(const run_checks *v, finding_id id) { return v->found[id].reported; }

/* Prints a hint if no smaller step helps. Returns false if no hint was printed. */
static bool say_cause(FILE *out, const run_checks *v) {
    const energy_residual *b = &v->balance;
    const char *hint = NULL;
    if (pole_crossing_through(v->jumped).edge) {
        hint =
            "smooth the edge over a distance e that the motion covers in a few steps: write sqrt(x^2 + e^2) instead of abs(x), (a + b + sqrt((a - b)^2 + e^2))/2 instead of max(a, b)";
    } else if (is_reported(v, FINDING_MASS)) {
        hint =
            v->image->has_energies
                ? "give the heavy body the absolute coordinate, and give the light body's position relative to it"
                : "replace one of two nearly equal equations by their difference";
    } else if (is_reported(v, FINDING_CONSTANTS)) {
        hint = "declare the small number as a parameter of its own";
    } else if (is_reported(v, FINDING_ENERGY) && b->stabilized &&
               number_most(fabs(b->left_J), v->books->most_J) > 1.5 * b->lost_J) {
        hint = "leave out --stabilized: it corrected an energy error that is only round-off";
    } else if (is_reported(v, FINDING_ENERGY) && b->exact) {
        hint = "run with --number double: steps of --matrix exact have no error but round-off";
    } else if (is_reported(v, FINDING_ENERGY) && b->saturated) {
        hint =
            "declare a wider range: range NAME = A .. B; values outside it saturated, which changes the energy";
    } else if (v->warned == FINDING_BIT(FINDING_EVENTS) &&
               is_without_restitution(v->image, busiest(v, -1))) {
        hint =
            "use restitution 0.01, or a force that presses the bodies together: without a load, round-off repeatedly separates bodies that touch";
    }
    if (hint != NULL) {
        fprintf(out, "hint: %s\n", hint);
    }
    return hint != NULL;
}

/* If the run's step is divided by this number, the value of FINDING_ENERGY should become 3e-4. */
static double first_parts(const run_checks *v) {
    const wh_method_row *row = &wh_methods[v->image->settings.method];
    const double ratio = v->found[FINDING_ENERGY].value;
    return ratio > 0.0 ? number_power(number_least(ratio, 1.0) / 3e-4, 1.0 / row->order) : 1.0;
}

static void say_remedy(FILE *out, const run_checks *v) {
    const image *im = v->image;
    if (im->settings.tables != TABLES_NONE && is_reported(v, FINDING_ENERGY)) {
        char cells[40] = "";
        if (im->settings.cells > 0 && 2 * im->settings.cells <= IMAGE_CELLS_MOST) {
            snprintf(cells, sizeof cells, "--cells %d, or ", 2 * im->settings.cells);
        }
        fprintf(out, "hint: try %sno --tables: the tables may be too coarse\n", cells);
    }
    switch (say_options(out, v, first_parts(v))) {
    case REMEDY_DOES: return;
    case REMEDY_DEAR:
        fputs("hint: try a smaller --step (Whirl's own search for one would take more than a "
              "second)\n",
              out);
        break;
    case REMEDY_UNTRIED:
        if (im->fixed != NULL) {
            fputs("hint: try another --step, or --number double (Whirl tried neither)\n", out);
        }
        break;
    case REMEDY_NONE:
        fputs("hint: Whirl tried other steps, number types and methods; none removes the warning\n",
              out);
        break;
    }
    if (v->books != NULL && v->books->negative) {
        fprintf(
            out,
            "hint: correct T, or end the run earlier: the kinetic energy is negative from t = %.6g s on\n",
            v->books->negative_s);
    } else if (is_reported(v, FINDING_MISSED)) {
        const double began_s = v->found[FINDING_MISSED].at_s;
        const double passed_s = v->doubling != NULL ? v->doubling->jumped_s : -1.0;
        const double until_s = passed_s >= 0.0 ? number_least(passed_s, began_s) : began_s;
        if (v->found[FINDING_MISSED].value < 1.0) {
            fputs(
                "hint: replace poles and jumps, such as 1/x and sign(x), by smooth terms, which Whirl can bound\n",
                out);
        }
        if (until_s > 0.0) {
            fprintf(out, "hint: --until %.12gs ends the run before this step\n", until_s);
        }
    } else if (is_reported(v, FINDING_EVENTS)) {
        fputs(
            "hint: use restitution 0, or add hysteresis to the condition: this ends such events\n",
            out);
    } else if ((v->warned & ~FINDING_OF_SCENE) == FINDING_BIT(FINDING_ACCURACY) &&
               v->found[FINDING_ACCURACY].at_s > 0.0) {
        fputs("hint: end the run earlier with --until: in a chaotic motion every error grows\n",
              out);
    }
}

void findings_say(FILE *out, const run_checks *v, bool fails) {
    for (int id = 0; id < FINDINGS; id++) {
        const bool is_error = fails && id == FINDING_ENERGY;
        const bool is_warning = (v->warned & FINDING_BIT(id)) != 0;
        const bool is_elsewhere = id == FINDING_APART || id == FINDING_DIGITS;
        if (is_error || (is_reported(v, (finding_id)id) && !is_elsewhere)) {
            fprintf(out, "whirl run: %s: ", is_error ? "error" : is_warning ? "warning" : "note");
            say[id](out, v);
            fprintf(out, " [%s]\n", finding_rows[id].word);
        }
    }
    if ((fails || (v->warned & ~FINDING_OF_SCENE) != 0 || is_reported(v, FINDING_MASS)) &&
        !say_cause(out, v)) {
        if (fails) {
            fputs("hint: try a smaller --step\n", out);
        } else {
            say_remedy(out, v);
        }
    }
    slow_say(out, v->image, v->kind, v->run);
}

void findings_message(FILE *out, const run_checks *v, finding_id id) { say[id](out, v); }

bool findings_where(const run_checks *v, finding_id id, char name[FINDINGS_NAME]) {
    const int of = v->found[id].component;
    const image *im = v->image;
    if (id == FINDING_ACCURACY || id == FINDING_ALIASED) {
        (void)records_shown_name(&v->doubling->shape->column[of], name);
    } else if (id == FINDING_MISSED && of < im->contacts) {
        statement_text(im->contact[of].at, name, FINDINGS_NAME);
    } else if (id == FINDING_MISSED) {
        const component c = image_component(im, of - im->contacts);
        snprintf(name, FINDINGS_NAME, "%s%.*s", im->unknown[c.unknown].name, c.primes,
                 "''''''''''");
    } else {
        return false;
    }
    return true;
}

void findings_say_failed(FILE *out, const run_checks *v) { (void)say_options(out, v, 2.0); }

/* --- runs that failed -------------------------------------------------------------------------------------*/

static bool starts_beyond(const image *im) {
    bool found = false;
    for (int i = 0; i < im->reals; i++) {
        found = found || !(fabs(im->start_real[i]) < (double)WH_ABSURD);
    }
    return found;
}

/* The first contact that pushes more than one coordinate; -1: none. */
static int pushing(const image *im) {
    const int n = im->coordinates;
    for (int k = 0; k < im->forced; k++) {
        const op_list *t = im->list[IMAGE_FORCES];
        int entries = 0;
        for (int i = 0; i < n; i++) {
            const op *o = &t->ops[t->result[k * (WH_LAW_ROWS + 2 * n) + WH_LAW_ROWS + i]];
            entries += o->code != OP_CONSTANT || o->value != 0.0;
        }
        if (entries > 1) {
            return k;
        }
    }
    return -1;
}

void failure_say(FILE *out, wh_status status, const run_checks *v) {
    const engine_kind *kind = v->kind;
    const void *run = v->run;
    const image *im = v->image;
    diags *errors = diags_new();
    const bool known = nonfinite_step(im, kind, run, status, errors);
    diags_flush(errors, out);
    diags_free(errors);
    if (known) {
        /* after WH_E_SINGULAR no setting helps: the holds permit several motions */
        if (status != WH_E_SINGULAR) {
            findings_say_failed(out, v);
        }
        return;
    }
    const int fault = kind->fault(run);
    const component c = image_component(im, fault < 0 ? 0 : fault);
    const double time_s = ratio_times(kind->steps(run), im->step);
    fprintf(out, "whirl run: error: the run diverged in the step after t = %.9g s: %s", time_s,
            im->unknown[c.unknown].name);
    for (int k = 0; k < c.primes; k++) {
        fputc('\'', out);
    }
    fputs(" grew without bound\n", out);
    if (kind->steps(run) == 0 && starts_beyond(im)) {
        fprintf(out,
                "hint: choose an origin or units nearer to the motion: a start value is above the "
                "limit of %g in SI units\n",
                (double)WH_ABSURD);
        return;
    }
    const int k = pushing(im);
    if (k >= 0) {
        char statement[STATEMENT_SIZE];
        statement_text(im->contact[k].at, statement, sizeof statement);
        fprintf(
            out,
            "hint: '%s' exerts a force on every coordinate in this statement: if one of these coordinates only measures time, give it far more inertia, or declare it as an input with a rate\n",
            statement);
    }
    double *angle_rad = alloc(im->angles + im->reals, sizeof *angle_rad);
    int worst;
    kind->state(run, angle_rad, angle_rad + im->angles);
    /* without variants, round-off is that large only near a singular mass matrix */
    if (im->ways > 0 &&
        accelerations_doubt(im, angle_rad, angle_rad + im->angles, &worst) > ACCELERATIONS_DOUBT) {
        fprintf(
            out,
            "whirl run: note: the equations add numbers of very different sizes, so the acceleration of '%s' is "
            "probably wrong at this time\n" ACCELERATIONS_HINT,
            im->unknown[worst].name);
    } else {
        fputs(
            "hint: try a smaller --step; if the run still fails at this time, check whether the mass "
            "matrix is singular there\n",
            out);
    }
    free(angle_rad);
    findings_say_failed(out, v);
}
