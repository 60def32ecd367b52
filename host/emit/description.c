/* description.c: the contents of an image, as JSON or as text. */
#include "host/emit/emit.h"

#include <inttypes.h>
#include <string.h>

#include "host/base/diag.h"
#include "host/base/json.h"
#include "host/image/core_rows.h"

static const char *const describe_roles[IMAGE_ROLES] = {
    [IMAGE_STEP] = "step",       [IMAGE_OBSERVE] = "observe", [IMAGE_BOOKS] = "books",
    [IMAGE_SIGNALS] = "signals", [IMAGE_FORCES] = "forces",   [IMAGE_SETS] = "sets",
    [IMAGE_POWERS] = "powers",   [IMAGE_LEVELS] = "levels",   [IMAGE_MATRIX] = "matrix",
    [IMAGE_TABLES] = "tables"};

static const char *describe_ledger_kind(ledger_kind kind) {
    switch (kind) {
    case LEDGER_WORK: return "work";
    case LEDGER_LOSS: return "loss";
    case LEDGER_ENERGIES: return "energies";
    case LEDGER_DRIVE: return "drive";
    case LEDGER_DAMPING: return "damping";
    }
    return "";
}

static void put_place(json *j, place at) {
    char text[STATEMENT_SIZE];
    statement_text(at, text, sizeof text);
    json_whole(j, "line", at.line);
    json_whole(j, "column", at.column);
    json_text(j, "statement", text);
}

static void put_unit(json *j, const image_unit *unit) {
    json_text(j, "si", unit->si);
    json_text(j, "unit", unit->shown);
    json_number(j, "unit_si", image_shows_si(unit) ? 1.0 : unit->scale / unit->divisor);
}

static void put_range(json *j, const image_range *range) {
    if (!range->declared) {
        json_null(j, "range");
        return;
    }
    json_open(j, "range", '[');
    json_number(j, NULL, range->low);
    json_number(j, NULL, range->high);
    json_close(j, ']');
}

static void put_quantity(json *j, const image_quantity *q, int index, bool has_value) {
    json_whole(j, "index", index);
    json_text(j, "name", q->name);
    json_text(j, "text", q->text);
    put_unit(j, &q->unit);
    if (has_value) {
        json_number(j, "value", q->value);
    }
    put_place(j, q->at);
}

