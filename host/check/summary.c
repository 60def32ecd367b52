#include "host/check/summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "core/version.h"
#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/check/energy_residual.h"
#include "host/check/horizon.h"
#include "host/io/plot.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

double step_nice_s(double most_s) {
    static const double steps[] = {5.0, 2.0, 1.0};
    double decade = 1e3;
    for (int i = 0; i < 16; i++) {
        for (int k = 0; k < 3; k++) {
            if (steps[k] * decade <= most_s * (1.0 + 1e-9)) {
                return steps[k] * decade;
            }
        }
        decade /= 10.0;
    }
    return 0.0;
}

const char *step_text(double step_s, char text[STEP_WORD]) {
    static const struct {
        double s;
        const char *unit;
    } units[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}};
    int i = 0;
    while (i < 3 && step_s < 0.9999 * units[i].s) {
        i++;
    }
    for (int digits = 3; digits <= 17; digits++) { /* 200us, not 2e+02us */
        snprintf(text, STEP_WORD, "%.*g%s", digits, step_s / units[i].s, units[i].unit);
        const double off = strtod(text, NULL) * units[i].s / step_s - 1.0;
        if (off < 1e-14 && off > -1e-14) {
            break;
        }
    }
    return text;
}

/* === about ==================================================================================== */

char *about_facts(const image *im, const engine_kind *kind, const void *run) {
    char *stepper = alloc_words("%s%s", image_stepper(im), image_sums(im));
    char *method = plot_run_quoted(stepper);
    char *made = alloc_words(
        "whirl = \"" WH_VERSION "\"\n"
        "scene = \"%s\"\nmechanism = \"%s\"\nmethod = %s\nnumber = \"%s\"\n"
        "step_s = %.17g\nsteps = %" PRIu64 "\nstate_hash = \"0x%016" PRIx64 "\"\n",
        im->name, im->mechanism, method, kind->name, im->step_s, kind->steps(run), kind->hash(run));
    free(stepper);
    free(method);
    return made;
}

static void write_values(FILE *to, const char *table, const image_quantity *list, int count) {
    fprintf(to, "\n[%s] # SI\n", table);
    for (int i = 0; i < count; i++) {
        char text[40];
        snprintf(text, sizeof text, "%.15g", list[i].value);
        const bool whole = decimal_read(text, NULL) == list[i].value;
        fprintf(to, "\"%s\" = %.*g\n", list[i].name, whole ? 15 : 17, list[i].value);
    }
}

char *about_tables(const image *im) {
    char *made = NULL;
    size_t length = 0;
    FILE *to = alloc_text(&made, &length);
    write_values(to, "parameters", im->parameter, im->parameters);
    write_values(to, "inputs", im->input, im->inputs);
    alloc_text_end(to);
    return made;
}

/* === the opening sentence ===================================================================== */

/* ROWS: limit on the sampled rows of a run. NAMED: limit on the coordinates in the sentence. */
enum { ROWS = 100000, NAMED = 3 };
#define STAYS 1e-6

opening opening_begin(const records *r, uint64_t steps) {
    opening o = {.each = steps / ROWS + 1};
    o.first = alloc(3 * (int64_t)r->columns, sizeof *o.first);
    o.low = o.first + r->columns;
    o.high = o.low + r->columns;
    memcpy(o.first, r->row, (size_t)r->columns * sizeof *o.first);
    memcpy(o.low, r->row, (size_t)r->columns * sizeof *o.low);
    memcpy(o.high, r->row, (size_t)r->columns * sizeof *o.high);
    return o;
}

void opening_end(opening *o) { free(o->first); }

void opening_enter(opening *o, const records *r) {
    for (int i = 0; i < r->columns; i++) {
        o->low[i] = r->row[i] < o->low[i] ? r->row[i] : o->low[i];
        o->high[i] = r->row[i] > o->high[i] ? r->row[i] : o->high[i];
    }
}

static double strayed(const opening *o, int i) {
    return number_most(o->high[i] - o->first[i], o->first[i] - o->low[i]);
}

