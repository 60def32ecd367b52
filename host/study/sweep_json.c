/* sweep_json.c: see sweep_json.h. */
#include "sweep_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/method.h"
#include "host/base/alloc.h"
#include "host/check/energy_residual.h"
#include "host/check/finding.h"
#include "host/check/run_json.h"
#include "host/lang/shown.h"
#include "host/lang/units.h"
#include "host/number/decimal.h"

/* In the declared unit of `of`, else in that of the dimension. */
static void put_column(json *j, const char *name, const symbol *of, int primes, const char *si) {
    char *unit = of != NULL ? shown_unit_name(of, primes) : alloc_words("%s", si);
    json_open(j, NULL, '{');
    json_text(j, "name", name);
    json_text(j, "unit", unit);
    json_close(j, '}');
    free(unit);
}

void sweep_json_axes(json *j, const grid *g) {
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        char *unit = a->symbol == NULL ? alloc_words("s") : shown_si_name(a->symbol, a->primes);
        put_column(j, a->column, NULL, 0, unit);
        free(unit);
    }
}

void sweep_json_begin(json *j, const sweep *s) {
    char unit[DIM_TEXT_SIZE];
    const bool is_scene = s->scene != NULL;
    json_begin(j, "sweep", is_scene ? s->scene->name : s->mechanism->name,
               is_scene ? s->scene->title : s->mechanism->title, s->kind, s->engine.method);
    json_open(j, "columns", '[');
    for (int i = 0; i < s->grid->count; i++) {
        const axis *a = &s->grid->axes[i];
        put_column(j, a->column, a->symbol, a->primes, "s");
    }
    for (int i = 0; i < s->measures->count; i++) {
        const measure *m = &s->measures->list[i];
        put_column(j, m->name, measure_symbol(m), m->of->primes,
                   m->kind == MEASURE_PERIOD ? "s" : dim_symbols(m->of->dim, unit, sizeof unit));
    }
    if (!s->mechanism->is_system) {
        put_column(j, ENERGY_RESIDUAL_COLUMN, NULL, 0, "1");
    }
    if (grid_step_axis(s->grid) >= 0) {
        put_column(j, "end_s", NULL, 0, "s");
    }
    json_close(j, ']');
    json_open(j, "rows", '[');
}

void sweep_json_point(json *j, const char *row, const char *error, unsigned found,
                      unsigned against) {
    json_open(j, NULL, '{');
    json_open(j, "values", '[');
    for (const char *at = row;; at++) {
        const char *end;
        const double value = decimal_read(at, &end);
        json_number(j, NULL, end == at ? (double)NAN : value);
        at += strcspn(at, ",\r");
        if (*at != ',') {
            break;
        }
    }
    json_close(j, ']');
    json_open(j, "findings", '[');
    for (int id = 0; id < FINDINGS; id++) {
        if ((found & FINDING_BIT(id)) != 0) {
            json_open(j, NULL, '{');
            json_text(j, "id", finding_rows[id].word);
            json_text(j, "severity", (against & FINDING_BIT(id)) != 0 ? "warning" : "note");
            json_close(j, '}');
        }
    }
    json_close(j, ']');
    if (error != NULL) {
        json_text(j, "error", error);
    } else {
        json_null(j, "error");
    }
    json_close(j, '}');
}

void sweep_json_end(json *j, uint64_t failed, int status) {
    json_close(j, ']');
    json_count(j, "failed", failed);
    json_whole(j, "exit", status);
    json_close(j, '}');
}
