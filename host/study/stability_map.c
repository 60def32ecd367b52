/* stability_map.c: see stability_map.h. */
#include "stability_map.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/base/interrupts.h"
#include "host/check/aliasing.h"
#include "host/check/energy_residual.h"
#include "host/check/horizon.h"
#include "host/number/functions.h"

#define MAP_VERDICT_ROW(id, mark, word, words) [id] = {mark, word, words},
const map_verdict_row map_verdicts[MAP_VERDICTS] = {MAP_VERDICT_ROWS(MAP_VERDICT_ROW)};

/* --- values ----------------------------------------------------------------------------------------------*/

uint64_t map_point(const stability_map *m, uint64_t row, uint64_t at) {
    const axis *along = &m->grid->axes[m->along];
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

/* Its runs are judged by the range that each column has in the first of them, the finest: of a coarse one the looks are
 * few, and where half its step is too long as well, the finer one grows with it. */
typedef struct row_runs {
    const map_wish *wish;
    stability_map *map;
    double *range; /* [columns], in the columns' units; NULL: not known yet */
} row_runs;

/* Is there no column of its derivative? */
static bool is_highest(const step_doubling *t, int k) {
    const record_column *c = &t->shape->column[k];
    bool highest = true;
    for (int i = 1; i < t->columns; i++) {
        const record_column *other = &t->shape->column[i];
        highest = highest && (other->unknown != c->unknown || other->primes <= c->primes);
    }
    return highest;
}

static void take_ranges(row_runs *p, const horizon *h) {
    p->range = alloc(h->of->columns, sizeof *p->range);
    for (int k = 1; k < h->of->columns; k++) {
        p->range[k] = h->column[k].range;
    }
}

/* Where the finer one is, half the step being too long, the run is as well. */
static bool is_out_of_bounds(const row_runs *p, const horizon *h) {
    bool out = h->of->status != WH_OK || h->of->finer_failed_s >= 0.0;
    for (int k = 1; k < h->of->columns; k++) {
        const horizon_column *c = &h->column[k];
        out = out || (c->verdict == HORIZON_UNTIL && is_highest(h->of, k) && isfinite(c->off) &&
                      c->off > MAP_BOUND * p->range[k]);
    }
    return out;
}

static map_cell cell_of(row_runs *p, const step_doubling *t) {
    const map_wish *w = p->wish;
    horizon h = horizon_of(t, w->tolerance);
    map_cell cell = {
        .verdict = MAP_OFF, .end_s = t->end_s, .until_s = h.until_s, .left_over = (double)NAN};
    if (p->range == NULL) {
        take_ranges(p, &h);
    }
    if (t->books != NULL) {
        const energy_residual b = energy_residual_of(t->books, w->of.kind, t->run);
        cell.left_over = b.known ? b.ratio : (double)NAN;
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

static void show_share(double share, void *told) {
    const row_runs *p = told;
    p->wish->progress((double)p->map->done + share, p->wish->told);
}

/* Without an image the pair has no run: that is a verdict, and `whirl run` tells why. Stopped: nothing is known of it. */
static void try_point(row_runs *p, uint64_t point) {
    const map_wish *w = p->wish;
    diags *unsaid = diags_new();
    image *plain = NULL;
    image *im = sweep_image(&w->of, point, &plain, unsaid);
    map_cell cell = {.verdict = MAP_NONE, .left_over = (double)NAN};
    bool whole = true;
    if (im != NULL) {
        const step_doubling_wish wish = {.image = im,
                                         .kind = w->of.kind,
                                         .plain = plain != NULL ? plain : im,
                                         .books = true,
                                         .progress = w->progress != NULL ? show_share : NULL,
                                         .told = p};
        step_doubling *t = step_doubling_run(&wish);
        whole = !t->stopped;
        if (whole) {
            (void)aliasing_find(t, NULL);
            cell = cell_of(p, t);
        }
        step_doubling_free(t);
    }
    image_free(im);
    image_free(plain);
    diags_free(unsaid);
    if (whole) {
        p->map->cell[point] = cell;
        p->map->done++;
    }
}

static void try_row(const map_wish *w, stability_map *m, uint64_t row) {
    row_runs p = {.wish = w, .map = m};
    for (uint64_t i = 0; i < w->of.grid->axes[m->along].count && !interrupted; i++) {
        const uint64_t point = map_point(m, row, i);
        if (!m->by_step) { /* another scene, not the same in other steps */
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

stability_map map_make(const map_wish *w) {
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
