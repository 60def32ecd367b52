/* simulate.c: the loop of a run, with its records, plots and messages. */
#include "simulate.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/base/exit.h"
#include "host/check/findings.h"
#include "host/check/horizon.h"
#include "host/check/nonfinite.h"
#include "host/check/run_json.h"
#include "host/check/summary.h"
#include "host/io/minmax_decimation.h"
#include "host/io/records.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/system.h"

#define MARKS 400.0 /* most events that a picture shows */

typedef struct simulation {
    const image *image;
    const simulation_settings *settings;
    void *run;
    records *records;
    run_checks *checks;
    FILE *csv;
    FILE *columns;
    FILE *vcd;
    traces *traces;   /* NULL without --vcd */
    decimation *plot; /* NULL without a picture */
    plot_run course;  /* names and marks for a picture, and for the description of the CSV file */
    opening opening;  /* first sentence of the summary */
    bool write_failed;
    double shown_s;       /* clock time when the progress was last shown */
    char *said;           /* text of the findings */
    diags *undefined;     /* errors about energies and outputs that were not finite */
    int output;           /* the first output that was not a finite number, or -1 */
    double output_s;      /* time when an output was first not finite */
    uint64_t output_rows; /* number of checked rows in which an output was not finite */
} simulation;

/* Returns false if the file cannot be opened. NULL is fine. */
static bool open_records(const char *name, FILE **file) {
    if (name != NULL) {
        *file = atomic_file_open(name);
    }
    return name == NULL || *file != NULL;
}

static bool open_files(simulation *sim) {
    const simulation_settings *s = sim->settings;
    if (s->plot != NULL && !plot_fits("run", &s->choice, &sim->course, 1)) {
        return false;
    }
    int power;
    if (s->vcd != NULL && !traces_power(sim->image, &power)) {
        fputs("whirl run: error: --vcd cannot resolve the times of these records: its finest unit "
              "is a femtosecond, and a time has at most 2^52 units\nhint: "
              "use --csv, which has no such limit\n",
              stderr);
        return false;
    }
    if (!open_records(s->csv, &sim->csv) || !open_records(s->columns, &sim->columns) ||
        !open_records(s->vcd, &sim->vcd)) {
        return false;
    }
    if (s->plot != NULL || s->taken != NULL) {
        sim->plot = decimation_new(sim->records->columns, plot_is_path(&s->choice));
    }
    return true;
}

/* Undefined energies make a run fail at its end. Until then the motion and its records continue. */
static void tell_energies(simulation *sim) {
    const books *b = sim->checks->books;
    if (b == NULL || !b->undefined || diags_count(sim->undefined) > 0) {
        return;
    }
    if (!nonfinite_energies(sim->image, sim->settings->kind, b->state, b->undefined_s,
                            sim->undefined)) {
        diag_error(sim->undefined, sim->image->mechanism_at, NULL,
                   "at t = %.9g s the energies and powers of '%s' are not finite numbers",
                   b->undefined_s, sim->image->mechanism);
    }
}

/* Notes an output that is not finite. The run then fails at its end. */
static void watch_outputs(simulation *sim, double time_s) {
    const int own = sim->image->own_outputs;
    const double *value = sim->records->row + (sim->records->columns - own);
    for (int i = 0; i < own && sim->output < 0; i++) {
        if (!isfinite(value[i])) {
            sim->output = i;
            sim->output_s = time_s;
        }
    }
    sim->output_rows += sim->output >= 0 && !isfinite(value[sim->output]) ? 1 : 0;
}

static void tell_outputs(simulation *sim) {
    if (sim->output < 0) {
        return;
    }
    const image_quantity *s = &sim->image->output[sim->output];
    char text[STATEMENT_SIZE];
    char rows[80] = "";
    statement_text(s->at, text, sizeof text);
    if (sim->output_rows > 1) {
        snprintf(rows, sizeof rows, " (and in %llu more records)",
                 (unsigned long long)sim->output_rows - 1);
    }
    diag_error(sim->undefined, s->at, "write a formula that is finite in every state of the run",
               "at t = %.9g s%s the output '%s' is not a finite number: %s", sim->output_s, rows,
               s->name, text);
}

