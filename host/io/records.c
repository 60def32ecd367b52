/* records.c: writing a run as comma-separated values or plain columns. */
#include "records.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

/* Columns of the unknowns and their derivatives, integrated or recovered. */
static int state_columns(const image *im) {
    int columns = 0;
    for (int i = 0; i < im->count; i++) {
        columns += im->unknown[i].order;
    }
    return columns;
}

/* All values first, then all rates, and so on; then the outputs. */
static void name_columns(records *r) {
    const image *im = r->image;
    int column = 1;
    for (int primes = 0; column <= state_columns(im); primes++) {
        for (int i = 0; i < im->count; i++) {
            const image_unknown *u = &im->unknown[i];
            if (u->order > primes) {
                r->column[column++] = (record_column){u->name, i, primes, &u->unit[primes]};
            }
        }
    }
    for (int i = 0; i < im->own_outputs; i++) {
        const image_quantity *output = &im->output[i];
        r->column[column++] = (record_column){output->name, -1, 0, &output->unit};
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

/* Column of an unknown's derivative. */
static int column_of(const records *r, int unknown_index, int primes) {
    int column = 1;
    while (r->column[column].unknown != unknown_index || r->column[column].primes != primes) {
        column++;
    }
    return column;
}

/* The text around the columns of a line. */
typedef struct layout {
    const char *header, *between, *end;
    const char *unit; /* before a unit's bracket: a blank would part columns */
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

static void write_name(const record_column *c, FILE *out, const layout *l) {
    char *name = records_name(c);
    fputs(name, out);
    free(name);
    if (!image_shows_si(c->unit)) {
        fprintf(out, "%s[%s]", l->unit, c->unit->shown);
    }
}

static void write_header(const records *r, FILE *out, const layout *l) {
    fputs(l->header, out);
    fputs("time", out);
    for (int i = 1; i < r->columns; i++) {
        fputs(l->between, out);
        write_name(&r->column[i], out, l);
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
        /* time is a whole number of steps: it carries its own digits */
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