/* Is output i a length that moves by less than STAYS times `most`, the largest range of a length? */
static bool stays(const opening *o, const records *r, int i, double most) {
    const record_column *c = &r->column[i];
    return c->unknown < 0 && strcmp(c->unit->si, "m") == 0 &&
           strayed(o, i) * c->unit->scale / c->unit->divisor < STAYS * most;
}

/* Does column i move? It must be a coordinate or, if `is_output`, an output that is a length. */
static bool moves(const opening *o, const records *r, int i, bool is_output) {
    const record_column *c = &r->column[i];
    return c->primes == 0 && o->high[i] > o->low[i] &&
           (is_output ? c->unknown < 0 && strcmp(c->unit->si, "m") == 0 : c->unknown >= 0);
}

/* Returns the marked column whose name is the first in the alphabet, or -1. */
static int next_by_name(const records *r, const bool *marked) {
    int next = -1;
    for (int i = 1; i < r->columns; i++) {
        if (marked[i] && (next < 0 || strcmp(r->column[i].name, r->column[next].name) < 0)) {
            next = i;
        }
    }
    return next;
}

bool opening_moves(const opening *o, const records *r) {
    bool some = false;
    for (int i = 1; i < r->columns; i++) {
        some = some || moves(o, r, i, false);
    }
    return some;
}

/* "x_cm stays at 0.6 m within 1.1e-09 m, y_cm at 0 m within 0.0e+00 m." Returns false if no output stays. */
static bool print_staying(FILE *out, const opening *o, const records *r) {
    double most = 0.0;
    bool *marked = alloc(r->columns, sizeof *marked);
    int named = 0;
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        if (c->primes == 0 && strcmp(c->unit->si, "m") == 0) {
            most = number_most(most, (o->high[i] - o->low[i]) * c->unit->scale / c->unit->divisor);
        }
    }
    for (int i = 1; i < r->columns; i++) {
        marked[i] = stays(o, r, i, most);
    }
    for (int i; (i = next_by_name(r, marked)) >= 0 && named < NAMED; named++) {
        marked[i] = false;
        const record_column *c = &r->column[i];
        fprintf(out, "%s%s%s at %.3g %s within %.1e %s", named > 0 ? ", " : "", c->name,
                named > 0 ? "" : " stays", number_shown(o->first[i]), c->unit->shown,
                1.05 * strayed(o, i), c->unit->shown);
    }
    free(marked);
    fputs(named > 0 ? ".\n" : "", out);
    return named > 0;
}

/* Prints a motion's start and end or, if these are close together, its extremes. */
static void print_way(FILE *out, const opening *o, const records *r, int i, bool is_first) {
    const record_column *c = &r->column[i];
    const bool swings = fabs(r->row[i] - o->first[i]) < (o->high[i] - o->low[i]) / 2.0;
    fprintf(out, "%s%s%s %s %.3g %s %s %.3g %s", is_first ? "" : ", ", c->name,
            is_first ? " moves" : "", swings ? "between" : "from",
            number_shown(swings ? o->low[i] : o->first[i]), c->unit->shown, swings ? "and" : "to",
            number_shown(swings ? o->high[i] : r->row[i]), c->unit->shown);
}

/* Prints "x_cm moves from 0 m to 0.17 m, theta between -80 deg and 80 deg, and 1 more moves.", for example. */
static void print_ways(FILE *out, const opening *o, const records *r) {
    bool *marked = alloc(r->columns, sizeof *marked);
    int moving = 0;
    for (int group = 0; group < 2; group++) {
        for (int i = 1; i < r->columns; i++) {
            marked[i] = moves(o, r, i, group == 0);
        }
        for (int i; (i = next_by_name(r, marked)) >= 0; marked[i] = false) {
            if (moving++ < NAMED) {
                print_way(out, o, r, i, moving == 1);
            }
        }
    }
    free(marked);
    if (moving > NAMED) {
        fprintf(out, ", and %d more move%s", moving - NAMED, moving == NAMED + 1 ? "s" : "");
    }
    fputs(moving > 0 ? ".\n" : "Nothing moves.\n", out);
}

