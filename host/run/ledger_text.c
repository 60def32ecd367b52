/* ledger_text.c: the books of a run in words: a line for each entry, named by the line of the mechanism's
 * file that it comes from; the numerical drift on a line of its own. */
#include "ledger_text.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/derive/contact_lists.h"
#include "host/derive/ledger.h"
#include "host/lang/shown.h"
#include "statement.h"
#include "summary.h"

/* The columns that a line of the source gets. */
#define LINE_WIDTH 44

typedef struct ledger_view {
    FILE *out;
    const equations *equations;
    const program *program;
    const double *total; /* [entries] */
    const double *error; /* [accounts] */
} ledger_view;

static void print_line(const ledger_view *v, const char *name, double value) {
    fprintf(v->out, "  %-*s %+.9g\n", LINE_WIDTH, name, value);
}

/* The lines of an account that are not zero throughout. */
static void print_entries(const ledger_view *v, int account) {
    const ledger_lists *l = v->program->ledger;
    const contact_lists *c = v->program->contacts;
    char text[LINE_WIDTH + 1];
    for (int i = 0; i < l->smooth; i++) {
        if (l->entry[i].account == account) {
            if (l->entry[i].term != NULL) {
                statement_text(l->entry[i].term->at, text, sizeof text);
            } else {
                snprintf(text, sizeof text, "of the energies: dL/d%.20s",
                         v->equations->unknowns[l->unknown[account]].symbol->name);
            }
            print_line(v, text, v->total[i]);
        }
    }
    for (int i = 0; i < l->inputs && account == 0; i++) {
        const mechanism *m = v->equations->instance->mechanism;
        statement_text(m->inputs[v->program->input[l->input[i]]]->at, text, sizeof text);
        print_line(v, text, v->total[l->entries - l->inputs + i]);
    }
    for (int k = 0; c != NULL && k < c->count && account <= v->program->coordinates; k++) {
        const double value = v->total[l->smooth + k * (1 + v->program->coordinates) + account];
        if (value != 0.0) {
            statement_text(c->row[k].from->at, text, sizeof text);
            print_line(v, text, value);
        }
    }
}

static void print_momentum(const ledger_view *v, int account, const books *b, double time_s) {
    const int i = v->program->ledger->unknown[account];
    const symbol *q = v->equations->unknowns[i].symbol;
    const double change = b->momentum_now[i] - b->momentum[i];
    char si[64];
    dimension dim = q->dim; /* of the momentum: energy over rate */
    for (int k = 0; k < DIM_BASES; k++) {
        dim.twelfths[k] = (short)-dim.twelfths[k];
    }
    dim.any = false;
    dim.twelfths[DIM_LENGTH] = (short)(dim.twelfths[DIM_LENGTH] + 2 * DIM_DENOMINATOR);
    dim.twelfths[DIM_MASS] = (short)(dim.twelfths[DIM_MASS] + DIM_DENOMINATOR);
    dim.twelfths[DIM_TIME] = (short)(-DIM_DENOMINATOR);
    fprintf(v->out, "momentum book of %s [%s]\n", q->name,
            dimension_unit(dim, false, si, sizeof si));
    print_entries(v, account);
    print_line(v, "change", change);
    fprintf(v->out, "  %-*s %+.2e (numerical)\n", LINE_WIDTH, "left over", v->error[account]);
    if (q->dim.twelfths[DIM_LENGTH] == DIM_DENOMINATOR && time_s > 0.0) {
        fprintf(v->out, "  mean force along %s: %.9g N, known to %.1e N\n", q->name,
                change / time_s, fabs(v->error[account]) / time_s);
    }
}

void ledger_print(FILE *out, const equations *e, const program *p, const engine_kind *kind,
                  const void *run, const books *b) {
    const ledger_lists *l = p->ledger;
    double *total = room(l->entries + l->accounts, sizeof *total);
    double *error = total + l->entries;
    kind->ledger(run, total, error);
    const ledger_view v = {out, e, p, total, error};
    fprintf(out, "energy book [J]\n");
    fprintf(out, "  %-*s %.9g -> %.9g\n", LINE_WIDTH, "kinetic", b->kinetic_J[0], b->kinetic_J[1]);
    fprintf(out, "  %-*s %.9g -> %.9g\n", LINE_WIDTH, "stored", b->stored_J[0], b->stored_J[1]);
    if (p->integral != NULL) {
        fprintf(out, "  %-*s %.9g -> %.9g\n", LINE_WIDTH,
                "booked: h = sum q' dL/dq' - L, not T + V", b->energy_J[0], b->energy_J[1]);
    }
    print_entries(&v, 0);
    print_line(&v, "change", b->energy_J[1] - b->energy_J[0]);
    fprintf(out, "  %-*s %+.2e (numerical)\n", LINE_WIDTH, "left over", error[0]);
    for (int account = 1; account < l->accounts; account++) {
        print_momentum(&v, account, b, (double)kind->steps(run) * e->instance->step_s);
    }
    free(total);
}
