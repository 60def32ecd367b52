/* stability_map.c: see stability_map.h. */
#include "stability_map.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/derive/image_make.h"
#include "host/derive/lagrange.h"
#include "host/lang/model.h"
#include "host/number/functions.h"
#include "host/run/aliasing.h"
#include "host/run/belief.h"
#include "host/run/horizon.h"
#include "host/run/loop.h"
#include "host/run/start.h"
#include "host/sweep/changes.h"

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

/* --- a point's images ------------------------------------------------------------------------------------*/

typedef struct map_images {
    image *of;
    image *plain; /* for the finer run; NULL: the same */
} map_images;

static map_images images_of(const map_wish *w, const instance *inst, diags *errors) {
    map_images made = {NULL, NULL};
    equations *e = equations_derive(inst, errors);
    if (e != NULL) {
        made.of = image_make(e, inst->conserve, &w->settings, IMAGE_TO_RUN, errors);
    }
    image_settings plain;
    if (made.of != NULL && twins_plain(&w->settings, &plain)) {
        made.plain = image_make(e, inst->conserve, &plain, IMAGE_TO_RUN, errors);
    }
    equations_free(e);
    return made;
}

static void images_free(map_images *made) {
    image_free(made->of);
    image_free(made->plain);
}

/* None where the point has no run: that is a verdict, and `whirl run` tells why. */
static map_images images_at(const map_wish *w, uint64_t point) {
    map_images made = {NULL, NULL};
    diags *errors = diags_new();
    overrides changes = changes_at(w->grid, w->changes, point);
    instance *inst = instance_make(w->mechanism, w->scene, &changes, errors);
    if (inst != NULL) {
        made = images_of(w, inst, errors);
    }
    if (made.of != NULL && (!start_has_method(made.of, w->settings.method, errors) ||
                            !start_is_possible(made.of, w->kind, errors))) {
        images_free(&made);
        made = (map_images){NULL, NULL};
    }
    instance_free(inst);
    changes_forget(w->changes, &changes);
    diags_free(errors);
    return made;
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
static bool is_highest(const twins *t, int k) {
    const record_column *c = &t->shape->column[k];
    bool highest = true;
    for (int i = 1; i < t->columns; i++) {
        const record_column *other = &t->shape->column[i];
        highest = highest && (other->unknown != c->unknown || other->primes <= c->primes);
    }
    return highest;
}

static void take_ranges(row_runs *p, const horizon *h) {
    p->range = room(h->of->columns, sizeof *p->range);
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

static map_cell cell_of(row_runs *p, const twins *t) {
    const map_wish *w = p->wish;
    horizon h = horizon_of(t, w->tolerance);
    map_cell cell = {
        .verdict = MAP_OFF, .end_s = t->end_s, .until_s = h.until_s, .left_over = (double)NAN};
    if (p->range == NULL) {
        take_ranges(p, &h);
    }
    if (t->books != NULL) {
        const belief b = belief_of(t->books, w->kind, t->run);
        cell.left_over = b.known ? b.ratio : (double)NAN;
    }
    if (is_out_of_bounds(p, &h)) {
        cell.verdict = MAP_DIVERGES;
    } else if (cell.left_over > BELIEF_LIMIT) {
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

/* Stopped: nothing is known of it. */
static void try_point(row_runs *p, uint64_t point) {
    const map_wish *w = p->wish;
    map_images made = images_at(w, point);
    map_cell cell = {.verdict = MAP_NONE, .left_over = (double)NAN};
    bool whole = true;
    if (made.of != NULL) {
        const twins_wish wish = {.image = made.of,
                                 .kind = w->kind,
                                 .plain = made.plain != NULL ? made.plain : made.of,
                                 .books = true,
                                 .stop = w->stop,
                                 .progress = w->progress != NULL ? show_share : NULL,
                                 .told = p};
        twins *t = twins_run(&wish);
        whole = !t->stopped;
        if (whole) {
            aliasing_find(t, w->stop);
            cell = cell_of(p, t);
        }
        twins_free(t);
    }
    images_free(&made);
    if (whole) {
        p->map->cell[point] = cell;
        p->map->done++;
    }
}

static bool is_stopped(const map_wish *w) { return w->stop != NULL && *w->stop; }

static void try_row(const map_wish *w, stability_map *m, uint64_t row) {
    row_runs p = {.wish = w, .map = m};
    for (uint64_t i = 0; i < w->grid->axes[m->along].count && !is_stopped(w); i++) {
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
    const grid *g = w->grid;
    stability_map m = {.grid = g,
                       .along = g->axes[0].symbol == NULL ? 0 : 1,
                       .by_step = g->axes[0].symbol == NULL || g->axes[1].symbol == NULL};
    const uint64_t rows = g->axes[1 - m.along].count;
    m.cell = room((int64_t)g->points, sizeof *m.cell);
    for (uint64_t i = 0; i < g->points; i++) {
        m.cell[i] = (map_cell){.verdict = MAP_UNTRIED, .left_over = (double)NAN};
    }
    for (uint64_t i = 0; i < rows && !is_stopped(w); i++) {
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
