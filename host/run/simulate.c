/* simulate.c: the loop of a run and what surrounds it. */
#include "simulate.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "books.h"
#include "host/plot/plot.h"
#include "records.h"
#include "shown.h"
#include "slow.h"
#include "summary.h"

/* A plot keeps at most so many rows, evenly spaced. */
#define PLOT_ROWS_MAX 4000U

typedef struct plot_rows {
    double *data;
    unsigned count;
    uint64_t spacing; /* steps */
} plot_rows;

typedef struct simulation {
    const equations *equations;
    const program *program;
    const simulation_settings *settings;
    void *run;
    records *records;
    books *books;
    FILE *csv;
    FILE *columns;
    plot_rows plot;
    uint64_t steps; /* wanted */
    double wall_s;  /* spent stepping */
    bool write_failed;
} simulation;

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* True when the file is open or there is none to open. */
static bool open_records(const char *name, FILE **file) {
    if (name != NULL) {
        *file = strcmp(name, "-") == 0 ? stdout : fopen(name, "wb");
        if (*file == NULL) {
            fprintf(stderr, "%s: error: cannot be written: %s\n", name, strerror(errno));
        }
    }
    return name == NULL || *file != NULL;
}

static bool flush_records(const char *name, FILE *file) {
    if (file != NULL && (fflush(file) != 0 || ferror(file) != 0)) {
        fprintf(stderr, "%s: error: cannot be written: %s\n",
                file == stdout ? "<standard output>" : name, strerror(errno));
        return false;
    }
    return true;
}

static void close_records(FILE *file) {
    if (file != NULL && file != stdout) {
        fclose(file);
    }
}

static bool open_files(simulation *sim) {
    const simulation_settings *s = sim->settings;
    if (s->plot != NULL && !plot_can_draw(s->plot)) {
        fprintf(stderr, "whirl run: error: --plot draws .svg and .png files, not %s\n", s->plot);
        return false;
    }
    if (!open_records(s->csv, &sim->csv) || !open_records(s->columns, &sim->columns)) {
        return false;
    }
    if (s->plot != NULL) {
        FILE *try = fopen(s->plot, "wb");
        if (try == NULL) {
            fprintf(stderr, "%s: error: cannot be written: %s\n", s->plot, strerror(errno));
            return false;
        }
        fclose(try);
        sim->plot.spacing = sim->steps / PLOT_ROWS_MAX + 1;
        sim->plot.data = calloc((size_t)PLOT_ROWS_MAX + 2,
                                (size_t)sim->records->columns * sizeof *sim->plot.data);
        if (sim->plot.data == NULL) {
            abort();
        }
    }
    return true;
}

/* Enter the present state wherever it belongs. */
static void enter(simulation *sim, uint64_t step, bool last) {
    const bool record =
        (sim->csv != NULL || sim->columns != NULL) && (step % sim->settings->every == 0);
    const bool point = sim->plot.data != NULL && (step % sim->plot.spacing == 0 || last) &&
                       sim->plot.count < PLOT_ROWS_MAX + 2;
    if (sim->books != NULL && !last) {
        books_enter(sim->books, sim->settings->kind, sim->run);
    }
    if (!record && !point) {
        return;
    }
    records_read(sim->records, sim->run, ratio_times(step, sim->equations->instance->step));
    if (record && !last) {
        sim->write_failed = !records_write(sim->records) || sim->write_failed;
    }
    if (point) {
        memcpy(sim->plot.data + (size_t)sim->plot.count * (size_t)sim->records->columns,
               sim->records->row, (size_t)sim->records->columns * sizeof(double));
        sim->plot.count++;
    }
}

static wh_status loop(simulation *sim, bool *interrupted) {
    const simulation_settings *s = sim->settings;
    wh_status status = WH_OK;
    double shown_s = now_s();
    uint64_t step = 0;
    enter(sim, 0, false);
    while (step < sim->steps && !sim->write_failed) {
        const double before_s = (step & 63U) == 0 ? now_s() : 0.0;
        status = s->kind->step(sim->run);
        if ((step & 63U) == 0) {
            sim->wall_s += now_s() - before_s;
        }
        if (status != WH_OK) {
            break;
        }
        step++;
        enter(sim, step, false);
        if ((step & 255U) == 0) {
            if (s->stop != NULL && *s->stop) {
                *interrupted = true;
                break;
            }
            if (s->progress && now_s() - shown_s > 0.2) {
                shown_s = now_s();
                fprintf(stderr, "\r%5.1f %%", 100.0 * (double)step / (double)sim->steps);
            }
        }
    }
    if (s->progress) {
        fprintf(stderr, "\r        \r");
    }
    if (step % sim->plot.spacing != 0) {
        enter(sim, step, true);
    }
    return status;
}

