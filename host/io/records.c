/* records.c: records of a run: comma-separated values, plain columns, and waves. */
#include "host/io/records.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/io/vcd.h"
#include "host/number/functions.h"

static int state_columns(const image *im) {
    int columns = 0;
    for (int i = 0; i < im->count; i++) {
        columns += im->unknown[i].order;
    }
    return columns;
}

/* The order is: the values of all unknowns, their first derivatives, their higher derivatives, the outputs. */
static void name_columns(records *r) {
    const image *im = r->image;
    int column = 1;
    for (int primes = 0; column <= state_columns(im); primes++) {
        for (int i = 0; i < im->count; i++) {
            const image_unknown *u = &im->unknown[i];
            if (u->order > primes) {
                r->column[column++] = (record_column){u->name, i, primes, &u->unit[primes],
                                                      primes == 0 ? u->text : ""};
            }
        }
    }
    for (int i = 0; i < im->own_outputs; i++) {
        const image_quantity *output = &im->output[i];
        r->column[column++] = (record_column){output->name, -1, 0, &output->unit, output->text};
    }
}

records *records_open(FILE *out, const image *im, const engine_kind *kind) {
    records *r = alloc(1, sizeof *r);
    const int columns = 1 + state_columns(im) + im->own_outputs;
    *r = (records){out,
                   NULL,
                   im,
                   kind,
                   alloc(columns, sizeof *r->row),
                   alloc(im->outputs, sizeof *r->output),
                   alloc(columns, sizeof *r->column),
                   columns};
    name_columns(r);
    return r;
}

void records_close(records *r) {
    if (r != NULL) {
        free(r->row);
        free(r->output);
        free(r->column);
        free(r);
    }
}

static int column_of(const records *r, int unknown_index, int primes) {
    int column = 1;
    while (r->column[column].unknown != unknown_index || r->column[column].primes != primes) {
        column++;
    }
    return column;
}

typedef struct layout {
    const char *header, *between, *end;
    const char *unit; /* text before [unit] */
} layout;

static const layout csv = {"", ",", "\r\n", " "};
static const layout plain = {"% ", " ", "\n", ""};

char *records_name(const record_column *c) {
    char *name = alloc_words("%s", c->name);
    for (int k = 0; k < c->primes; k++) {
        char *of = name;
        name = alloc_words("der(%s)", of);
        free(of);
    }
    return name;
}

const char *records_shown_name(const record_column *c, char text[RECORDS_SHOWN_NAME]) {
    snprintf(text, RECORDS_SHOWN_NAME, "%s%.*s", c->name, c->primes, "''''''''''");
    return text;
}

static void write_header(const records *r, FILE *out, const layout *l) {
    fprintf(out, "%stime", l->header);
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        char *name = records_name(c);
        fprintf(out, "%s%s", l->between, name);
        free(name);
        if (!image_shows_si(c->unit)) {
            fprintf(out, "%s[%s]", l->unit, c->unit->shown);
        }
    }
    fputs(l->end, out);
}

void records_header(records *r) {
    if (r->out != NULL) {
        write_header(r, r->out, &csv);
    }
    if (r->plain != NULL) {
        write_header(r, r->plain, &plain);
    }
}

void records_read(records *r, void *run, double time_s) {
    const image *im = r->image;
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    r->kind->state(run, angle_rad, real);
    r->row[0] = time_s;
    for (int i = 0; i < im->angles; i++) {
        r->row[column_of(r, im->angle[i].unknown, 0)] = angle_rad[i];
    }
    for (int i = 0; i < im->reals; i++) {
        r->row[column_of(r, im->real[i].unknown, im->real[i].primes)] = real[i];
    }
    const int own = im->own_outputs;
    r->kind->outputs(run, r->output);
    for (int i = 0; i < own; i++) {
        r->row[r->columns - own + i] = r->output[i];
    }
    for (int k = 0; k < im->recovered; k++) {
        const int i = im->from_momentum[k];
        r->row[column_of(r, i, 0)] = r->output[own + 2 * k];
        r->row[column_of(r, i, 1)] = r->output[own + 2 * k + 1];
    }
    for (int i = 0; i < r->columns; i++) { /* the only conversion from SI to declared units */
        r->row[i] = number_shown(i > 0 ? image_shown(r->column[i].unit, r->row[i]) : r->row[i]);
    }
}

