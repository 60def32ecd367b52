#include "host/study/stability_map.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/check/run_checks.h"
#include "host/check/run_json.h"
#include "host/io/gnuplot.h"
#include "host/lang/value.h"
#include "host/number/functions.h"
#include "host/os/system.h"
#include "host/study/session.h"

#define MAP_VERDICT_ROW(id, mark, word, words) [id] = {mark, word, words},
const map_verdict_row map_verdicts[MAP_VERDICTS] = {MAP_VERDICT_ROWS(MAP_VERDICT_ROW)};

/* --- values ----------------------------------------------------------------------------------------------*/

static const axis *along_of(const stability_map *m) { return &m->grid->axes[m->along]; }
static const axis *rows_of(const stability_map *m) { return &m->grid->axes[1 - m->along]; }

uint64_t map_point(const stability_map *m, uint64_t row, uint64_t at) {
    const axis *along = along_of(m);
    const uint64_t i = along->from <= along->to ? at : along->count - 1 - at;
    const uint64_t second = m->grid->axes[1].count;
    return m->along == 1 ? row * second + i : i * second + row;
}

static double value_of(const stability_map *m, uint64_t point, int which) {
    double value[2];
    grid_values(m->grid, point, value);
    return value[which];
}

double map_along(const stability_map *m, uint64_t at) {
    return value_of(m, map_point(m, 0, at), m->along);
}

double map_row(const stability_map *m, uint64_t row) {
    return value_of(m, map_point(m, row, 0), 1 - m->along);
}

/* --- a row ---------------------------------------------------------------------------------------------*/

typedef struct row_runs {
    const map_request *request;
    stability_map *map;
    double *range; /* [columns], in the columns' units; NULL: not known yet */
} row_runs;

/* Is column k the highest recorded derivative of its unknown? */
static bool is_highest(const step_doubling *t, int k) {
    const record_column *c = &t->shape->column[k];
    bool highest = true;
    for (int i = 1; i < t->columns; i++) {
        const record_column *other = &t->shape->column[i];
        highest = highest && (other->unknown != c->unknown || other->primes <= c->primes);
    }
    return highest;
}

static bool is_out_of_bounds(const row_runs *p, const horizon *h) {
    bool out = h->of->status != WH_OK || h->of->finer_failed_s >= 0.0;
    for (int k = 1; k < h->of->columns; k++) {
        const horizon_column *c = &h->column[k];
        out = out || (c->verdict == HORIZON_UNTIL && is_highest(h->of, k) && isfinite(c->off) &&
                      c->off > MAP_BOUND * p->range[k]);
    }
    return out;
}

static map_cell cell_of(row_runs *p, const run_checks *v) {
    const step_doubling *t = v->doubling;
    const map_request *w = p->request;
    horizon h = horizon_of(t, w->tolerance);
    map_cell cell = {
        .verdict = MAP_OFF, .end_s = t->end_s, .until_s = h.until_s, .left_over = (double)NAN};
    if (p->range == NULL) {
        p->range = alloc(t->columns, sizeof *p->range);
        for (int k = 1; k < t->columns; k++) {
            p->range[k] = h.column[k].range;
        }
    }
    if (v->balance.known) {
        cell.left_over = v->balance.ratio;
    }
    if (is_out_of_bounds(p, &h)) {
        cell.verdict = MAP_DIVERGES;
    } else if (cell.left_over > ENERGY_RESIDUAL_LIMIT) {
        cell.verdict = MAP_LOSES;
    } else if (h.to_the_end) {
        cell.verdict = MAP_KEEPS;
    }
    horizon_free(&h);
    return cell;
}

static void show_share(double share, void *context) {
    const row_runs *p = context;
    p->request->progress((double)p->map->done + share, p->request->context);
}

/* Sets the verdict of a point, unless interrupted. A refused image is MAP_NONE; `whirl run` prints the reason. */
static void try_point(row_runs *p, uint64_t point) {
    const map_request *w = p->request;
    diags *unsaid = diags_new();
    image *im = sweep_image(&w->of, point, unsaid);
    map_cell cell = {.verdict = MAP_NONE, .left_over = (double)NAN};
    bool whole = true;
    if (im != NULL) {
        run_checks *v =
            run_checks_whole(im, w->of.kind, w->progress != NULL ? show_share : NULL, p);
        whole = !v->interrupted;
        if (whole) {
            cell = cell_of(p, v);
        }
        run_checks_close(v);
    }
    image_free(im);
    diags_free(unsaid);
    if (whole) {
        p->map->cell[point] = cell;
        p->map->done++;
    }
}