static bool has_records(const simulation *sim) {
    return sim->csv != NULL || sim->columns != NULL || sim->vcd != NULL;
}

/* Marks the step's events in the plot, except releases of stops. */
static void mark_events(simulation *sim, uint64_t step) {
    engine_event list[WH_EVENT_LOG];
    plot_run *to = &sim->course;
    const image *im = sim->image;
    const int count = im->contacts > 0 ? sim->settings->kind->happened(sim->run, list) : 0;
    for (int i = 0; i < count; i++) {
        const double at_s = ratio_times(step - 1, im->step) + list[i].at_s;
        const bool counts = im->contact[list[i].contact].kind != WH_STOP || list[i].strikes;
        if (counts && (to->marks == 0 || at_s - to->mark_s[to->marks - 1] > im->until_s / MARKS)) {
            to->mark_s = alloc_more(to->mark_s, to->marks + 1, sizeof *to->mark_s);
            to->mark_s[to->marks++] = at_s;
        }
    }
}

static void enter(simulation *sim, uint64_t step) {
    const bool record =
        has_records(sim) && (step % sim->settings->every == 0 || step == sim->image->steps);
    if (sim->traces != NULL) {
        traces_step(sim->traces, sim->run, step);
    }
    run_checks_enter(sim->checks);
    tell_energies(sim);
    if (step > 0 && (sim->csv != NULL || sim->plot != NULL)) {
        mark_events(sim, step);
    }
    const bool opens = !sim->settings->quiet && step % sim->opening.each == 0;
    if (!record && sim->plot == NULL && !opens) {
        return;
    }
    records_read(sim->records, sim->run, ratio_times(step, sim->image->step));
    if (opens) {
        opening_enter(&sim->opening, sim->records);
    }
    if (!record && sim->plot == NULL) {
        return;
    }
    watch_outputs(sim, sim->records->row[0]);
    if (record) {
        sim->write_failed = !records_write(sim->records) || sim->write_failed;
        if (sim->traces != NULL) {
            sim->write_failed = !traces_record(sim->traces, step) || sim->write_failed;
        }
    }
    if (sim->plot != NULL) {
        decimation_enter(sim->plot, sim->records->row);
    }
}

static bool see(void *of, uint64_t step) {
    simulation *sim = of;
    enter(sim, step);
    if (sim->settings->progress && (step & 255U) == 0 && system_now_s() - sim->shown_s > 0.2) {
        sim->shown_s = system_now_s();
        fprintf(stderr, "\r%5.1f %%", 100.0 * (double)step / (double)sim->image->steps);
    }
    return !sim->write_failed;
}

static wh_status go(simulation *sim, bool *ended) {
    const simulation_settings *s = sim->settings;
    const loop l = {.kind = s->kind,
                    .run = sim->run,
                    .steps = sim->image->steps,
                    .own = &sim->checks->own,
                    .see = see,
                    .of = sim};
    wh_status status;
    sim->shown_s = system_now_s();
    *ended = loop_run(&l, &status) == LOOP_INTERRUPTED;
    if (s->progress) {
        fprintf(stderr, "\r        \r");
    }
    return status;
}

/* Printed with --quiet, too, because the result is incomplete. */
static void say_interrupted(const simulation *sim) {
    const uint64_t done = sim->settings->kind->steps(sim->run);
    const double step_s = sim->image->step_s;
    const char *command = sim->settings->taken != NULL ? "" : " run"; /* or `plot`, `figure` */
    fprintf(stderr, "whirl%s: interrupted at t = %.9g s of %.9g s%s\n", command,
            (double)done * step_s, (double)sim->image->steps * step_s,
            has_records(sim) ? "; the records so far are kept" : "");
}

