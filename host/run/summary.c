/* summary.c: what a run came to, in words. */
#include "summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ledger_text.h"
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

static void print_books(FILE *out, const books *b, const belief *balance) {
    const image *im = b->image;
    fprintf(out, "energy [J]\n");
    fprintf(out, "  kinetic          %.9g -> %.9g\n", b->kinetic_J[0], b->kinetic_J[1]);
    fprintf(out, "  stored           %.9g -> %.9g\n", b->stored_J[0], b->stored_J[1]);
    if (im->has_integral) {
        fprintf(
            out,
            "  energy integral  %.9g -> %.9g (h = sum q' dL/dq' - L: booked instead of T + V)\n",
            b->energy_J[0], b->energy_J[1]);
    }
    fprintf(out, "  work of inputs   %.9g\n", b->input_J);
    fprintf(out, "  losses           %.9g\n", b->loss_J);
    if (im->contacts > 0 && balance->known) {
        fprintf(out,
                "  impacts, friction, holds and settings took %.9g (--with ledger says which)\n",
                balance->contacts_J + 0.0); /* and not "-0" */
    }
    if (balance->known) {
        fprintf(out, "  does not balance by %.2e (numerical)\n", balance->left_J);
    } else if (!isfinite(books_error_J(b))) {
        fprintf(out, "  no balance: the energies are not finite numbers\n");
    } else { /* the run's own books cannot be kept, and those beside it do not see the forces inside */
        fprintf(
            out,
            "  impacts, friction, holds, settings and numerical errors took %.9g: what of it is "
            "which is not known here\n",
            0.0 - books_error_J(b));
    }
    bool any = false;
    for (int i = 0; i < im->count; i++) {
        if (im->unknown[i].conserved) {
            if (!any) {
                fprintf(out, "conserved momentum [SI]\n");
            }
            any = true;
            fprintf(out, "  of %-13s %.9g, drift at most %.2e (numerical)\n", im->unknown[i].name,
                    b->momentum[i], b->drift[i]);
        }
    }
    if (!any) {
        fprintf(out, "no momentum is conserved: every coordinate feels a force\n");
    }
}

static void print_events(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    uint64_t overruns;
    const uint64_t events = kind->events(run, &overruns);
    fprintf(out, "events             %" PRIu64 " of %d contacts\n", events, im->contacts);
    if (overruns > 0) {
        fprintf(out,
                "  %" PRIu64 " steps had more than %d moments with events: what was left of them "
                "counts as rest or sticking; a smaller --step tells more\n",
                overruns, WH_EVENTS_MAX);
    }
}

void summary_print(FILE *out, const image *im, const engine_kind *kind, void *run, const books *b,
                   const belief *balance, double step_ns) {
    const uint64_t steps = kind->steps(run);
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    for (int i = 0; i < im->effects; i++) {
        if (im->effect[i].with) {
            fprintf(out, "  with %s: %s\n", im->effect[i].name, im->effect[i].text);
        }
    }
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.15g s\n",
            wh_methods[im->settings.method].title, im->settings.compensated ? " compensated" : "",
            kind->name, im->step_s, steps, ratio_times(steps, im->step));
    print_state(out, im, kind, run);
    if (im->contacts > 0) {
        print_events(out, im, kind, run);
    }
    if (b != NULL && im->ledger.asked) {
        ledger_print(out, im, kind, run, b);
    } else if (b != NULL) {
        print_books(out, b, balance);
    }
    belief_print(out, balance);
    fprintf(out, "state hash         0x%016" PRIx64 "\n", kind->hash(run));
    fprintf(out, "time per step      %.0f ns (interpreted, this machine)\n", step_ns);
}