static void try_row(const map_request *w, stability_map *m, uint64_t row) {
    row_runs p = {.request = w, .map = m};
    for (uint64_t i = 0; i < along_of(m)->count && !interrupted; i++) {
        const uint64_t point = map_point(m, row, i);
        if (!m->by_step) { /* the next point is another scene, so its ranges differ */
            free(p.range);
            p.range = NULL;
        }
        try_point(&p, point);
        if (w->progress != NULL) {
            show_share(0.0, &p);
        }
    }
    free(p.range);
}

/* --- the map ---------------------------------------------------------------------------------------------*/

stability_map map_make(const map_request *w) {
    const grid *g = w->of.grid;
    stability_map m = {.grid = g,
                       .along = g->axes[0].symbol == NULL ? 0 : 1,
                       .by_step = g->axes[0].symbol == NULL || g->axes[1].symbol == NULL};
    const uint64_t rows = g->axes[1 - m.along].count;
    m.cell = alloc((int64_t)g->points, sizeof *m.cell);
    for (uint64_t i = 0; i < g->points; i++) {
        m.cell[i] = (map_cell){.verdict = MAP_UNTRIED, .left_over = (double)NAN};
    }
    for (uint64_t i = 0; i < rows && !interrupted; i++) {
        try_row(w, &m, i);
    }
    return m;
}

void map_free(stability_map *m) {
    free(m->cell);
    *m = (stability_map){0};
}

uint64_t map_count(const stability_map *m, map_verdict verdict) {
    uint64_t count = 0;
    for (uint64_t i = 0; i < m->grid->points; i++) {
        count += m->cell[i].verdict == verdict ? 1 : 0;
    }
    return count;
}

/* === text, CSV and JSON ======================================================================= */

static map_verdict verdict_at(const stability_map *m, uint64_t row, uint64_t at) {
    return m->cell[map_point(m, row, at)].verdict;
}

/* --- for people ------------------------------------------------------------------------------------------*/

