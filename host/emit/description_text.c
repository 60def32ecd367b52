/* description_text.c: an image for readers. */
#include <inttypes.h>

#include "description.h"
#include "host/base/diag.h"
#include "host/image/core_rows.h"
#include "host/image/image.h"

static void put_name(FILE *out, const char *kind, int index, const char *name, int primes,
                     const char *si) {
    char shown[256];
    const int length =
        snprintf(shown, sizeof shown, "%.120s%.*s [%.100s]", name, primes, "''''''''''''''''", si);
    fprintf(out, "  %s[%d]%*s %s%*s", kind, index, index < 10 ? 1 : 0, "", shown,
            length < 24 ? 24 - length : 0, "");
}

static void put_state(FILE *out, const image *im) {
    fprintf(out, "\nstate, SI, as it starts (turn angles first)\n");
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        const image_unknown *u = &im->unknown[c.unknown];
        const bool turns = i < im->angles;
        put_name(out, turns ? "angle " : "real  ", turns ? i : i - im->angles, u->name, c.primes,
                 u->unit[c.primes].si);
        fprintf(out, " %-12.9g %s\n", image_start(im, i), c.primes == 0 ? u->text : "");
    }
}

static void put_quantities(FILE *out, const char *title, const char *kind, const image_quantity *q,
                           int count, bool has_value) {
    if (count > 0) {
        fprintf(out, "\n%s\n", title);
    }
    for (int i = 0; i < count; i++) {
        put_name(out, kind, i, q[i].name, 0, q[i].unit.si);
        if (has_value) {
            fprintf(out, " %-12.9g", q[i].value);
        }
        fprintf(out, " %s\n", q[i].text);
    }
}

static void put_recovered(FILE *out, const image *im) {
    for (int i = im->own_outputs; i < im->outputs; i++) {
        const int k = i - im->own_outputs;
        const image_unknown *u = &im->unknown[im->from_momentum[k / 2]];
        put_name(out, "output", i, u->name, k % 2, u->unit[k % 2].si);
        fprintf(out, " from its momentum\n");
    }
}

static void put_contacts(FILE *out, const image *im) {
    char text[STATEMENT_SIZE];
    if (im->contacts > 0) {
        fprintf(out, "\ncontacts, in the order in which those of one moment are taken\n");
    }
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        statement_text(c->at, text, sizeof text);
        fprintf(out, "  %2d %-9s line %-5d %s\n", k, c->word, c->at.line, text);
    }
}

static void put_ledger(FILE *out, const image *im) {
    char text[STATEMENT_SIZE];
    const image_ledger *l = &im->ledger;
    if (!l->asked) {
        return;
    }
    fprintf(out, "\nledger: %d accounts, %d entries\n", l->accounts, l->entries);
    for (int i = 0; i < l->smooth; i++) {
        const image_entry *e = &l->entry[i];
        statement_text(e->at, text, sizeof text);
        fprintf(out, "  %2d %-9s of %-12s %s\n", i, describe_ledger_kind(e->kind),
                e->account == 0 ? "the energy" : im->unknown[l->unknown[e->account]].name, text);
    }
}

/* Declared ranges only; fixed point measures the others in a run. */
static void put_ranges(FILE *out, const image *im) {
    bool any = false;
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const image_range *r = &im->range[i];
        if (r->declared) {
            fprintf(out, "%s  %-26s %.9g .. %.9g\n", any ? "" : "\nranges, SI, for fixed point\n",
                    r->name, r->low, r->high);
            any = true;
        }
    }
}

static void put_lists(FILE *out, const image *im) {
    fprintf(out, "\nlist       results   + - *     /  roots  waves  calls\n");
    for (int role = 0; role < IMAGE_ROLES; role++) {
        if (im->list[role] != NULL) {
            const op_list_cost cost = op_list_count(im->list[role]);
            fprintf(out, "  %-9s %6d  %6d %5d %6d %6d %6d\n", describe_roles[role],
                    im->list[role]->results, cost.arithmetic, cost.divisions, cost.roots,
                    cost.waves, cost.calls);
        }
    }
}

static void put_tables(FILE *out, const image *im) {
    const op_list_tables *of = &im->list[IMAGE_STEP]->tables;
    if (of->count == 0) {
        return;
    }
    fprintf(out, "\n%d tables of %d cells, %s%s:", of->count, im->settings.cells,
            image_tables_words[im->settings.tables], of->folds ? ", even or odd" : "");
    for (int k = 0; k < of->count; k++) {
        fprintf(out, "\n  %2d up to %.4g in size, off by %.2g at most", k, of->size[k], of->off[k]);
    }
}

void describe_text(FILE *out, const image *im, const char *file) {
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    fprintf(out, "  mechanism %s of %s, model hash 0x%016" PRIx64 "\n", im->mechanism, file,
            im->hash);
    for (int i = 0; i < im->effects; i++) {
        if (im->effect[i].with) {
            fprintf(out, "  with %s: %s\n", im->effect[i].name, im->effect[i].text);
        }
    }
    fprintf(out, "  %s order, %s%s, step %.9g s, %" PRIu64 " steps to t = %.9g s\n",
            im->form == WH_SECOND_ORDER ? "second" : "first", image_stepper(im), image_sums(im),
            im->step_s, im->steps, im->until_s);
    put_state(out, im);
    put_quantities(out, "inputs", "input ", im->input, im->inputs, true);
    put_quantities(out, "outputs", "output", im->output, im->own_outputs, false);
    put_recovered(out, im);
    put_quantities(out, "parameters", "param ", im->parameter, im->parameters, true);
    put_ranges(out, im);
    put_contacts(out, im);
    put_ledger(out, im);
    put_lists(out, im);
    if (im->settings.matrix != MATRIX_NONE) {
        fprintf(out, "\na step is one product with a matrix");
    } else {
        fprintf(out, "\na step evaluates the %s at most %d times",
                im->form == WH_SECOND_ORDER ? "accelerations" : "slopes", core_evaluations(im));
    }
    if (im->contacts > 0) {
        fprintf(out, ", the contacts' signals %d times", core_signals(im));
    }
    put_tables(out, im);
    if (im->angles > 0 && im->settings.matrix == MATRIX_NONE &&
        im->settings.tables == TABLES_NONE) {
        fprintf(out, "\nsines of turn angles: looked up %s",
                image_turns(im) ? "once a step, and turned" : "at each stage");
    }
    fprintf(out, "\nmemory: %zu bytes in float, %zu in double\n", memory_float_bytes(im),
            memory_double_bytes(im));
}
