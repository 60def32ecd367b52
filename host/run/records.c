/* records.c: writing a run as comma-separated values. */
#include "records.h"

#include <stdlib.h>
#include <string.h>

records *records_open(FILE *out, const program *p, const equations *e, const engine_kind *kind) {
    records *r = calloc(1, sizeof *r);
    if (r == NULL) {
        abort();
    }
    const int columns = 1 + p->angles + p->reals + p->outputs;
    *r = (records){out, p, e, kind, calloc((size_t)columns, sizeof *r->row), columns};
    if (r->row == NULL) {
        abort();
    }
    return r;
}

void records_close(records *r) {
    if (r != NULL) {
        free(r->row);
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
    const int states = r->program->angles + r->program->reals;
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

void records_header(records *r) {
    char name[256];
    for (int i = 0; i < r->columns; i++) {
        records_name(r, i, name, sizeof name);
        fprintf(r->out, "%s%s", i > 0 ? "," : "", name);
    }
    fputs("\r\n", r->out);
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
    r->kind->outputs(run, r->row + 1 + p->angles + p->reals);
}

bool records_write(const records *r) {
    for (int i = 0; i < r->columns; i++) {
        /* time is a whole number of steps: it carries its own digits */
        if (i == 0) {
            fprintf(r->out, "%.15g", r->row[i]);
        } else {
            fprintf(r->out, ",%.*g", r->kind->digits, r->row[i]);
        }
    }
    fputs("\r\n", r->out);
    return ferror(r->out) == 0;
}
