/* summary.c: what a run came to, in words. */
#include "summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "books_text.h"
#include "core/contact.h"
#include "host/base/statement.h"
#include "records.h"

static void print_value(FILE *out, const records *r, int column) {
    const record_column *c = &r->column[column];
    const int digits = r->kind->digits;
    char text[160];
    snprintf(text, sizeof text, "%.*s%.*s", 120, c->name, c->primes, "''''''''''''''''");
    fprintf(out, "  %-16s %*.*g %s\n", text, digits + 8, digits, r->row[column], c->unit->shown);
}

static void print_state(FILE *out, const image *im, const engine_kind *kind, void *run) {
    records *r = records_open(NULL, im, kind);
    records_read(r, run, 0.0);
    const int first_output = r->columns - im->own_outputs;
    fprintf(out, "\nfinal state\n");
    for (int column = 1; column < r->columns; column++) {
        if (column == first_output) {
            fprintf(out, "outputs\n");
        }
        print_value(out, r, column);
    }
    records_close(r);
}

/* Stops that stayed open and holds that never held, of a run without events: such a run shows nothing of them. */
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
        fprintf(out,
                "  %" PRIu64 " steps had more than %d moments with events: what was left of them "
                "counts as rest or sticking; a smaller --step tells more\n",
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
                   const belief *balance) {
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
    belief_print(out, balance);
    fprintf(out, "state hash         0x%016" PRIx64 "\n", kind->hash(run));
}
