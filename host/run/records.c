/* records.c: writing a run as comma-separated values or plain columns. */
#include "records.h"

#include <stdlib.h>
#include <string.h>

#include "number.h"

/* Columns of the unknowns and their derivatives, integrated or recovered. */
static int state_columns(const equations *e) {
    int columns = 0;
    for (int i = 0; i < e->count; i++) {
        columns += e->unknowns[i].order;
    }
    return columns;
}

records *records_open(FILE *out, const program *p, const equations *e, const engine_kind *kind) {
    records *r = calloc(1, sizeof *r);
    if (r == NULL) {
        abort();
    }
    const int columns = 1 + state_columns(e) + e->instance->mechanism->output_count;
    *r = (records){out,
                   NULL,
                   p,
                   e,
                   kind,
                   calloc((size_t)columns, sizeof *r->row),
                   calloc((size_t)p->outputs + 1, sizeof *r->output),
                   columns};
    if (r->row == NULL || r->output == NULL) {
        abort();
    }
    return r;
}

void records_close(records *r) {
    if (r != NULL) {
        free(r->row);
        free(r->output);
        free(r);
    }
}

/* Column (from 1) of an unknown's derivative: all values first, then all rates, and so on. */
static int column_of(const records *r, int unknown_index, int primes) {
    int column = 1;
    for (int level = 0; level <= primes; level++) {
        for (int i = 0; i < r->equations->count; i++) {
            if (r->equations->unknowns[i].order > level) {
                if (level == primes && i == unknown_index) {
                    return column;
                }
                column++;
            }
        }
    }
    return column;
}

void records_name(const records *r, int column, char *text, size_t size) {
    const int states = state_columns(r->equations);
    if (column == 0) {
        snprintf(text, size, "time");
    } else if (column > states) {
        snprintf(text, size, "%s",
                 r->equations->instance->mechanism->outputs[column - states - 1]->name);
    }
    for (int i = 0; i < r->equations->count; i++) {
        const unknown *u = &r->equations->unknowns[i];
        for (int primes = 0; primes < u->order; primes++) {
            if (column_of(r, i, primes) != column || column > states) {
                continue;
            }
            size_t at = 0;
            text[0] = '\0';
            for (int k = 0; k < primes && at + 4 < size; k++, at += 4) {
                memcpy(text + at, "der(", 5);
            }
            snprintf(text + at, size - at, "%s%.*s", u->symbol->name, primes, "))))))))))))))))");
        }
    }
}

/* What stands around the columns of a line. */
typedef struct layout {
    const char *header, *between, *end;
} layout;

static const layout csv = {"", ",", "\r\n"};
static const layout plain = {"% ", " ", "\n"};

static void write_header(const records *r, FILE *out, const layout *l) {
    char name[256];
    fputs(l->header, out);
    for (int i = 0; i < r->columns; i++) {
        records_name(r, i, name, sizeof name);
        fprintf(out, "%s%s", i > 0 ? l->between : "", name);
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
        r->row[1 + state_columns(r->equations) + i] = r->output[i];
    }
    for (int k = 0; k < p->conserved->count; k++) {
        const int i = p->conserved->unknown[k];
        r->row[column_of(r, i, 0)] = r->output[own + 2 * k];
        r->row[column_of(r, i, 1)] = r->output[own + 2 * k + 1];
    }
    for (int i = 0; i < r->columns; i++) {
        r->row[i] = number_shown(r->row[i]);
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