/* Warns of values that were clamped to their ranges: the run has not failed, but this is hardly intended. */
static void say_saturated(const simulation *sim) {
    const engine_kind *kind = sim->settings->kind;
    const uint64_t held = kind->saturated != NULL ? kind->saturated(sim->run) : 0;
    if (held > 0) {
        fprintf(stderr,
                "whirl run: warning: %" PRIu64
                " value%s saturated at an end of the range\nhint: widen it: range NAME = A .. B\n",
                held, held == 1 ? "" : "s");
    }
}

static void say_clamped(const simulation *sim) {
    const engine_kind *kind = sim->settings->kind;
    const engine_clamped c =
        kind->clamped != NULL ? kind->clamped(sim->run) : (engine_clamped){.count = 0};
    if (c.count > 0) {
        char statement[STATEMENT_SIZE];
        statement_text(sim->image->contact[c.contact].at, statement, sizeof statement);
        fprintf(stderr,
                "whirl run: warning: the restitution was outside 0 .. 1 in %" PRIu64
                " impact%s; the first value was %.6g, in the step after t = %.6g s. Whirl used %d "
                "instead. The statement is: %s\nhint: limit the expression: restitution"
                " max(0, min(1, ...))\n",
                c.count, c.count == 1 ? "" : "s", c.value, c.begin_s, c.value > 1.0 ? 1 : 0,
                statement);
    }
}

/* Says why the run failed, on standard error and for --json: a failed step, undefined values, or both. */
static void say_failure(simulation *sim, wh_status status) {
    size_t length;
    FILE *text = alloc_text(&sim->said, &length);
    if (status != WH_OK) {
        failure_say(text, status, sim->checks);
    }
    diags_flush(sim->undefined, text);
    alloc_text_end(text);
    fputs(sim->said, stderr);
}

static simulation_result conclude(simulation *sim, wh_status status, bool ended) {
    const simulation_settings *s = sim->settings;
    records_read(sim->records, sim->run, ratio_times(s->kind->steps(sim->run), sim->image->step));
    if (status != WH_OK) { /* report only the failed step, not undefined energies */
        diags_free(sim->undefined);
        sim->undefined = diags_new();
    } else if (sim->output < 0) {
        /* an output is checked at the end, too, even if it is not recorded */
        watch_outputs(sim, sim->records->row[0]);
    }
    tell_outputs(sim);
    say_saturated(sim);
    say_clamped(sim);
    const bool undefined = diags_count(sim->undefined) > 0;
    if (status != WH_OK || undefined) {
        say_failure(sim, status);
    }
    const books *b = sim->checks->books;
    if (status == WH_OK && b != NULL && b->undefined && sim->output < 0) {
        findings_say_failed(stderr, sim->checks);
    }
    if (status != WH_OK || undefined) {
        return SIMULATION_FAILED;
    }
    const bool fails = s->strict > 0.0 && energy_residual_lost(&sim->checks->balance, s->strict);
    size_t length;
    FILE *text = alloc_text(&sim->said, &length);
    findings_say(text, sim->checks, fails);
    alloc_text_end(text);
    fputs(sim->said, stderr);
    return ended ? SIMULATION_INTERRUPTED : SIMULATION_DONE;
}

/* Names the quantities of a picture, as in the records. */
static void name_course(simulation *sim) {
    const image *im = sim->image;
    const records *r = sim->records;
    const char *words = im->title[0] != '\0' ? im->title : im->name;
    const char *changes = sim->settings->changes != NULL ? sim->settings->changes : "";
    char *title = alloc_words("%s%s%s", im->name, words != im->name ? ": " : "",
                              words != im->name ? words : "");
    char *label = alloc_words("%s%s%s", words, changes[0] != '\0' ? ", " : "", changes);
    plot_run_open(&sim->course, title, label, r->columns);
    plot_run_name(&sim->course, 0, "time", "s", "");
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        char *name = records_name(c);
        plot_run_name(&sim->course, i, name, c->unit->shown, c->text);
        free(name);
    }
    free(title);
    free(label);
}

