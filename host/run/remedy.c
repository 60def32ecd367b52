/* remedy.c: see remedy.h. */
#include "remedy.h"

#include <stdio.h>

#include "host/number/functions.h"
#include "host/run/summary.h"
#include "loop.h"

/* A remedy keeps this part of the limit: the lists of a user's run may round a little otherwise. */
#define LEAVES 0.3
/* No more parts of a step are tried. */
#define PARTS_MOST 20000.0
/* A float's sums are compensated where they are made of so many more steps. */
#define COMPENSATED_FROM 10.0

typedef struct search {
    const image *image;
    const image *plain;
    const engine_kind *kind;
    const volatile sig_atomic_t *stop;
    double part;  /* of the limits */
    double spent; /* operations */
    bool dear;
} search;

typedef struct wish {
    double step_s;
    wh_method method;
    bool compensated;
    bool in_double;
} wish;

static bool is_stopped(const search *s) { return s->stop != NULL && *s->stop; }

/* The same scene with it; false where no whole number of steps counts that, or it would be the same run. */
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

/* Operations of an evaluation beside its list, and of the search for events in a step. */
#define BESIDE 40.0
#define EVENTS_AS 8.0

/* A run, its books, and the finer run, which has twice as many steps. */
static double operations(const image *im) {
    const double events = im->contacts > 0 ? EVENTS_AS : 0.0;
    const double stages = wh_methods[im->settings.method].stages;
    const double finer = number_most(stages, wh_methods[WH_METHOD_DEFAULT].stages);
    const double evaluations = stages + 2.0 * finer + 3.0 * events;
    return (double)im->steps * (evaluations * (im->list[IMAGE_STEP]->count + BESIDE) +
                                2.0 * (im->list[IMAGE_BOOKS]->count + BESIDE));
}

/* Is it wrong from its begin on? A motion that is chaotic is right for longer. */
static bool is_off_at_once(const verdict *v) {
    if (v->twins == NULL) {
        return false;
    }
    horizon h = horizon_of(v->twins, HORIZON_TOLERANCE);
    const bool off = h.first >= 0 && h.column[h.first].verdict == HORIZON_UNTIL &&
                     h.until_s < VERDICT_BEGIN * v->twins->end_s;
    horizon_free(&h);
    return off;
}

static bool does(const verdict *v) {
    return (v->against & ~FINDING_OF_SCENE) == 0 && (v->books == NULL || !v->books->undefined) &&
           !is_off_at_once(v);
}

/* Of no use any more once it has jumped. */
static bool see(void *of, uint64_t step) {
    verdict *v = of;
    (void)step;
    verdict_enter(v);
    return !jumped_some(v->jumped);
}

static bool try(search *s, const wish *w) {
    image with;
    if (is_stopped(s) || !image_with(s->image, w, &with)) {
        s->dear = s->dear || is_stopped(s);
        return false;
    }
    if (s->spent + operations(&with) > TWINS_OPERATIONS_1S) {
        s->dear = true;
        return false;
    }
    const engine_kind *kind = w->in_double ? &engine_double : s->kind;
    void *run = kind->start(&with);
    verdict *v = verdict_open(&with, s->plain, kind, run);
    v->stop = s->stop;
    v->part = s->part;
    const loop l = {
        .kind = kind, .run = run, .steps = with.steps, .stop = s->stop, .see = {{see, v}}};
    wh_status status;
    const bool whole = loop_run(&l, &status) == LOOP_DONE;
    s->spent +=
        operations(&with) * (double)kind->steps(run) / (double)(with.steps + (with.steps == 0));
    verdict_end(v, status);
    const bool good = whole && does(v);
    verdict_close(v);
    kind->stop(run);
    return good;
}

/* In the run's number; of a float's, in double where that does not do. */
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

remedy_outcome remedy_find(const image *im, const image *plain, const engine_kind *kind,
                           double parts, const volatile sig_atomic_t *stop,
                           char text[REMEDY_TEXT]) {
    search s = {.image = im, .plain = plain, .kind = kind, .stop = stop, .part = LEAVES};
    const wh_method own = im->settings.matrix == MATRIX_RK4 ? WH_RK4 : im->settings.method;
    wish w = {im->step_s, own, im->settings.compensated, false};
    text[0] = '\0';
    if (im->fixed != NULL || im->settings.matrix == MATRIX_EXACT || im->steps == 0) {
        return REMEDY_NONE;
    }
    wish other[2] = {w, w};
    other[0].compensated = true;
    other[1].in_double = true;
    for (int i = w.compensated ? 1 : 0; i < (kind == &engine_float ? 2 : 1); i++) {
        if (try(&s, &other[i])) {
            write_options(&s, &other[i], text);
            return REMEDY_DOES;
        }
    }
    if (wh_methods[own].order < wh_methods[WH_METHOD_DEFAULT].order) {
        w.method = WH_METHOD_DEFAULT; /* and with it finer steps */
        wish usual = w;
        if (try_either(&s, &usual)) {
            write_options(&s, &usual, text);
            return REMEDY_DOES;
        }
        parts = 1.0;
    }
    if (try_steps(&s, w, parts, text)) {
        return REMEDY_DOES;
    }
    return s.dear ? REMEDY_DEAR : REMEDY_NONE;
}

bool remedy_not_needed(const image *im, const image *plain, const engine_kind *kind,
                       const volatile sig_atomic_t *stop) {
    search s = {.image = im, .plain = plain, .kind = kind, .stop = stop, .part = 1.0};
    const wish own = {im->step_s, im->settings.method, im->settings.compensated, false};
    return try(&s, &own);
}
