/* summary.c: what a run came to, in words. */
#include "summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/contact_lists.h"
#include "ledger_text.h"
#include "records.h"

const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size) {
    static const struct {
        signed char m, kg, s, A;
        const char *name;
    } named[] = {{1, 0, 0, 0, "m"},     {1, 0, -1, 0, "m/s"}, {1, 0, -2, 0, "m/s^2"},
                 {0, 1, 0, 0, "kg"},    {0, 0, 1, 0, "s"},    {0, 0, -1, 0, "1/s"},
                 {1, 1, -2, 0, "N"},    {2, 1, -2, 0, "N*m"}, {2, 1, -3, 0, "W"},
                 {0, 0, 0, 1, "A"},     {2, 1, -3, -1, "V"},  {1, 1, -1, 0, "kg*m/s"},
                 {2, 1, -1, 0, "N*m*s"}};
    static const char *const bases[DIM_BASES] = {"m", "kg", "s", "A", "K"};
    bool none = true;
    for (int i = 0; i < DIM_BASES; i++) {
        none = none && dim.twelfths[i] == 0;
    }
    if (none || dim.any) {
        snprintf(text, size, "%s", is_angle ? "rad" : "1");
        return text;
    }
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        if (dim.twelfths[DIM_LENGTH] == 12 * named[i].m &&
            dim.twelfths[DIM_MASS] == 12 * named[i].kg &&
            dim.twelfths[DIM_TIME] == 12 * named[i].s &&
            dim.twelfths[DIM_CURRENT] == 12 * named[i].A && dim.twelfths[DIM_TEMPERATURE] == 0) {
            snprintf(text, size, "%s", named[i].name);
            return text;
        }
    }
    size_t at = 0;
    text[0] = '\0';
    for (int i = 0; i < DIM_BASES && at < size; i++) {
        if (dim.twelfths[i] != 0) {
            char power[16] = "";
            if (dim.twelfths[i] != DIM_DENOMINATOR) {
                snprintf(power, sizeof power, "^%g", dim.twelfths[i] / (double)DIM_DENOMINATOR);
            }
            at += (size_t)snprintf(text + at, size - at, "%s%s%s", at > 0 ? "*" : "", bases[i],
                                   power);
        }
    }
    return text;
}

static void print_value(FILE *out, const char *name, double value, int digits, dimension dim,
                        bool is_angle, int primes) {
    char si[64];
    char text[160];
    dim.twelfths[DIM_TIME] = (short)(dim.twelfths[DIM_TIME] - DIM_DENOMINATOR * primes);
    bool plain = is_angle && primes > 0;
    for (int i = 0; i < DIM_BASES && i != DIM_TIME; i++) {
        plain = plain && dim.twelfths[i] == 0;
    }
    if (plain && primes == 1) {
        snprintf(si, sizeof si, "rad/s");
    } else {
        dimension_unit(dim, is_angle && primes == 0, si, sizeof si);
    }
    snprintf(text, sizeof text, "%.*s%.*s", 120, name, primes, "''''''''''''''''");
    fprintf(out, "  %-16s %*.*g %s\n", text, digits + 8, digits, value, si);
}

static void print_state(FILE *out, const equations *e, const program *p,
                        const simulation_settings *s, void *run) {
    records *r = records_open(NULL, p, e, s->kind);
    records_read(r, run, 0.0);
    int column = 1;
    fprintf(out, "\nfinal state\n");
    const int own = e->instance->mechanism->output_count;
    for (int level = 0; column < r->columns - own; level++) {
        for (int i = 0; i < e->count; i++) {
            if (e->unknowns[i].order > level) {
                const symbol *sym = e->unknowns[i].symbol;
                print_value(out, sym->name, r->row[column++], s->kind->digits, sym->dim,
                            sym->is_angle, level);
            }
        }
    }
    if (own > 0) {
        fprintf(out, "outputs\n");
    }
    for (int i = 0; i < own; i++) {
        const symbol *sym = e->instance->mechanism->outputs[i];
        print_value(out, sym->name, r->row[column++], s->kind->digits, sym->dim, false, 0);
    }
    records_close(r);
}

static void print_books(FILE *out, const books *b, const belief *balance) {
    const equations *e = b->equations;
    fprintf(out, "energy [J]\n");
    fprintf(out, "  kinetic          %.9g -> %.9g\n", b->kinetic_J[0], b->kinetic_J[1]);
    fprintf(out, "  stored           %.9g -> %.9g\n", b->stored_J[0], b->stored_J[1]);
    if (b->program->integral != NULL) {
        fprintf(
            out,
            "  energy integral  %.9g -> %.9g (h = sum q' dL/dq' - L: booked instead of T + V)\n",
            b->energy_J[0], b->energy_J[1]);
    }
    fprintf(out, "  work of inputs   %.9g\n", b->input_J);
    fprintf(out, "  losses           %.9g\n", b->loss_J);
    if (b->program->contacts != NULL && balance->known) {
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
    for (int i = 0; i < e->count; i++) {
        if (e->conserved[i]) {
            if (!any) {
                fprintf(out, "conserved momentum [SI]\n");
            }
            any = true;
            fprintf(out, "  of %-13s %.9g, drift at most %.2e (numerical)\n",
                    e->unknowns[i].symbol->name, b->momentum[i], b->drift[i]);
        }
    }
    if (!any) {
        fprintf(out, "no momentum is conserved: every coordinate feels a force\n");
    }
}

static void print_events(FILE *out, const program *p, const engine_kind *kind, const void *run) {
    uint64_t overruns;
    const uint64_t events = kind->events(run, &overruns);
    fprintf(out, "events             %" PRIu64 " of %d contacts\n", events, p->contacts->count);
    if (overruns > 0) {
        fprintf(out,
                "  %" PRIu64 " steps had more than %d moments with events: what was left of them "
                "counts as rest or sticking; a smaller --step tells more\n",
                overruns, WH_EVENTS_MAX);
    }
}

void summary_print(FILE *out, const equations *e, const program *p, const simulation_settings *s,
                   void *run, const books *b, const belief *balance, double step_ns) {
    static const char *const methods[] = {"explicit Euler", "semi-implicit Euler", "Heun",
                                          "Runge-Kutta 4"};
    const instance *inst = e->instance;
    const char *title = inst->scene != NULL ? inst->scene->title : inst->mechanism->title;
    const uint64_t steps = s->kind->steps(run);
    fprintf(out, "%s%s%s\n", inst->name, title[0] != '\0' ? ": " : "", title);
    for (int i = 0; i < inst->mechanism->effect_count; i++) {
        if (inst->with[i]) {
            fprintf(out, "  with %s: %s\n", inst->mechanism->effects[i].name,
                    inst->mechanism->effects[i].text);
        }
    }
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.9g s\n",
            methods[s->engine.method], s->engine.compensated ? " compensated" : "", s->kind->name,
            inst->step_s, steps, (double)steps * inst->step_s);
    print_state(out, e, p, s, run);
    if (p->contacts != NULL) {
        print_events(out, p, s->kind, run);
    }
    if (b != NULL && p->ledger_asked) {
        ledger_print(out, e, p, s->kind, run, b);
    } else if (b != NULL) {
        print_books(out, b, balance);
    }
    belief_print(out, balance);
    fprintf(out, "state hash         0x%016" PRIx64 "\n", s->kind->hash(run));
    fprintf(out, "time per step      %.0f ns (interpreted, this machine)\n", step_ns);
}