/* Was the whole file written? Standard output is checked at the end of the program. */
static bool is_taken(FILE *file) {
    return file == NULL || file == stdout || (fflush(file) == 0 && ferror(file) == 0);
}

/* Either all record files and their description replace the old ones, or all old files stay. */
static bool close_records(simulation *sim, bool keep) {
    const simulation_settings *s = sim->settings;
    keep = keep && is_taken(sim->csv) && is_taken(sim->columns) && is_taken(sim->vcd);
    bool good = true;
    if (keep && sim->csv != NULL && sim->csv != stdout && atomic_file_is_regular(sim->csv)) {
        char *facts = about_facts(sim->image, s->kind, sim->run);
        char *tables = about_tables(sim->image);
        good = plot_run_about(s->csv, &sim->course, facts, tables);
        free(facts);
        free(tables);
    }
    keep = keep && good;
    good = atomic_file_close(sim->csv, s->csv, keep) && good;
    good = plot_run_csv_end(sim->columns, s->columns, keep, "run", sim->image->name) && good;
    return atomic_file_close(sim->vcd, s->vcd, keep) && good;
}

/* Draws the picture, or hands its data to the caller. */
static bool finish_course(simulation *sim) {
    if (sim->plot != NULL) {
        sim->course.data = decimation_rows(sim->plot, &sim->course.rows);
    }
    bool good = true;
    if (sim->settings->taken != NULL) {
        *sim->settings->taken = sim->course;
        sim->course = (plot_run){0};
    } else if (sim->settings->plot != NULL) {
        good = plot_draw("run", sim->settings->plot, &sim->settings->choice, &sim->course, 1);
    }
    return good;
}

FILE *simulation_summary(const simulation_settings *s) {
    const char *const files[] = {s->csv, s->columns, s->vcd};
    FILE *out = stdout;
    for (int i = 0; i < 3; i++) {
        out = files[i] != NULL && strcmp(files[i], "-") == 0 ? stderr : out;
    }
    return out;
}

/* Prints the opening sentence, the scene, the trusted time, unchecked findings, and the numbers. */
static void print_summary(simulation *sim, wh_status status, simulation_result result,
                          const horizon *h) {
    const simulation_settings *s = sim->settings;
    FILE *out = simulation_summary(s);
    if (status == WH_OK) {
        opening_enter(&sim->opening, sim->records);
        opening_print(out, &sim->opening, sim->records, sim->checks->books);
    }
    if (s->chosen != NULL) {
        fprintf(out, "%s%s\n", s->chosen,
                (sim->checks->warned & ~FINDING_OF_SCENE) != 0
                    ? "; the error of this step is within --error, but see the warning"
                    : "");
    }
    summary_head(out, sim->image, s->kind, sim->run);
    if (s->no_scene) {
        fputs("  no scene was named: every coordinate and rate without --start starts at zero\n",
              out);
    }
    if (s->changes != NULL && s->changes[0] != '\0') {
        fprintf(out, "  changed: %s\n", s->changes);
    }
    if (result == SIMULATION_DONE && h != NULL) {
        horizon_print_line(out, h, (sim->checks->warned & ~FINDING_OF_SCENE) != 0);
    } else if (result == SIMULATION_DONE && sim->image->steps > 0) {
        fputs("trusted            not computed, because that takes more than a second: run `whirl "
              "trust`\n",
              out);
    }
    const unsigned unlooked = run_checks_unlooked(sim->checks);
    if (result == SIMULATION_DONE && unlooked != 0) {
        fputs("not checked        ", out);
        finding_say_names(out, unlooked);
        const uint64_t unseen = pole_crossing_unseen(sim->checks->jumped);
        if (unseen > 0) {
            fprintf(out, ", poles and contacts in %" PRIu64 " of %" PRIu64 " steps", unseen,
                    sim->image->steps);
        }
        fputs(": the check takes more than a second\n", out);
    }
    summary_print(out, sim->image, s->kind, sim->run, sim->checks->books, &sim->checks->balance);
}