static bool write_row(const records *r, FILE *out, const layout *l) {
    for (int i = 0; i < r->columns; i++) {
        /* the time is a double in every engine, so it has 15 digits */
        if (i == 0) {
            fprintf(out, "%.15g", r->row[i]);
        } else {
            fprintf(out, "%s%.*g", l->between, r->kind->digits, r->row[i]);
        }
    }
    fputs(l->end, out);
    return ferror(out) == 0;
}

bool records_write(const records *r) {
    const bool csv_written = r->out == NULL || write_row(r, r->out, &csv);
    const bool plain_written = r->plain == NULL || write_row(r, r->plain, &plain);
    return csv_written && plain_written;
}

/* === waves of a run =========================================================================== */

/* Largest number of time units in a dump. A double represents each of them. */
#define TICKS_MOST 0x1p52
/* Smallest number of time units in a step, unless TICKS_MOST or VCD_FINEST prevents it. */
#define TICKS_LEAST 1e3

struct traces {
    const records *form;
    vcd *vcd;
    FILE *out;
    double units_per_s;
    int *signal;   /* [columns]; [0], the time, is unused */
    int *mode_of;  /* [contacts] wires */
    int *event_of; /* [contacts] event signals, or -1 */
    int *mode;     /* [contacts] scratch */
};

bool traces_power(const image *im, int *power) {
    double units_per_s = 1.0;
    for (*power = 0; *power < VCD_FINEST && im->step_s * units_per_s < TICKS_LEAST &&
                     10.0 * im->until_s * units_per_s < TICKS_MOST;
         ++*power) {
        units_per_s *= 10.0;
    }
    return im->step_s * units_per_s >= 1.0 && im->until_s * units_per_s < TICKS_MOST;
}

static int64_t time_of(const traces *w, uint64_t steps) {
    return (int64_t)(ratio_times(steps, w->form->image->step) * w->units_per_s + 0.5);
}

/* Adds the signal of a quantity, and returns its number. */
static int name_quantity(traces *w, const char *name, const char *text, const image_unit *unit) {
    char *shown =
        image_shows_si(unit) ? alloc_words("%s", name) : alloc_words("%s [%s]", name, unit->shown);
    char *note = alloc_words("%s [%s]%s%s", name, unit->shown, text[0] != '\0' ? ": " : "", text);
    const int made = vcd_add(w->vcd, VCD_REAL, shown, note);
    free(shown);
    free(note);
    return made;
}

static void name_contacts(traces *w) {
    static const struct {
        const char *does;
        const char *happens;
    } words[] = {[WH_STOP] = {"rests", "hit"},
                 [WH_HOLD] = {"holds", NULL},
                 [WH_FRICTION] = {"sticks", NULL},
                 [WH_WHEN] = {"above", "crossed"}};
    const image *im = w->form->image;
    int of_kind[WH_CONTACT_KIND_COUNT] = {0};
    if (im->contacts > 0) {
        vcd_scope(w->vcd, "contacts");
    }
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        char statement[STATEMENT_SIZE];
        statement_text(c->at, statement, sizeof statement);
        const int number = ++of_kind[c->kind];
        char *name = alloc_words("%s%d_%s", c->word, number, words[c->kind].does);
        w->mode_of[k] = vcd_add(w->vcd, VCD_WIRE, name, statement);
        free(name);
        w->event_of[k] = -1;
        if (words[c->kind].happens != NULL) {
            name = alloc_words("%s%d_%s", c->word, number, words[c->kind].happens);
            w->event_of[k] = vcd_add(w->vcd, VCD_EVENT, name, NULL);
            free(name);
        }
    }
}

/* An input is a column of the records if it has a rate. */
static bool is_column(const image *im, int input) {
    bool is = false;
    for (int i = 0; i < im->drives; i++) {
        const image_drive *d = &im->drive[i];
        is = is || d->input == input || (d->rate == input && d->rate_moves);
    }
    return is;
}

