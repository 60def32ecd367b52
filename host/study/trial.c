#include "trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/interrupts.h"
#include "host/base/nearest.h"
#include "host/fixed/fixed_plan.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

/* Operations that a reference's two computations may evaluate each, of all points: some seconds. */
#define REFERENCE_OPERATIONS 6e8
/* A run with a larger error, as a part of the largest value, is useless. */
#define USABLE 1.0
/* If a scene has no step in fixed point, this many times a tenth of the step is tried. */
enum { FINER_MOST = 3 };

const char *trial_time(whole_ratio time, char text[TRIAL_TIME]) {
    const double value = ratio_times(1, time);
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, TRIAL_TIME, "%.*g", digits, value);
        const whole_ratio back = ratio_of(decimal_read(text, NULL));
        if (back.numerator == time.numerator && back.denominator == time.denominator) {
            break;
        }
    }
    return text;
}

whole_ratio trial_step(const trials *t, deviation_pace pace) {
    whole_ratio s = t->wish.spacing;
    const uint64_t over = ratio_divisor(s.numerator, pace.steps);
    const uint64_t under = ratio_divisor(pace.records, s.denominator);
    if (s.denominator / under > UINT64_MAX / (pace.steps / over) ||
        s.numerator / over > UINT64_MAX / (pace.records / under)) {
        return ratio_of(ratio_times(1, s) * (double)pace.records / (double)pace.steps);
    }
    s.numerator = s.numerator / over * (pace.records / under);
    s.denominator = s.denominator / under * (pace.steps / over);
    return s;
}

const char *trial_place(const trials *t, int point) {
    return t->wish.source->name(t->wish.source->context, t->place[point]);
}

double trial_horizon_s(const trials *t) {
    return ratio_times((uint64_t)t->records, t->wish.spacing);
}

const char *trial_unit(const trials *t) {
    return t->what.column < 0 ? "" : t->reference[0]->shape->column[t->what.column].unit->shown;
}

double trial_error_si(const trials *t, double error) {
    if (t->what.column < 0) {
        return error;
    }
    const image_unit *u = t->reference[0]->shape->column[t->what.column].unit;
    return error * u->scale / u->divisor;
}

const char *trial_column(const trials *t, int column, char text[TRIAL_NAME]) {
    const record_column *c = &t->reference[0]->shape->column[column];
    snprintf(text, TRIAL_NAME, "%.80s%.*s", c->name, c->primes, "''''''''");
    return text;
}

/* --- the references --------------------------------------------------------------------------------*/

static void say_no_column(const trials *t) {
    const records *shape = t->reference[0]->shape;
    const char *of = t->wish.of;
    nearest search = nearest_start(of, strlen(of));
    fprintf(stderr, "whirl: error: %s is no output, coordinate or rate of '%s'\n", of,
            shape->image->name);
    char *names = alloc(shape->columns, TRIAL_NAME);
    for (int k = 1; k < shape->columns; k++) {
        char *name = names + (size_t)k * TRIAL_NAME;
        nearest_offer(&search, trial_column(t, k, name));
    }
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean '%s'?\n", search.best);
    }
    free(names);
}

static bool find_column(trials *t) {
    bool noisy;
    t->what.column = -1;
    t->what.give_up = USABLE;
    if (t->wish.of == NULL) {
        return true;
    }
    t->what.column = reference_find(t->reference[0], t->wish.of, &noisy);
    if (t->what.column < 0) {
        say_no_column(t);
        return false;
    }
    if (noisy) {
        fprintf(stderr,
                "whirl: error: %s has noise of its own, which is no error of a step\n"
                "hint: take what it is made of, or --without the effect that adds the noise\n",
                t->wish.of);
        return false;
    }
    return true;
}

/* Limits all points to their common trusted horizon. */
static void cut(trials *t) {
    t->records = t->wish.records;
    t->reliable = true;
    double least = 0.0;
    for (int p = 0; p < t->points; p++) {
        const reference *r = t->reference[p];
        t->reliable = t->reliable && r->kind != REFERENCE_NONE;
        const double agreement = reference_agreement(r);
        if (r->records < t->records || (r->records == t->records && agreement > least)) {
            t->records = r->records;
            t->worst = p;
            least = agreement;
        }
    }
    for (int p = 0; p < t->points; p++) {
        reference_cut(t->reference[p], t->records);
        if (t->reference[p]->kind == REFERENCE_NONE) {
            t->worst = p; /* the point to report */
        }
    }
}