/* Sets *h (the caller frees it), the picture's trusted_s, and to->until_s. */
static void trust(simulation *sim, horizon *h, simulation_trust *to) {
    const run_checks *v = sim->checks;
    *h = horizon_of(v->doubling, HORIZON_TOLERANCE);
    if (!h->to_the_end) {
        sim->course.trusted_s = number_most(h->until_s, sim->image->step_s);
    }
    const bool doubted = h->to_the_end && (v->warned & ~FINDING_OF_SCENE) != 0;
    to->until_s = doubted ? -1.0 : horizon_trusted_s(h);
}

int simulation_status(simulation_result result, const simulation_trust *trust) {
    static const int status[] = {[SIMULATION_DONE] = EXIT_DONE,
                                 [SIMULATION_FAILED] = EXIT_RUN_FAILED,
                                 [SIMULATION_INTERRUPTED] = EXIT_INTERRUPTED,
                                 [SIMULATION_BAD_FILE] = EXIT_BAD_INPUT};
    return result == SIMULATION_DONE && trust->fails != 0 ? EXIT_RUN_FAILED : status[result];
}

simulation_result simulate(const image *im, const simulation_settings *s,
                           simulation_trust *outcome) {
    *outcome = (simulation_trust){.until_s = -1.0};
    simulation sim = {.image = im, .settings = s, .output = -1};
    sim.records = records_open(NULL, im, s->kind);
    name_course(&sim);
    simulation_result result = SIMULATION_BAD_FILE;
    if (open_files(&sim)) {
        bool ended = false;
        sim.run = s->kind->start(im);
        sim.checks = run_checks_open(im, s->kind, sim.run, NULL);
        sim.undefined = diags_new();
        sim.records->out = sim.csv;
        sim.records->plain = sim.columns;
        records_header(sim.records);
        records_read(sim.records, sim.run, 0.0);
        sim.opening = opening_begin(sim.records, im->steps);
        sim.traces = sim.vcd != NULL ? traces_open(sim.vcd, sim.records) : NULL;
        const wh_status status = go(&sim, &ended);
        run_checks_end(sim.checks, status);
        horizon h;
        const bool known = sim.checks->doubling != NULL && status == WH_OK;
        if (known) {
            trust(&sim, &h, outcome);
        }
        result = conclude(&sim, status, ended);
        outcome->fails = run_checks_fails(sim.checks, s->strict);
        outcome->over_budget = sim.checks->doubling == NULL;
        outcome->left = budget_left(&sim.checks->own);
        traces_close(sim.traces);
        result = close_records(&sim, true) ? result : SIMULATION_BAD_FILE;
        if (status == WH_OK && ended) {
            say_interrupted(&sim);
        }
        outcome->still = !opening_moves(&sim.opening, sim.records);
        if (!s->quiet && !s->json) {
            print_summary(&sim, status, result, known ? &h : NULL);
        }
        if (known) {
            horizon_free(&h);
        }
        opening_end(&sim.opening);
        if (result != SIMULATION_BAD_FILE && !finish_course(&sim)) {
            result = SIMULATION_BAD_FILE;
        }
        if (s->json) {
            run_json(stdout, &(run_json_request){sim.checks,
                                                 sim.records,
                                                 sim.said,
                                                 outcome->until_s,
                                                 result == SIMULATION_FAILED || s->strict > 0.0,
                                                 simulation_status(result, outcome),
                                                 {s->csv, s->columns, s->vcd, s->plot}});
        }
        free(sim.said);
        run_checks_close(sim.checks);
        s->kind->stop(sim.run);
        diags_free(sim.undefined);
    } else {
        (void)close_records(&sim, false);
    }
    records_close(sim.records);
    decimation_free(sim.plot);
    plot_run_close(&sim.course);
    return result;
}
