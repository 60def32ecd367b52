/* ledger_text.c: the books of a run in words: a line for each entry, named by the line of the mechanism's
 * file that it comes from; the numerical drift on a line of its own. */
#include "ledger_text.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/base/statement.h"

/* The columns that a line of the source gets. */
#define LINE_WIDTH 44

typedef struct ledger_view {
    FILE *out;
    const image *image;
    const double *total; /* [entries] */
    const double *error; /* [accounts] */
} ledger_view;

static void print_line(const ledger_view *v, const char *name, double value) {
    fprintf(v->out, "  %-*s %+.9g\n", LINE_WIDTH, name, value);
}

/* The lines of an account that are not zero throughout. */
static void print_entries(const ledger_view *v, int account) {
    const image *im = v->image;
    const image_ledger *l = &im->ledger;
    char text[LINE_WIDTH + 1];
    for (int i = 0; i < l->smooth; i++) {
        if (l->entry[i].account == account) {
            if (l->entry[i].kind != LEDGER_ENERGIES) {
                statement_text(l->entry[i].at, text, sizeof text);
            } else {
                snprintf(text, sizeof text, "of the energies: dL/d%.20s",
                         im->unknown[l->unknown[account]].name);
            }
            print_line(v, text, v->total[i]);
        }
    }
    for (int i = 0; i < l->inputs && account == 0; i++) {
        statement_text(im->input[l->input[i]].at, text, sizeof text);
        print_line(v, text, v->total[l->entries - l->inputs + i]);
    }
    for (int k = 0; k < im->contacts && account <= im->coordinates; k++) {
        const double value = v->total[l->smooth + k * (1 + im->coordinates) + account];
        if (value != 0.0) {
            statement_text(im->contact[k].at, text, sizeof text);
            print_line(v, text, value);
        }
    }
}

static void print_momentum(const ledger_view *v, int account, const books *b, double time_s) {
    const int i = v->image->ledger.unknown[account];
    const image_unknown *u = &v->image->unknown[i];
    const double change = b->momentum_now[i] - b->momentum[i];
    fprintf(v->out, "momentum book of %s [%s]\n", u->name, u->momentum_si);
    print_entries(v, account);
    print_line(v, "change", change);
    fprintf(v->out, "  %-*s %+.2e (numerical)\n", LINE_WIDTH, "left over", v->error[account]);
    if (u->is_length && time_s > 0.0) {
        fprintf(v->out, "  mean force along %s: %.9g N, known to %.1e N\n", u->name,
                change / time_s, fabs(v->error[account]) / time_s);
    }
}

void ledger_print(FILE *out, const image *im, const engine_kind *kind, const void *run,
                  const books *b) {
    const image_ledger *l = &im->ledger;
    double *total = room(l->entries + l->accounts, sizeof *total);
    double *error = total + l->entries;
    kind->ledger(run, total, error);
    const ledger_view v = {out, im, total, error};
    fprintf(out, "energy book [J]\n");
    fprintf(out, "  %-*s %.9g -> %.9g\n", LINE_WIDTH, "kinetic", b->kinetic_J[0], b->kinetic_J[1]);
    fprintf(out, "  %-*s %.9g -> %.9g\n", LINE_WIDTH, "stored", b->stored_J[0], b->stored_J[1]);
    if (im->has_integral) {
        fprintf(out, "  %-*s %.9g -> %.9g\n", LINE_WIDTH,
                "booked: h = sum q' dL/dq' - L, not T + V", b->energy_J[0], b->energy_J[1]);
    }
    print_entries(&v, 0);
    print_line(&v, "change", b->energy_J[1] - b->energy_J[0]);
    fprintf(out, "  %-*s %+.2e (numerical)\n", LINE_WIDTH, "left over", error[0]);
    for (int account = 1; account < l->accounts; account++) {
        print_momentum(&v, account, b, (double)kind->steps(run) * im->step_s);
    }
    free(total);
}
