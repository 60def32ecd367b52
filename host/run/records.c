/* records.c: writing a run as comma-separated values or plain columns. */
#include "records.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/lang/shown.h"
#include "host/number/zero.h"

/* Columns of the unknowns and their derivatives, integrated or recovered. */
static int state_columns(const equations *e) {
    int columns = 0;
    for (int i = 0; i < e->count; i++) {
        columns += e->unknowns[i].order;
    }
    return columns;
}

/* All values first, then all rates, and so on; then the outputs. */
static void name_columns(records *r) {
    const equations *e = r->equations;
    const mechanism *m = e->instance->mechanism;
    int column = 1;
    for (int primes = 0; column <= state_columns(e); primes++) {
        for (int i = 0; i < e->count; i++) {
            if (e->unknowns[i].order > primes) {
                const symbol *of = e->unknowns[i].symbol;
                r->column[column++] = (record_column){of, i, primes, shown_unit(of, primes)};
            }
        }
    }
    for (int i = 0; i < m->output_count; i++) {
        const symbol *of = m->outputs[i];
        r->column[column++] = (record_column){of, -1, 0, shown_unit(of, 0)};
    }
}

records *records_open(FILE *out, const program *p, const equations *e, const engine_kind *kind) {
    records *r = room(1, sizeof *r);
    const int columns = 1 + state_columns(e) + e->instance->mechanism->output_count;
    *r = (records){out,
                   NULL,
                   p,
                   e,
                   kind,
                   room(columns, sizeof *r->row),
                   room(p->outputs, sizeof *r->output),
                   room(columns, sizeof *r->column),
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

/* What stands around the columns of a line. */
typedef struct layout {
    const char *header, *between, *end;
    const char *unit; /* before a unit's bracket: a blank would part columns */
} layout;

static const layout csv = {"", ",", "\r\n", " "};
static const layout plain = {"% ", " ", "\n", ""};

static void write_name(const record_column *c, FILE *out, const layout *l) {
    for (int k = 0; k < c->primes; k++) {
        fputs("der(", out);
    }
    fputs(c->symbol->name, out);
    for (int k = 0; k < c->primes; k++) {
        fputc(')', out);
    }
    if (!unit_is_si(c->unit)) {
        char *name = shown_unit_name(c->symbol, c->primes);
        fprintf(out, "%s[%s]", l->unit, name);
        free(name);
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
    const program *p = r->program;
    double angle_rad[PROGRAM_COMPONENTS_MAX];
    double real[2 * PROGRAM_COMPONENTS_MAX];
    r->kind->state(run, angle_rad, real);
    r->row[0] = time_s;
    for (int i = 0; i < p->angles; i++) {
        r->row[column_of(r, p->angle[i].unknown, 0)] = angle_rad[i];
    }
    for (int i = 0; i < p->reals; i++) {
        r->row[column_of(r, p->real[i].unknown, p->real[i].primes)] = real[i];
    }
    const int own = r->equations->instance->mechanism->output_count;
    r->kind->outputs(run, r->output);
    for (int i = 0; i < own; i++) {
        r->row[r->columns - own + i] = r->output[i];
    }
    for (int k = 0; k < p->conserved->count; k++) {
        const int i = p->conserved->unknown[k];
        r->row[column_of(r, i, 0)] = r->output[own + 2 * k];
        r->row[column_of(r, i, 1)] = r->output[own + 2 * k + 1];
    }
    for (int i = 0; i < r->columns; i++) { /* here, and nowhere else, SI becomes what people read */
        r->row[i] = number_shown(i > 0 ? unit_number(r->column[i].unit, r->row[i]) : r->row[i]);
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