/* `range`: ranges of the quantities, or NULL */
static void put_quantities(json *j, const char *key, const image_quantity *q, int count,
                           const image_range *range) {
    json_open(j, key, '[');
    for (int i = 0; i < count; i++) {
        json_open(j, NULL, '{');
        put_quantity(j, &q[i], i, true);
        if (range != NULL) {
            put_range(j, &range[i]);
        }
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_component(json *j, const image *im, component c, int index) {
    const image_unknown *u = &im->unknown[c.unknown];
    json_whole(j, "index", index);
    json_text(j, "name", u->name);
    json_whole(j, "primes", c.primes);
    json_text(j, "text", u->text);
    put_unit(j, &u->unit[c.primes]);
}

static void put_state(json *j, const image *im) {
    json_open(j, "angles", '[');
    for (int i = 0; i < im->angles; i++) {
        json_open(j, NULL, '{');
        put_component(j, im, im->angle[i], i);
        json_number(j, "start", im->start_rad[i]);
        json_whole(j, "start_float", im->start_turns[i]);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_open(j, "reals", '[');
    for (int i = 0; i < im->reals; i++) {
        json_open(j, NULL, '{');
        put_component(j, im, im->real[i], i);
        json_number(j, "start", im->start_real[i]);
        json_number(j, "start_float", (double)(float)im->start_real[i]);
        put_range(j, &im->range[i]);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_outputs(json *j, const image *im) {
    json_open(j, "outputs", '[');
    for (int i = 0; i < im->outputs; i++) {
        const int k =
            i -
            im->own_outputs; /* if >= 0: index among values and rates of recovered coordinates */
        json_open(j, NULL, '{');
        if (k < 0) {
            put_quantity(j, &im->output[i], i, false);
        } else {
            put_component(j, im, (component){im->from_momentum[k / 2], k % 2}, i);
            json_bool(j, "from_momentum", true);
        }
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_contacts(json *j, const image *im) {
    json_open(j, "contacts", '[');
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        json_open(j, NULL, '{');
        json_whole(j, "index", k);
        json_text(j, "kind", c->word);
        json_whole(j, "direction", c->direction);
        json_whole(j, "pin", c->pin);
        json_whole(j, "sets", c->sets);
        put_place(j, c->at);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_ledger(json *j, const image *im) {
    const image_ledger *l = &im->ledger;
    if (!l->kept) {
        json_null(j, "ledger");
        return;
    }
    json_open(j, "ledger", '{');
    json_bool(j, "asked", l->asked);
    json_whole(j, "entries", l->entries);
    json_open(j, "accounts", '[');
    for (int i = 0; i < l->accounts; i++) {
        const image_unknown *u = i > 0 ? &im->unknown[l->unknown[i]] : NULL;
        json_open(j, NULL, '{');
        json_whole(j, "index", i);
        json_text(j, "of", u != NULL ? u->name : "energy");
        json_text(j, "si", u != NULL ? u->momentum_si : "J");
        json_close(j, '}');
    }
    json_close(j, ']');
    json_open(j, "rows", '[');
    for (int i = 0; i < l->smooth; i++) {
        json_open(j, NULL, '{');
        json_whole(j, "index", i);
        json_whole(j, "account", l->entry[i].account);
        json_text(j, "kind", describe_ledger_kind(l->entry[i].kind));
        put_place(j, l->entry[i].at);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_close(j, '}');
}

static void put_lists(json *j, const image *im) {
    json_open(j, "lists", '{');
    for (int role = 0; role < IMAGE_ROLES; role++) {
        const op_list *t = im->list[role];
        if (t == NULL) {
            continue;
        }
        const op_list_cost cost = op_list_count(t);
        json_open(j, describe_roles[role], '{');
        json_whole(j, "results", t->results);
        json_whole(j, "operations", op_list_operations(t));
        json_whole(j, "additions_and_products", cost.arithmetic);
        json_whole(j, "divisions", cost.divisions);
        json_whole(j, "roots", cost.roots);
        json_whole(j, "waves", cost.waves);
        json_whole(j, "calls", cost.calls);
        json_whole(j, "look_ups", cost.look_ups);
        json_close(j, '}');
    }
    json_close(j, '}');
}

/* Writes null if the step looks up no tables. */
static void put_tables(json *j, const image *im) {
    const op_list_tables *of = &im->list[IMAGE_STEP]->tables;
    if (of->count == 0) {
        json_null(j, "tables");
        return;
    }
    json_open(j, "tables", '{');
    json_text(j, "form", image_tables_words[im->settings.tables]);
    json_whole(j, "cells", im->settings.cells);
    json_bool(j, "folds", of->folds);
    json_open(j, "of", '[');
    for (int k = 0; k < of->count; k++) {
        json_open(j, NULL, '{');
        json_whole(j, "index", k);
        json_number(j, "size", of->size[k]);
        json_number(j, "off", of->off[k]);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_close(j, '}');
}

static void put_time(json *j, const image *im) {
    json_number(j, "step_s", im->step_s);
    json_open(j, "step_ratio", '{');
    json_count(j, "numerator", im->step.numerator);
    json_count(j, "denominator", im->step.denominator);
    json_close(j, '}');
    json_count(j, "steps", im->steps);
    json_number(j, "until_s", im->until_s);
}

static void put_effects(json *j, const image *im) {
    json_open(j, "effects", '[');
    for (int i = 0; i < im->effects; i++) {
        json_open(j, NULL, '{');
        json_text(j, "name", im->effect[i].name);
        json_text(j, "text", im->effect[i].text);
        json_bool(j, "with", im->effect[i].with);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_sizes(json *j, const image *im) {
    json_open(j, "memory", '{');
    json_count(j, "float_bytes", memory_float_bytes(im));
    json_count(j, "double_bytes", memory_double_bytes(im));
    json_close(j, '}');
    json_open(j, "bounds", '{');
    json_whole(j, "evaluations", core_evaluations(im));
    json_whole(j, "signals", core_signals(im));
    json_whole(j, "events", im->contacts > 0 ? WH_EVENTS_MAX : 0);
    json_close(j, '}');
}

static void put_matrix_rows(json *j, const image *im, const char *key, int first, int end) {
    json_open(j, key, '[');
    for (int i = 0; i < im->matrix.states; i++) {
        json_open(j, NULL, '[');
        for (int k = first; k < end; k++) {
            json_number(j, NULL, im->matrix.entry[i * im->matrix.columns + k]);
        }
        json_close(j, ']');
    }
    json_close(j, ']');
}

/* Writes the setting "matrix" and, if there is a matrix, its parts: a row for each component, angles first. */
static void put_matrix(json *j, const image *im) {
    const int states = im->matrix.states;
    json_text(j, "matrix", image_matrix_words[im->settings.matrix]);
    if (im->settings.matrix != MATRIX_NONE) {
        put_matrix_rows(j, im, "phi", 0, states);
        put_matrix_rows(j, im, "gamma", states, states + im->inputs);
        json_open(j, "g", '[');
        for (int i = 0; i < states; i++) {
            json_number(j, NULL, im->matrix.entry[(i + 1) * im->matrix.columns - 1]);
        }
        json_close(j, ']');
    }
}

void describe_json(FILE *out, const image *im, const char *file) {
    json j = {.out = out};
    char hash[24];
    snprintf(hash, sizeof hash, "0x%016" PRIx64, im->hash);
    json_open(&j, NULL, '{');
    json_whole(&j, "version", DESCRIBE_VERSION);
    json_text(&j, "whirl", WH_VERSION);
    json_text(&j, "name", im->name);
    json_text(&j, "title", im->title);
    json_text(&j, "mechanism", im->mechanism);
    json_text(&j, "file", file);
    json_text(&j, "hash", hash);
    json_text(&j, "form", im->form == WH_SECOND_ORDER ? "second order" : "first order");
    json_bool(&j, "energies", im->has_energies);
    json_text(&j, "method", wh_methods[im->settings.method].word);
    json_whole(&j, "stages", core_stages(im));
    json_bool(&j, "compensated", im->settings.compensated);
    json_bool(&j, "stabilized", im->settings.stabilized);
    json_text(&j, "sines",
              im->settings.tables != TABLES_NONE
                  ? "tables"
                  : image_angles_words[image_turns(im) ? ANGLES_TURNED : ANGLES_LOOKUP]);
    put_matrix(&j, im);
    put_tables(&j, im);
    put_time(&j, im);
    put_effects(&j, im);
    put_quantities(&j, "parameters", im->parameter, im->parameters, NULL);
    put_state(&j, im);
    put_quantities(&j, "inputs", im->input, im->inputs, &im->range[im->reals]);
    put_outputs(&j, im);
    put_contacts(&j, im);
    put_ledger(&j, im);
    put_sizes(&j, im);
    put_lists(&j, im);
    json_close(&j, '}');
}

/* === for readers ============================================================================== */

static void put_name(FILE *out, const char *kind, int index, const char *name, int primes,
                     const char *si) {
    char shown[256];
    const int length =
        snprintf(shown, sizeof shown, "%.120s%.*s [%.100s]", name, primes, "''''''''''''''''", si);
    fprintf(out, "  %s[%d]%*s %s%*s", kind, index, index < 10 ? 1 : 0, "", shown,
            length < 24 ? 24 - length : 0, "");
}

static void tell_state(FILE *out, const image *im) {
    fprintf(out, "\nstart state in SI (turn angles first)\n");
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        const image_unknown *u = &im->unknown[c.unknown];
        const bool turns = i < im->angles;
        put_name(out, turns ? "angle " : "real  ", turns ? i : i - im->angles, u->name, c.primes,
                 u->unit[c.primes].si);
        fprintf(out, " %-12.9g %s\n", image_start(im, i), c.primes == 0 ? u->text : "");
    }
}

static void tell_quantities(FILE *out, const char *title, const char *kind, const image_quantity *q,
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

static void tell_contacts(FILE *out, const image *im) {
    char text[STATEMENT_SIZE];
    if (im->contacts > 0) {
        fprintf(out, "\ncontacts, in the order in which simultaneous ones are handled\n");
    }
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        statement_text(c->at, text, sizeof text);
        fprintf(out, "  %2d %-9s line %-5d %s\n", k, c->word, c->at.line, text);
    }
}

static void tell_ledger(FILE *out, const image *im) {
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

static void tell_lists(FILE *out, const image *im) {
    fprintf(out, "\nlist       results   + - *     /  roots sincos  calls\n");
    for (int role = 0; role < IMAGE_ROLES; role++) {
        if (im->list[role] != NULL) {
            const op_list_cost cost = op_list_count(im->list[role]);
            fprintf(out, "  %-9s %6d  %6d %5d %6d %6d %6d\n", describe_roles[role],
                    im->list[role]->results, cost.arithmetic, cost.divisions, cost.roots,
                    cost.waves, cost.calls);
        }
    }
}

static void tell_tables(FILE *out, const image *im) {
    const op_list_tables *of = &im->list[IMAGE_STEP]->tables;
    if (of->count == 0) {
        return;
    }
    fprintf(out, "\n%d tables of %d cells, %s%s:", of->count, im->settings.cells,
            image_tables_words[im->settings.tables], of->folds ? ", even or odd" : "");
    for (int k = 0; k < of->count; k++) {
        fprintf(out, "\n  %2d up to %.4g in size, error at most %.2g", k, of->size[k], of->off[k]);
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
    tell_state(out, im);
    tell_quantities(out, "inputs", "input ", im->input, im->inputs, true);
    tell_quantities(out, "outputs", "output", im->output, im->own_outputs, false);
    put_recovered(out, im);
    tell_quantities(out, "parameters", "param ", im->parameter, im->parameters, true);
    put_ranges(out, im);
    tell_contacts(out, im);
    tell_ledger(out, im);
    tell_lists(out, im);
    if (im->settings.matrix != MATRIX_NONE) {
        fprintf(out, "\na step is one product with a matrix");
    } else {
        fprintf(out, "\na step evaluates the %s at most %d times",
                im->form == WH_SECOND_ORDER ? "accelerations" : "slopes", core_evaluations(im));
    }
    if (im->contacts > 0) {
        fprintf(out, ", the contacts' signals %d times", core_signals(im));
    }
    tell_tables(out, im);
    if (im->angles > 0 && im->settings.matrix == MATRIX_NONE &&
        im->settings.tables == TABLES_NONE) {
        fprintf(out, "\nsines of turn angles: looked up %s",
                image_turns(im) ? "once per step, then rotated" : "at each stage");
    }
    fprintf(out, "\nmemory: %zu bytes in float, %zu in double\n", memory_float_bytes(im),
            memory_double_bytes(im));
}