traces *traces_open(FILE *out, const records *form) {
    const image *im = form->image;
    traces *w = alloc(1, sizeof *w);
    int power = 0;
    (void)traces_power(im, &power);
    w->form = form;
    w->out = out;
    w->units_per_s = 1.0;
    for (int k = 0; k < power; k++) {
        w->units_per_s *= 10.0;
    }
    w->signal = alloc(form->columns, sizeof *w->signal);
    w->mode_of = alloc(im->contacts, sizeof *w->mode_of);
    w->event_of = alloc(im->contacts, sizeof *w->event_of);
    w->mode = alloc(im->contacts, sizeof *w->mode);
    char *what = alloc_words("%s%s%s, recorded by whirl run", im->name,
                             im->title[0] != '\0' ? ": " : "", im->title);
    w->vcd = vcd_new(out, what, power, im->name, form->kind->digits);
    free(what);
    for (int i = 1; i < form->columns; i++) {
        const record_column *c = &form->column[i];
        char *name = records_name(c);
        w->signal[i] = name_quantity(w, name, c->text, c->unit);
        free(name);
    }
    if (im->inputs > 0) {
        vcd_scope(w->vcd, "inputs");
    }
    for (int i = 0; i < im->inputs; i++) {
        if (!is_column(im, i)) {
            const image_quantity *q = &im->input[i];
            const int signal = name_quantity(w, q->name, q->text, &q->unit);
            vcd_change(w->vcd, signal, 0, image_shown(&q->unit, q->value));
        }
    }
    name_contacts(w);
    return w;
}

/* The level of a contact's wire in this mode. */
static double shown_mode(int kind, int mode) {
    switch ((wh_contact_kind)kind) {
    case WH_STOP:
    case WH_HOLD: return mode == WH_ACTIVE ? 1.0 : 0.0;
    case WH_FRICTION: return mode == WH_STUCK ? 1.0 : 0.0;
    case WH_WHEN: return mode > 0 ? 1.0 : 0.0;
    case WH_CONTACT_KIND_COUNT: break;
    }
    return (double)NAN;
}

static void tell_events(traces *w, const void *run, uint64_t steps) {
    const records *r = w->form;
    const int64_t begin = time_of(w, steps - 1);
    const int64_t end = time_of(w, steps);
    engine_event list[WH_EVENT_LOG];
    const int count = r->kind->happened(run, list);
    for (int i = 0; i < count; i++) {
        const int k = list[i].contact;
        const int kind = r->image->contact[k].kind;
        const int64_t at = begin + (int64_t)(list[i].at_s * w->units_per_s + 0.5);
        const int64_t time = at < end ? at : end;
        vcd_change(w->vcd, w->mode_of[k], time, shown_mode(kind, list[i].mode));
        if (kind != WH_STOP || list[i].strikes) {
            vcd_change(w->vcd, w->event_of[k], time, 1.0);
        }
    }
}

void traces_step(traces *w, const void *run, uint64_t steps) {
    const image *im = w->form->image;
    const int64_t time = time_of(w, steps);
    if (steps > 0) {
        tell_events(w, run, steps);
    }
    w->form->kind->modes(run, w->mode);
    for (int k = 0; k < im->contacts; k++) {
        vcd_change(w->vcd, w->mode_of[k], time, shown_mode(im->contact[k].kind, w->mode[k]));
    }
    vcd_settle(w->vcd, time);
}

bool traces_record(traces *w, uint64_t steps) {
    const records *r = w->form;
    const int64_t time = time_of(w, steps);
    for (int i = 1; i < r->columns; i++) {
        vcd_change(w->vcd, w->signal[i], time, r->row[i]);
    }
    vcd_settle(w->vcd, time);
    return ferror(w->out) == 0;
}

void traces_close(traces *w) {
    if (w != NULL) {
        vcd_end(w->vcd);
        free(w->signal);
        free(w->mode_of);
        free(w->event_of);
        free(w->mode);
        free(w);
    }
}