/* Drops the places where nothing moves: no error is a part of anything there. If nothing moves at all, that is the report. */
static void drop_still(trials *t) {
    int kept = 0;
    for (int p = 0; p < t->points; p++) {
        kept += !t->reference[p]->still;
    }
    if (kept == 0 || kept == t->points) {
        return;
    }
    size_t length;
    FILE *out = alloc_text(&t->still, &length);
    const int points = t->points;
    t->points = 0;
    for (int p = 0; p < points; p++) {
        const int to = t->points;
        if (t->reference[p]->still) {
            const char *at = trial_place(t, p);
            fprintf(out, "%s,", at[0] != '\0' ? at : " the scene's own values");
            reference_free(t->reference[p]);
            image_free(t->image[p]);
            continue;
        }
        t->place[to] = t->place[p];
        t->image[to] = t->image[p];
        t->reference[to] = t->reference[p];
        t->points++;
    }
    alloc_text_end(out);
}

bool trial_begin(trials *t, const trial_wish *w) {
    const int points = w->source->points;
    const image_settings standard = IMAGE_SETTINGS_DEFAULT;
    const setting plain = {w->plain != NULL ? *w->plain : standard, &engine_double};
    *t = (trials){.wish = *w,
                  .place = alloc(points, sizeof *t->place),
                  .image = alloc(points, sizeof(image *)),
                  .reference = alloc(points, sizeof(reference *)),
                  .planned = alloc(points, sizeof(trial_planned))};
    for (int p = 0; p < points; p++) {
        t->image[p] = w->source->make(w->source->context, p, &plain, NULL, NULL);
        if (t->image[p] == NULL) {
            return false;
        }
        const reference_wish wish = {.image = t->image[p],
                                     .spacing = w->spacing,
                                     .records = w->records,
                                     .operations = REFERENCE_OPERATIONS / points,
                                     .by = w->by};
        t->reference[p] = reference_new(&wish);
        t->place[p] = p;
        t->points++;
        t->stopped = t->stopped || t->reference[p]->stopped;
        if (p == 0 && !find_column(t)) {
            return false;
        }
    }
    drop_still(t);
    cut(t);
    return true;
}

/* --- images ----------------------------------------------------------------------------------------*/

const char *trial_until(const trials *t, char text[TRIAL_TIME]) {
    snprintf(text, TRIAL_TIME, "%.15g", trial_horizon_s(t));
    return text;
}

/* Of an image and its step in fixed point, if it has one. */
static void drop(image *im) {
    if (im != NULL) {
        fixed_plan_free((fixed_plan *)(uintptr_t)im->fixed);
        image_free(im);
    }
}

/* Makes its step in fixed point; NULL, with the image freed, if it has no such step. Undeclared ranges come from a run in
 * double to the end, which counts as evaluated. */
static image *in_fixed_point(trials *t, image *im) {
    diags *unsaid = diags_new();
    im->fixed = fixed_plan_make(im, false, unsaid);
    diags_free(unsaid);
    t->operations += (double)im->steps * (double)im->list[IMAGE_STEP]->count *
                     wh_methods[im->settings.method].stages;
    if (im->fixed == NULL) {
        drop(im);
        return NULL;
    }
    return im;
}

/* In fixed point an image is first priced and then run: it is stored between the two. */
static image *kept(trials *t, int point, deviation_pace pace) {
    trial_planned *k = &t->planned[point];
    image *im = k->pace.steps == pace.steps && k->pace.records == pace.records ? k->image : NULL;
    k->image = im != NULL ? NULL : k->image;
    return im;
}

static void keep(trials *t, int point, deviation_pace pace, image *im) {
    drop(t->planned[point].image);
    t->planned[point] = (trial_planned){im, pace};
}

static image *make_at(const trials *t, int point, const setting *s, const char *step,
                      const char *until) {
    return t->wish.source->make(t->wish.source->context, t->place[point], s, step, until);
}

static image *image_of(trials *t, int point, const setting *s, deviation_pace pace) {
    char step[TRIAL_TIME];
    char until[TRIAL_TIME];
    trial_time(trial_step(t, pace), step);
    if (!setting_is_fixed(s)) {
        const whole_ratio spacing = t->wish.spacing;
        snprintf(until, sizeof until, "%.17g", ratio_times((uint64_t)t->wish.records, spacing));
        return make_at(t, point, s, step, until);
    }
    image *im = kept(t, point, pace);
    if (im == NULL) {
        im = make_at(t, point, s, step, trial_until(t, until));
        im = im != NULL ? in_fixed_point(t, im) : NULL;
    }
    return im;
}