/* Prints a sentence such as "The momentum of x stays 0 kg*m/s within 5.9e-11. " */
static void print_momentum(FILE *out, const image *im, const books *b) {
    int found = -1;
    for (int i = 0; i < im->count && b != NULL; i++) {
        if (im->unknown[i].conserved && im->unknown[i].is_length && isfinite(b->drift[i]) &&
            (found < 0 || strcmp(im->unknown[i].name, im->unknown[found].name) < 0)) {
            found = i;
        }
    }
    if (found < 0) {
        return;
    }
    const char *si = im->unknown[found].momentum_si;
    fprintf(out, "The momentum of %s ", im->unknown[found].name);
    if (b->drift[found] <= HORIZON_TOLERANCE * b->terms[found]) {
        fprintf(out, "stays %.3g %s within %.1e. ", number_shown(b->momentum[found]), si,
                b->drift[found]);
    } else {
        fprintf(out, "drifts by %.2g %s, but should be constant. ", b->drift[found], si);
    }
}

void opening_print(FILE *out, const opening *o, const records *r, const books *b) {
    if (!print_staying(out, o, r)) {
        print_momentum(out, r->image, b);
        print_ways(out, o, r);
    }
}

/* === the summary ============================================================================== */

static void print_state(FILE *out, const image *im, const engine_kind *kind, void *run) {
    records *r = records_open(NULL, im, kind);
    records_read(r, run, 0.0);
    char name[RECORDS_SHOWN_NAME];
    fprintf(out, "\nfinal state\n");
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        if (i == r->columns - im->own_outputs) {
            fprintf(out, "outputs\n");
        }
        fprintf(out, "  %-16s %*.*g %s\n", records_shown_name(c, name), kind->digits + 8,
                kind->digits, r->row[i], c->unit->shown);
    }
    records_close(r);
}

/* For a run without events, lists the stops that stayed open and the inactive holds. */
static void print_idle(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    int mode[WH_CONTACTS_LIMIT];
    kind->modes(run, mode);
    for (int k = 0; k < im->contacts; k++) {
        if (im->contact[k].kind != WH_FRICTION && mode[k] == WH_FREE) {
            char text[STATEMENT_SIZE];
            statement_text(im->contact[k].at, text, sizeof text);
            fprintf(out, "  never acted: %s\n", text);
        }
    }
}

static void print_events(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    uint64_t overruns;
    const uint64_t events = kind->events(run, &overruns);
    fprintf(out, "events             %" PRIu64 " at %d contact%s\n", events, im->contacts,
            im->contacts == 1 ? "" : "s");
    if (events == 0) {
        print_idle(out, im, kind, run);
    }
    if (overruns > 0) {
        fprintf(
            out,
            "  %" PRIu64
            " steps had more than %d moments with events: Whirl completed them with all loaded contacts at rest or sticking; check with a smaller --step\n",
            overruns, WH_EVENTS_MAX);
    }
}

void summary_head(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    const uint64_t steps = kind->steps(run);
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    for (int i = 0; i < im->effects; i++) {
        if (im->effect[i].with) {
            fprintf(out, "  with %s: %s\n", im->effect[i].name, im->effect[i].text);
        }
    }
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.15g s\n", image_stepper(im),
            image_sums(im), kind->name, im->step_s, steps, ratio_times(steps, im->step));
}

void summary_print(FILE *out, const image *im, const engine_kind *kind, void *run, const books *b,
                   const energy_residual *balance) {
    print_state(out, im, kind, run);
    if (kind->saturated != NULL) {
        const uint64_t held = kind->saturated(run);
        fprintf(out, "%" PRIu64 " value%s saturated\n", held, held == 1 ? "" : "s");
    }
    if (im->contacts > 0) {
        print_events(out, im, kind, run);
    }
    if (b != NULL && im->ledger.asked) {
        books_print_kept(out, im, kind, run, b);
    } else if (b != NULL) {
        books_print(out, b, balance);
    }
    energy_residual_print(out, balance);
    fprintf(out, "state hash         0x%016" PRIx64 "\n", kind->hash(run));
}
