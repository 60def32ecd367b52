/* map_text.c: a stability map for people and for programs. */
#include "stability_map.h"

#include <math.h>

#include "host/check/run_json.h"
#include "host/study/sweep_json.h"

static const axis *along_of(const stability_map *m) { return &m->grid->axes[m->along]; }
static const axis *rows_of(const stability_map *m) { return &m->grid->axes[1 - m->along]; }

static map_verdict verdict_at(const stability_map *m, uint64_t row, uint64_t at) {
    return m->cell[map_point(m, row, at)].verdict;
}

/* --- for people ------------------------------------------------------------------------------------------*/

static void print_row(FILE *out, const stability_map *m, uint64_t row) {
    fprintf(out, "  %-12.6g ", map_row(m, row));
    for (uint64_t i = 0; i < along_of(m)->count; i++) {
        fputc(map_verdicts[verdict_at(m, row, i)].mark, out);
    }
    fputc('\n', out);
}

/* The largest value of a row on top, as in the picture. */
void map_print(FILE *out, const stability_map *m, const char *words) {
    const axis *along = along_of(m);
    const axis *rows = rows_of(m);
    fprintf(out, "%s\n\n  %-12.40s %.40s from %.6g to %.6g%s\n", words, rows->column, along->column,
            map_along(m, 0), map_along(m, along->count - 1), along->is_log ? ", logarithmic" : "");
    const bool rises = rows->from <= rows->to;
    for (uint64_t i = 0; i < rows->count; i++) {
        print_row(out, m, rises ? rows->count - 1 - i : i);
    }
    fputc('\n', out);
    for (int i = 0; i < MAP_VERDICTS; i++) {
        const uint64_t count = map_count(m, (map_verdict)i);
        if (count > 0) {
            fprintf(out, "  %c  %-8s %6llu  %s\n", map_verdicts[i].mark, map_verdicts[i].word,
                    (unsigned long long)count, map_verdicts[i].words);
        }
    }
}

/* --- for programs ----------------------------------------------------------------------------------------*/

static void field(FILE *out, double value) {
    char text[NUMBER_SIZE];
    fprintf(out, ",%s", isfinite(value) ? number_shortest(value, text) : "");
}

static void write_row(FILE *out, const stability_map *m, uint64_t point) {
    const map_cell *c = &m->cell[point];
    const bool known = c->verdict != MAP_NONE;
    char text[NUMBER_SIZE];
    double value[2];
    grid_values(m->grid, point, value);
    fprintf(out, "%s", number_shortest(value[0], text));
    field(out, value[1]);
    fprintf(out, ",%s", map_verdicts[c->verdict].word);
    field(out, known ? c->until_s : (double)NAN);
    field(out, known ? c->end_s : (double)NAN);
    field(out, c->left_over);
    fputs("\r\n", out);
}

void map_csv(FILE *out, const stability_map *m) {
    const grid *g = m->grid;
    fprintf(out, "%s,%s,verdict,until,end,energy_left_over\r\n", g->axes[0].column,
            g->axes[1].column);
    for (uint64_t i = 0; i < g->points; i++) {
        if (m->cell[i].verdict != MAP_UNTRIED) {
            write_row(out, m, i);
        }
    }
}

static void put_pair(json *j, const stability_map *m, uint64_t point) {
    const map_cell *c = &m->cell[point];
    const bool known = c->verdict != MAP_NONE;
    double value[2];
    grid_values(m->grid, point, value);
    json_open(j, NULL, '{');
    json_open(j, "values", '[');
    json_number(j, NULL, value[0]);
    json_number(j, NULL, value[1]);
    json_close(j, ']');
    json_text(j, "verdict", map_verdicts[c->verdict].word);
    json_time(j, "until_s", known ? c->until_s : -1.0);
    json_time(j, "end_s", known ? c->end_s : -1.0);
    json_number(j, "energy_left_over", c->left_over);
    json_close(j, '}');
}

void map_json(FILE *out, const stability_map *m, const image *of, const map_wish *w, int status) {
    json j = {.out = out};
    json_begin(&j, "map", of->name, of->title, w->of.kind, w->of.engine.method);
    json_number(&j, "tolerance", w->tolerance);
    json_open(&j, "columns", '[');
    sweep_json_axes(&j, m->grid);
    json_close(&j, ']');
    json_open(&j, "rows", '[');
    for (uint64_t i = 0; i < m->grid->points; i++) {
        if (m->cell[i].verdict != MAP_UNTRIED) {
            put_pair(&j, m, i);
        }
    }
    json_close(&j, ']');
    json_whole(&j, "exit", status);
    json_close(&j, '}');
}