void trial_end(trials *t) {
    for (int p = 0; t->image != NULL && p < t->points; p++) {
        reference_free(t->reference[p]);
        image_free(t->image[p]);
        drop(t->planned[p].image);
    }
    free(t->place);
    free(t->still);
    free(t->reference);
    free(t->image);
    free(t->planned);
}

/* --- trials ----------------------------------------------------------------------------------------*/

static void enter(int point, const deviation *d, trial_result *worst) {
    const bool bound = d->error < 3.0 * d->known;
    const double error = bound ? d->error + d->known : d->error;
    const bool first = point == 0;
    worst->evaluations = number_most(worst->evaluations, d->evaluations);
    worst->evaluations_most = number_most(worst->evaluations_most, d->evaluations_most);
    worst->usable = (first || worst->usable) && d->usable;
    if (first || !(error <= worst->error)) {
        worst->error = error;
        worst->bound = bound;
        worst->point = point;
        worst->column = d->column;
    }
}

trial_result trial_run(trials *t, const setting *s, deviation_pace pace) {
    trial_result worst = {.ran = true};
    for (int p = 0; p < t->points; p++) {
        image *im = image_of(t, p, s, pace);
        if (im == NULL) {
            return (trial_result){.ran = false};
        }
        deviation_of_what what = t->what;
        if (what.column >= 0) { /* in its own unit */
            what.give_up = number_most(
                t->tolerated, USABLE * (double)t->reference[p]->column[what.column].largest);
        }
        const deviation d = deviation_measure(t->reference[p], im, s->number, pace, what);
        drop(im);
        t->operations += d.operations;
        if (interrupted) {
            t->stopped = true;
            return (trial_result){.ran = false};
        }
        enter(p, &d, &worst);
        if (!worst.usable) {
            break;
        }
    }
    return worst;
}

double trial_operations(const trials *t, const setting *s, deviation_pace pace) {
    const double steps = (double)t->records * (double)pace.steps / (double)pace.records;
    const double each = (double)t->image[0]->list[IMAGE_STEP]->count + 1.0;
    const double runs = setting_is_fixed(s) ? 2.0 : 1.0; /* one for the ranges */
    return runs * steps * each * wh_methods[s->image.method].stages * t->points;
}

static cost price_of(const trials *t, const setting *s, const image *im) {
    image priced = *im;
    priced.contacts = t->without_events ? 0 : im->contacts;
    return cost_of(&priced, t->wish.board, setting_cost_number(s));
}

static image *priced_image(trials *t, int point, const setting *s, deviation_pace pace) {
    char step[TRIAL_TIME];
    const trial_wish *w = &t->wish;
    return w->priced_step.numerator == 0 || setting_price_varies(s)
               ? image_of(t, point, s, pace)
               : make_at(t, point, s, trial_time(w->priced_step, step), NULL);
}

cost trial_cost(trials *t, const setting *s, deviation_pace pace, bool *own) {
    cost dearest = {0};
    *own = true;
    for (int p = 0; p < t->points; p++) {
        image *im = priced_image(t, p, s, pace);
        if (im == NULL && setting_price_varies(s) &&
            !setting_is_fixed(s)) { /* a step that long has no matrix: its own may */
            im = make_at(t, p, s, NULL, NULL);
        }
        if (im == NULL) {
            *own = !setting_may_be_refused(&s->image) && !setting_is_fixed(s);
            return (cost){.why = "there is no image of it"};
        }
        *own = *own && setting_is_own(s, im);
        const cost c = *own ? price_of(t, s, im) : (cost){.why = ""};
        if (setting_is_fixed(s)) {
            keep(t, p, pace, im);
        } else {
            drop(im);
        }
        if (p == 0 || c.instructions_worst.most > dearest.instructions_worst.most) {
            dearest = c;
        }
    }
    return dearest;
}

/* Undeclared ranges take a run in double to the end. */
bool trial_is_slow_to_plan(const trials *t, const setting *s, deviation_pace pace) {
    return setting_is_fixed(s) && t->planned_most > 0.0 &&
           trial_operations(t, s, pace) > t->planned_most;
}

cost trial_any_cost(trials *t, const setting *s, deviation_pace pace, bool *own) {
    if (trial_is_slow_to_plan(t, s, pace)) {
        *own = true;
        return (cost){.why = "its ranges take too long to look for: raise --effort"};
    }
    cost c = trial_cost(t, s, pace, own);
    for (int i = 0;
         i < FINER_MOST && setting_is_fixed(s) && !*own && !trial_is_slow_to_plan(t, s, pace);
         i++) {
        if (pace.records % 10U == 0) {
            pace.records /= 10U;
        } else {
            pace.steps *= 10U;
        }
        c = trial_cost(t, s, pace, own);
    }
    return c;
}
