#include "remedy.h"

#include <stdio.h>

#include "host/check/summary.h"
#include "host/number/functions.h"
#include "host/os/system.h"

/* A remedy keeps this part of the limit: the lists of a user's run may round a little otherwise. */
#define LEAVES 0.3
/* No more parts of a step are tried. */
#define PARTS_MOST 20000.0
/* A float's sums are compensated if they have this many times more steps. */
#define COMPENSATED_FROM 10.0

typedef struct search {
    const image *image;
    const image *plain;
    const engine_kind *kind;
    budget *budget;
    double part;   /* of the limits */
    double a_step; /* operations of one, judged, and stages in them */
    double stages;
    bool dear;
} search;

typedef struct wish {
    double step_s;
    wh_method method;
    bool compensated;
    bool in_double;
} wish;

/* The same scene with it; false if the number of steps is not whole, or if it would be the same run. */
static bool image_with(const image *im, const wish *w, image *made) {
    *made = *im;
    made->settings.method = w->method;
    made->settings.compensated = w->compensated;
    made->settings.matrix = MATRIX_NONE;
    made->list[IMAGE_MATRIX] = NULL;
    if (w->step_s == im->step_s) {
        return true;
    }
    if (!(w->step_s >= RATIO_LEAST)) {
        return false;
    }
    made->step = ratio_of(w->step_s);
    made->step_s = ratio_times(1, made->step);
    return ratio_count(ratio_of(im->until_s), made->step, &made->steps) && made->steps > 0;
}

/* Is it wrong from its begin on? A motion that is chaotic is right for longer. A float run is to be right to its end: if
 * it is not, the run in double is tried. */
static bool is_off_at_once(const run_checks *v) {
    if (v->twins == NULL) {
        return false;
    }
    const bool whole = v->kind == &engine_float;
    horizon h = horizon_of(v->twins, whole ? RUN_CHECKS_TOLERANCE : HORIZON_TOLERANCE);
    const bool off = h.first >= 0 && h.column[h.first].verdict == HORIZON_UNTIL &&
                     (whole || h.until_s < RUN_CHECKS_BEGIN * v->twins->end_s);
    horizon_free(&h);
    return off;
}

static bool does(const run_checks *v) {
    return (v->against & ~FINDING_OF_SCENE) == 0 && (v->books == NULL || !v->books->undefined) &&
           !is_off_at_once(v);
}

/* Of no use any more once it has jumped. */
static bool see(void *of, uint64_t step) {
    run_checks *v = of;
    (void)step;
    run_checks_enter(v);
    return !pole_crossing_some(v->jumped);
}

/* Steps with contacts cost more with events, which are not predicted. */
static double operations(const search *s, const image *with) {
    return with->contacts > 0 ? 0.0
                              : (double)with->steps * s->a_step *
                                    wh_methods[with->settings.method].stages / s->stages;
}

static bool try(search *s, const wish *w) {
    image with;
    if (!image_with(s->image, w, &with)) {
        return false;
    }
    s->dear = s->dear || interrupted || operations(s, &with) > budget_left(s->budget);
    if (s->dear) {
        return false;
    }
    const engine_kind *kind = w->in_double ? &engine_double : s->kind;
    void *run = kind->start(&with);
    run_checks *v = run_checks_open(&with, s->plain, kind, run, s->budget);
    v->part = s->part;
    const loop l = {
        .kind = kind, .run = run, .steps = with.steps, .pays = s->budget, .see = see, .of = v};
    wh_status status = WH_OK; /* without a finer run its error is unknown */
    const loop_end end = v->twins != NULL ? loop_run(&l, &status) : LOOP_SPENT;
    run_checks_end(v, status);
    const bool good = end == LOOP_DONE && does(v);
    s->dear = end == LOOP_SPENT || end == LOOP_INTERRUPTED;
    run_checks_close(v);
    kind->stop(run);
    return good;
}

