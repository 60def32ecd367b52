/* stability_map.c: see stability_map.h. */
#include "stability_map.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/derive/image_make.h"
#include "host/derive/lagrange.h"
#include "host/number/functions.h"
#include "host/lang/model.h"
#include "host/run/belief.h"
#include "host/run/linearised.h"
#include "host/run/start.h"
#include "host/sweep/changes.h"
#include "host/trust/horizon.h"

#define MAP_VERDICT_ROW(id, mark, word, words) [id] = {mark, word, words},
const map_verdict_row map_verdicts[MAP_VERDICTS] = {MAP_VERDICT_ROWS(MAP_VERDICT_ROW)};

/* The image of a point without tables, too: what the finer run takes. */
typedef struct map_images {
    image *of;
    image *plain; /* NULL: the same */
} map_images;

static map_images images_at(const map_wish *w, uint64_t point) {
    map_images made = {NULL, NULL};
    diags *errors =
        diags_new(); /* a point without a run is a verdict, and its reason the user's: whirl run tells it */
    overrides changes = changes_at(w->grid, w->changes, point);
    instance *inst = instance_make(w->mechanism, w->scene, &changes, errors);
    equations *e = inst == NULL ? NULL : equations_derive(inst, errors);
    if (e != NULL) {
        image_settings plain = w->settings;
        plain.tables = TABLES_NONE;
        made.of = image_make(e, inst->conserve, &w->settings, IMAGE_TO_RUN, errors);
        if (made.of != NULL && w->settings.tables != TABLES_NONE) {
            made.plain = image_make(e, inst->conserve, &plain, IMAGE_TO_RUN, errors);
        }
    }
    if (made.of != NULL && (!start_has_method(made.of, w->settings.method, errors) ||
                            !start_is_possible(made.of, w->kind, errors))) {
        image_free(made.of);
        made.of = NULL;
    }
    equations_free(e);
    instance_free(inst);
    changes_forget(w->changes, &changes);
    diags_free(errors);
    return made;
}

static void images_free(map_images *made) {
    image_free(made->of);
    image_free(made->plain);
}

static map_cell cell_of(const map_wish *w, const twins *t, double step_s) {
    map_cell cell = {
        .verdict = MAP_DIVERGES, .step_s = step_s, .end_s = t->end_s, .left_over = NAN};
    horizon h = horizon_of(t, w->tolerance);
    cell.until_s = h.until_s;
    if (t->books != NULL) {
        const belief b = belief_of(t->books, w->kind, t->run);
        cell.left_over = b.known ? b.ratio : (double)NAN;
    }
    if (t->status == WH_OK) {
        cell.verdict = cell.left_over > BELIEF_LIMIT ? MAP_LOSES
                       : h.to_the_end                ? MAP_KEEPS
                                                     : MAP_OFF;
    }
    horizon_free(&h);
    return cell;
}

/* False: stopped. */
static bool try_point(const map_wish *w, uint64_t point, map_cell *cell) {
    map_images made = images_at(w, point);
    *cell = (map_cell){.verdict = MAP_NONE, .left_over = NAN};
    bool whole = true;
    if (made.of != NULL) {
        const twins_wish wish = {.image = made.of,
                                 .kind = w->kind,
                                 .plain = made.plain != NULL ? made.plain : made.of,
                                 .books = true,
                                 .stop = w->stop};
        twins *t = twins_run(&wish);
        whole = !t->stopped;
        *cell = cell_of(w, t, made.of->step_s);
        twins_free(t);
    }
    images_free(&made);
    return whole;
}

/* --- the theory -----------------------------------------------------------------------------------------*/

/* What takes part in a motion by less is not seen in it. */
#define SHARE_LEAST 1e-3

/* Of all motions that take part and do not grow by themselves the shortest. */
static double longest_stable_s(const linearised *l) {
    double limit_s = NAN;
    for (int i = 0; l != NULL && i < l->motions; i++) {
        const linear_motion *each = &l->motion[i];
        const double size = complex_size(each->value);
        if (!(size > 0.0) || each->value.re > 0.0 || each->share < SHARE_LEAST) {
            continue;
        }
        const complex_number direction = {each->value.re / size, each->value.im / size};
        const double longest_s = limits_interval(l->method, l->form, direction) / size;
        limit_s = longest_s > 0.0 ? number_least(longest_s, limit_s) : limit_s;
    }
    return limit_s;
}

/* Of the run of this point: NAN where it is not known. */
static double limit_at(const map_wish *w, uint64_t point) {
    map_images made = images_at(w, point);
    double limit_s = NAN;
    if (made.of != NULL && made.of->contacts == 0) {
        void *run = w->kind->start(made.of);
        watch *seen = watch_open(made.of, w->kind);
        books *b = books_open(made.of);
        wh_status status = WH_OK;
        for (uint64_t step = 0;; step++) {
            if (b != NULL) {
                books_enter(b, w->kind, run);
            }
            watch_enter(seen, w->kind, b, run);
            if (step == made.of->steps || status != WH_OK || (w->stop != NULL && *w->stop)) {
                break;
            }
            status = w->kind->step(run);
        }
        watch_end(seen, status != WH_OK);
        linearised *l = linearised_of(seen, w->settings.method);
        limit_s = longest_stable_s(l);
        linearised_free(l);
        books_close(b);
        watch_close(seen);
        w->kind->stop(run);
    }
    images_free(&made);
    return limit_s;
}

uint64_t map_point(const grid *g, uint64_t first, uint64_t second) {
    return first * g->axes[1].count + second;
}

/* By the shortest step of each place. */
static void find_limits(const map_wish *w, stability_map *m) {
    const axis *step = &w->grid->axes[m->step_axis];
    const axis *other = &w->grid->axes[1 - m->step_axis];
    const uint64_t finest = step->from <= step->to ? 0 : step->count - 1;
    m->limit_s = room((int64_t)other->count, sizeof *m->limit_s);
    for (uint64_t i = 0; i < other->count; i++) {
        m->limit_s[i] = limit_at(w, m->step_axis == 0 ? map_point(w->grid, finest, i)
                                                      : map_point(w->grid, i, finest));
    }
}

stability_map map_make(const map_wish *w) {
    stability_map m = {.grid = w->grid, .step_axis = -1};
    m.cell = room((int64_t)w->grid->points, sizeof *m.cell);
    for (int i = 0; i < w->grid->count; i++) {
        m.step_axis = w->grid->axes[i].symbol == NULL ? i : m.step_axis;
    }
    while (m.done < w->grid->points && try_point(w, m.done, &m.cell[m.done])) {
        m.done++;
        if (w->progress != NULL) {
            w->progress(w->told, m.done, w->grid->points);
        }
    }
    if (m.step_axis >= 0 && m.done == w->grid->points) {
        find_limits(w, &m);
    }
    return m;
}

void map_free(stability_map *m) {
    free(m->cell);
    free(m->limit_s);
    *m = (stability_map){0};
}

uint64_t map_count(const stability_map *m, map_verdict verdict) {
    uint64_t count = 0;
    for (uint64_t i = 0; i < m->done; i++) {
        count += m->cell[i].verdict == verdict ? 1 : 0;
    }
    return count;
}