static void say_failure(const simulation *sim) {
    const program *p = sim->program;
    const int fault = sim->settings->kind->fault(sim->run);
    const component c =
        fault < p->angles ? p->angle[fault < 0 ? 0 : fault] : p->real[fault - p->angles];
    const double time_s =
        ratio_times(sim->settings->kind->steps(sim->run), sim->equations->instance->step);
    fprintf(stderr, "whirl run: error: the run diverged in the step after t = %.9g s: %s", time_s,
            sim->equations->unknowns[c.unknown].symbol->name);
    for (int k = 0; k < c.primes; k++) {
        fputc('\'', stderr);
    }
    fprintf(stderr, " left all bounds\nhint: a smaller --step may carry it further; if it fails at "
                    "the same time, look for a singular position there\n");
}

/* Said with --quiet, too: what was asked for is not what there is. */
static void say_interrupted(const simulation *sim) {
    const uint64_t done = sim->settings->kind->steps(sim->run);
    const double step_s = sim->equations->instance->step_s;
    fprintf(stderr, "whirl run: interrupted at t = %.9g s of %.9g s%s\n", (double)done * step_s,
            (double)sim->steps * step_s,
            sim->csv != NULL || sim->columns != NULL ? "; the records so far are kept" : "");
}

static bool draw(const simulation *sim) {
    const mechanism *m = sim->equations->instance->mechanism;
    const records *r = sim->records;
    curve *curves = calloc((size_t)r->columns, sizeof *curves);
    char **units = calloc((size_t)r->columns, sizeof *units);
    if (curves == NULL || units == NULL) {
        abort();
    }
    int count = 0;
    for (int i = 1; i < r->columns; i++) { /* coordinates and outputs: no rates */
        const record_column *c = &r->column[i];
        if (c->primes == 0) {
            units[count] = shown_unit_name(c->symbol, 0);
            curves[count] = (curve){c->symbol->name, units[count], i};
            count++;
        }
    }
    const char *title =
        sim->equations->instance->scene != NULL ? sim->equations->instance->scene->title : m->title;
    char full[256];
    snprintf(full, sizeof full, "%s%s%s", sim->equations->instance->name,
             title[0] != '\0' ? ": " : "", title);
    const bool drawn = plot_draw(sim->settings->plot, full, curves, count, sim->plot.data,
                                 (int)sim->plot.count, sim->records->columns);
    for (int i = 0; i < count; i++) {
        free(units[i]);
    }
    free(units);
    free(curves);
    return drawn;
}

simulation_result simulate(const equations *e, const program *p, const simulation_settings *s) {
    simulation sim = {.equations = e, .program = p, .settings = s, .plot = {.spacing = 1}};
    sim.steps = e->instance->steps;
    sim.records = records_open(NULL, p, e, s->kind);
    simulation_result result = SIMULATION_BAD_FILE;
    if (open_files(&sim)) {
        bool interrupted = false;
        sim.run = s->kind->start(p, e->instance, &s->engine);
        sim.books = s->quiet ? NULL : books_open(p, e);
        sim.records->out = sim.csv;
        sim.records->plain = sim.columns;
        records_header(sim.records);
        const wh_status status = loop(&sim, &interrupted);
        result = status != WH_OK ? SIMULATION_FAILED
                 : interrupted   ? SIMULATION_INTERRUPTED
                                 : SIMULATION_DONE;
        const bool csv_written = flush_records(s->csv, sim.csv);
        const bool columns_written = flush_records(s->columns, sim.columns);
        if (!csv_written || !columns_written) {
            result = SIMULATION_BAD_FILE;
        }
        if (status != WH_OK) {
            say_failure(&sim);
        } else if (interrupted) {
            say_interrupted(&sim);
        }
        slow_say(stderr, e, p, s->kind, sim.run);
        if (!s->quiet) {
            const uint64_t done = s->kind->steps(sim.run);
            const uint64_t samples = (done + 63) / 64;
            const double sampled = (double)samples;
            summary_print(sim.csv == stdout || sim.columns == stdout ? stderr : stdout, e, p, s,
                          sim.run, sim.books, sampled > 0.0 ? 1e9 * sim.wall_s / sampled : 0.0);
        }
        if (s->plot != NULL && result != SIMULATION_BAD_FILE && !draw(&sim)) {
            result = SIMULATION_BAD_FILE;
        }
        s->kind->stop(sim.run);
    }
    close_records(sim.csv);
    close_records(sim.columns);
    books_close(sim.books);
    records_close(sim.records);
    free(sim.plot.data);
    return result;
}