/* The row with the largest value is on top, as in the picture. */
void map_print(FILE *out, const stability_map *m, const char *words) {
    const axis *along = along_of(m);
    const axis *rows = rows_of(m);
    fprintf(out, "%s\n\n  %-12.40s %.40s from %.6g to %.6g%s\n", words, rows->column, along->column,
            map_along(m, 0), map_along(m, along->count - 1), along->is_log ? ", logarithmic" : "");
    const bool rises = rows->from <= rows->to;
    for (uint64_t i = 0; i < rows->count; i++) {
        const uint64_t row = rises ? rows->count - 1 - i : i;
        fprintf(out, "  %-12.6g ", map_row(m, row));
        for (uint64_t at = 0; at < along->count; at++) {
            fputc(map_verdicts[verdict_at(m, row, at)].mark, out);
        }
        fputc('\n', out);
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

void map_csv(FILE *out, const stability_map *m) {
    const grid *g = m->grid;
    fprintf(out, "%s,%s,verdict,until,end,energy_residual\r\n", g->axes[0].column,
            g->axes[1].column);
    for (uint64_t i = 0; i < g->points; i++) {
        const map_cell *c = &m->cell[i];
        const bool known = c->verdict != MAP_NONE;
        char text[NUMBER_SIZE];
        double value[2];
        if (c->verdict == MAP_UNTRIED) {
            continue;
        }
        grid_values(g, i, value);
        fprintf(out, "%s", number_shortest(value[0], text));
        field(out, value[1]);
        fprintf(out, ",%s", map_verdicts[c->verdict].word);
        field(out, known ? c->until_s : (double)NAN);
        field(out, known ? c->end_s : (double)NAN);
        field(out, c->left_over);
        fputs("\r\n", out);
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
    json_number(j, "energy_residual", c->left_over);
    json_close(j, '}');
}

void map_json(FILE *out, const stability_map *m, const image *of, const map_request *w,
              int status) {
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
    json_unlooked(&j, 0U);
    json_whole(&j, "exit", status);
    json_close(&j, '}');
}

/* === the picture ============================================================================== */

enum { HEIGHT = 620 };

/* The upper (`up`) or lower edge of the cell around `value`. */
static double edge(const axis *a, double value, bool up) {
    const double cells = a->count > 1 ? (double)(a->count - 1) : 1.0;
    if (a->is_log) {
        const double ratio = a->count > 1 ? number_most(a->to / a->from, a->from / a->to) : 1.1;
        const double half = number_power(ratio, 0.5 / cells);
        return up == (value > 0.0) ? value * half : value / half;
    }
    const double width = a->count > 1 ? fabs(a->to - a->from) : number_most(fabs(a->from), 1.0);
    return up ? value + 0.5 * width / cells : value - 0.5 * width / cells;
}

static void set_axis(FILE *to, const axis *a, char letter) {
    char *unit = sweep_axis_unit(a);
    const double least = number_least(a->from, a->to);
    const double most = number_most(a->from, a->to);
    fprintf(to, "set %clabel ", letter);
    gnuplot_quote(to, a->column);
    fprintf(to, ".' [%s]' noenhanced\n", unit);
    free(unit);
    if (a->is_log && a->from > 0.0) { /* gnuplot takes only values above zero */
        fprintf(to, "set logscale %c\n", letter);
    }
    fprintf(to, "set %crange [%.17g:%.17g]\n", letter, edge(a, least, false), edge(a, most, true));
}

/* Joins neighboring cells of a row with this verdict into blocks. Writes x, y and the four edges of each block. */
static void write_cells(FILE *to, const stability_map *m, map_verdict verdict) {
    const axis *along = along_of(m);
    const axis *rows = rows_of(m);
    fprintf(to, "$%s << EOD\n", map_verdicts[verdict].word);
    for (uint64_t row = 0; row < rows->count; row++) {
        const double y = map_row(m, row);
        for (uint64_t at = 0; at < along->count; at++) {
            const uint64_t from = at;
            while (at < along->count && verdict_at(m, row, at) == verdict) {
                at++;
            }
            if (at > from) {
                fprintf(to, "%.9g %.9g %.9g %.9g %.9g %.9g\n", map_along(m, from), y,
                        edge(along, map_along(m, from), false),
                        edge(along, map_along(m, at - 1), true), edge(rows, y, false),
                        edge(rows, y, true));
            }
        }
    }
    fputs("EOD\n", to);
}

static bool draw(const char *file, const stability_map *m, const char *words, const char *text) {
    gnuplot g;
    if (!gnuplot_open(&g, file, HEIGHT, words, text)) {
        return false;
    }
    fputs("set title ", g.to);
    gnuplot_quote(g.to, words);
    fputs(" noenhanced\n", g.to);
    set_axis(g.to, along_of(m), 'x');
    set_axis(g.to, rows_of(m), 'y');
    fputs(
        "set key below left Left reverse maxcols 1 samplen 2\nset tics out\nset style fill solid noborder\n",
        g.to);
    char *plot = alloc_words("%s", "");
    for (int i = 0; i < PALETTE_AREAS; i++) {
        if (map_count(m, (map_verdict)i) > 0) {
            const map_verdict_row *v = &map_verdicts[i];
            write_cells(g.to, m, (map_verdict)i);
            char *longer = alloc_words("%s%s$%s with boxxyerror lc rgb '%s' title '%s: %s'", plot,
                                       plot[0] != '\0' ? ", " : "plot ", v->word, palette_area(i),
                                       v->word, v->words);
            free(plot);
            plot = longer;
        }
    }
    fputs(plot[0] != '\0' ? plot : "plot NaN notitle", g.to);
    free(plot);
    fputc('\n', g.to);
    return gnuplot_close(&g);
}

bool map_plot(const char *file, const stability_map *m, const char *words) {
    char *text; /* a description of the picture for readers who cannot see it */
    FILE *out = alloc_text(&text, NULL);
    fprintf(out, "A map of %s and %s.", along_of(m)->column, rows_of(m)->column);
    for (int i = 0; i < PALETTE_AREAS; i++) {
        fprintf(out, " %llu %s: %s.", (unsigned long long)map_count(m, (map_verdict)i),
                map_verdicts[i].word, map_verdicts[i].words);
    }
    alloc_text_end(out);
    const bool drawn = draw(file, m, words, text);
    free(text);
    return drawn;
}