/* In the run's number; after a failure in float also in double. */
static bool try_either(search *s, wish *w) {
    if (try(s, w)) {
        return true;
    }
    wish more = *w;
    more.in_double = true;
    more.compensated = s->image->settings.compensated;
    if (s->kind != &engine_float || !try(s, &more)) {
        return false;
    }
    *w = more;
    return true;
}

static void write_options(const search *s, const wish *w, char text[REMEDY_TEXT]) {
    char step[STEP_WORD];
    const image_settings *own = &s->image->settings;
    const bool other = w->method != own->method || own->matrix != MATRIX_NONE;
    const bool finer = w->step_s != s->image->step_s;
    char all[REMEDY_TEXT + 1];
    snprintf(all, sizeof all, "%s%s%s%s%s%s", other ? " --method " : "",
             other ? wh_methods[w->method].word : "", finer ? " --step " : "",
             finer ? step_text(w->step_s, step) : "",
             w->compensated && !own->compensated ? " --compensated" : "",
             w->in_double ? " --number double" : "");
    snprintf(text, REMEDY_TEXT, "%s", all + 1);
}

/* Finer and finer steps, 1, 2 and 5 times powers of ten. */
static bool try_steps(search *s, wish w, double parts, char text[REMEDY_TEXT]) {
    w.step_s = step_nice_s(s->image->step_s / number_most(parts, 2.0));
    while (w.step_s > 0.0 && w.step_s * PARTS_MOST > s->image->step_s && !s->dear) {
        wish now = w;
        now.compensated = w.compensated || (s->kind == &engine_float &&
                                            w.step_s * COMPENSATED_FROM <= s->image->step_s);
        if (try_either(s, &now)) {
            write_options(s, &now, text);
            return true;
        }
        w.step_s = step_nice_s(0.7 * w.step_s);
    }
    return false;
}

static remedy_outcome find(search *s, double parts, char text[REMEDY_TEXT]) {
    const image *im = s->image;
    const wh_method own = im->settings.matrix == MATRIX_RK4 ? WH_RK4 : im->settings.method;
    wish w = {im->step_s, own, im->settings.compensated, false};
    if (im->fixed != NULL || im->settings.matrix == MATRIX_EXACT || im->steps == 0) {
        return REMEDY_NONE;
    }
    wish other[2] = {w, w};
    other[0].compensated = true;
    other[1].in_double = true;
    for (int i = w.compensated ? 1 : 0; i < (s->kind == &engine_float ? 2 : 1); i++) {
        if (try(s, &other[i])) {
            write_options(s, &other[i], text);
            return REMEDY_DOES;
        }
    }
    if (wh_methods[own].order < wh_methods[WH_METHOD_DEFAULT].order) {
        w.method = WH_METHOD_DEFAULT; /* and with it finer steps */
        wish usual = w;
        if (try_either(s, &usual)) {
            write_options(s, &usual, text);
            return REMEDY_DOES;
        }
        parts = 1.0;
    }
    return try_steps(s, w, parts, text) ? REMEDY_DOES : s->dear ? REMEDY_DEAR : REMEDY_NONE;
}

remedy_outcome remedy_find(const run_checks *v, double parts, char text[REMEDY_TEXT]) {
    const double steps = number_most((double)v->kind->steps(v->run), 1.0);
    budget_begin(v->budget);
    search s = {.image = v->image,
                .plain = v->plain,
                .kind = v->kind,
                .budget = v->budget,
                .part = LEAVES,
                .a_step = (double)(v->budget->own + v->budget->spent) / steps,
                .stages = wh_methods[v->image->settings.method].stages};
    text[0] = '\0';
    const remedy_outcome found = find(&s, parts, text);
    budget_end(v->budget);
    return found;
}

bool remedy_not_needed(const image *im, const image *plain, const engine_kind *kind) {
    budget all = {0};
    search s = {
        .image = im, .plain = plain, .kind = kind, .budget = &all, .part = 1.0, .stages = 1.0};
    const wish own = {im->step_s, im->settings.method, im->settings.compensated, false};
    budget_begin(&all);
    return try(&s, &own);
}
