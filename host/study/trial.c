#include "host/study/trial.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/image/image.h"
#include "host/number/functions.h"
#include "host/os/system.h"

/* === settings ================================================================================= */

/* Number types. In generated C, the compiler's options choose float or double. */
static const struct {
    const char *word;
    const char *run;    /* additional options of `whirl run` */
    const char *derive; /* options that `whirl derive` and `whirl run` share */
    const char *form;   /* options of `whirl derive` only */
    const engine_kind *kind;
    bool compensated;
} numbers[] = {{"float", " --number float", "", "", &engine_float, false},
               {"float compensated", " --number float", " --compensated", "", &engine_float, true},
               {"double", "", "", "", &engine_double, false},
               {"fixed", " --number fixed", "", " --number fixed", &engine_fixed, false}};
static_assert(sizeof numbers / sizeof numbers[0] == SETTING_NUMBERS, "a row for each number");

int setting_number(const setting *s) {
    int i = 0;
    while (i < SETTING_NUMBERS - 1 &&
           (numbers[i].kind != s->number || numbers[i].compensated != s->image.compensated)) {
        i++;
    }
    return i;
}

/* Each form of table has three rows: the default number of cells (cells = 0), fewer cells, and more cells. */
static const struct {
    const char *word;
    const char *options;
    image_tables form;
    int cells;
} tables[] = {{"none", "", TABLES_NONE, 0},
              {"linear", " --tables linear", TABLES_LINEAR, 0},
              {"linear 64", " --tables linear --cells 64", TABLES_LINEAR, 64},
              {"linear 1024", " --tables linear --cells 1024", TABLES_LINEAR, 1024},
              {"cubic", " --tables cubic", TABLES_CUBIC, 0},
              {"cubic 32", " --tables cubic --cells 32", TABLES_CUBIC, 32},
              {"cubic 256", " --tables cubic --cells 256", TABLES_CUBIC, 256}};
enum { TABLES = sizeof tables / sizeof tables[0] };

static int tables_of(const setting *s) {
    int i = 0;
    while (i < TABLES - 1 &&
           (tables[i].form != s->image.tables || tables[i].cells != s->image.cells)) {
        i++;
    }
    return i;
}

static bool has_matrix(const setting *s) { return s->image.matrix != MATRIX_NONE; }

/* An axis has `count` rows of `size` bytes. The first member of each row is its word. */
static const struct {
    const char *heading;
    const void *rows;
    size_t size;
    int count;
} axes[AXES] = {
    [AXIS_METHOD] = {"method", wh_methods, sizeof wh_methods[0], WH_METHODS},
    [AXIS_NUMBER] = {"number", numbers, sizeof numbers[0], SETTING_NUMBERS},
    [AXIS_ANGLES] = {"angles", image_angles_words, sizeof image_angles_words[0], IMAGE_ANGLES},
    [AXIS_MATRIX] = {"matrix", image_matrix_words, sizeof image_matrix_words[0], IMAGE_MATRICES},
    [AXIS_TABLES] = {"tables", tables, sizeof tables[0], TABLES}};

/* The index of a setting's word. */
static int word_of(const setting *s, setting_axis axis) {
    switch (axis) {
    case AXIS_METHOD: return (int)s->image.method;
    case AXIS_NUMBER: return setting_number(s);
    case AXIS_ANGLES: return (int)s->image.angles;
    case AXIS_MATRIX: return (int)s->image.matrix;
    case AXIS_TABLES: return tables_of(s);
    case AXES: break;
    }
    return 0;
}

const char *setting_heading(setting_axis axis) { return axes[axis].heading; }

const char *setting_word(const setting *s, setting_axis axis) {
    const char *rows = axes[axis].rows;
    const char *const *word = (const void *)(rows + (size_t)word_of(s, axis) * axes[axis].size);
    return *word;
}

static setting combination(int i) {
    int word[AXES];
    for (int axis = AXES - 1; axis >= 0; axis--) {
        word[axis] = i % axes[axis].count;
        i /= axes[axis].count;
    }
    setting s = {IMAGE_SETTINGS_DEFAULT, numbers[word[AXIS_NUMBER]].kind};
    s.image.method = (wh_method)word[AXIS_METHOD];
    s.image.compensated = numbers[word[AXIS_NUMBER]].compensated;
    s.image.angles = (image_angles)word[AXIS_ANGLES];
    s.image.matrix = (image_matrix_of)word[AXIS_MATRIX];
    s.image.tables = tables[word[AXIS_TABLES]].form;
    s.image.cells = tables[word[AXIS_TABLES]].cells;
    return s;
}

bool setting_is_fixed(const setting *s) { return s->number == &engine_fixed; }

/* Fixed point has one method, and one way to compute sines (host/fixed). */
static bool makes_sense(const setting *s) {
    const bool plain = s->image.angles == ANGLES_TURNED;
    if (setting_is_fixed(s)) {
        return s->image.method == WH_RK4 && plain && !has_matrix(s) &&
               s->image.tables == TABLES_NONE;
    }
    if (has_matrix(s)) {
        return s->image.method == WH_METHOD_DEFAULT && plain && s->image.tables == TABLES_NONE;
    }
    return s->image.tables == TABLES_NONE || plain;
}

int setting_count(void) {
    int combinations = 1;
    int count = 0;
    for (int axis = 0; axis < AXES; axis++) {
        combinations *= axes[axis].count;
    }
    for (int i = 0; i < combinations; i++) {
        const setting s = combination(i);
        count += makes_sense(&s) ? 1 : 0;
    }
    return count;
}

setting setting_at(int i) {
    for (int k = 0;; k++) {
        const setting s = combination(k);
        if (makes_sense(&s) && i-- == 0) {
            return s;
        }
    }
}

/* Does not use `numbers`, because `numbers` has no row for compensated sums in double. */
cost_number setting_cost_number(const setting *s) {
    return setting_is_fixed(s)           ? COST_FIXED
           : s->number == &engine_double ? COST_DOUBLE
                                         : COST_FLOAT;
}

bool setting_is_asked(const setting *s, const bool method[WH_METHODS]) {
    const wh_method m = s->image.method;
    return method != NULL
               ? method[m]
               : m == WH_RK4 || m == WH_NYSTROEM3 || m == WH_NYSTROEM4 || m == WH_NYSTROEM5;
}

int setting_order(const setting *s) {
    int order = 0;
    for (int axis = 0; axis < AXES; axis++) {
        order = order * axes[axis].count + word_of(s, (setting_axis)axis);
    }
    return order;
}

bool setting_may_be_refused(const image_settings *s) {
    return s->matrix != MATRIX_NONE || s->tables != TABLES_NONE;
}

bool setting_price_varies(const setting *s) { return has_matrix(s) || setting_is_fixed(s); }

const char *setting_form(const setting *s) { return numbers[setting_number(s)].form; }

bool setting_is_own(const setting *s, const image *im) {
    image turned = *im;
    turned.settings.angles = ANGLES_TURNED;
    return cost_takes_method(im) && (setting_may_be_refused(&s->image) ||
                                     s->image.angles == ANGLES_TURNED || image_turns(&turned));
}

const char *setting_options(const setting *s, bool with_number, char text[SETTING_TEXT]) {
    const bool looked_up = s->image.angles != ANGLES_TURNED;
    const int number = setting_number(s);
    snprintf(text, SETTING_TEXT, "%s%s%s%s%s%s%s%s%s", has_matrix(s) ? "" : " --method ",
             has_matrix(s) ? "" : setting_word(s, AXIS_METHOD),
             with_number ? numbers[number].run : "", numbers[number].derive,
             looked_up ? " --angles " : "", looked_up ? setting_word(s, AXIS_ANGLES) : "",
             has_matrix(s) ? " --matrix " : "", has_matrix(s) ? setting_word(s, AXIS_MATRIX) : "",
             tables[tables_of(s)].options);
    return text;
}

/* === trials =================================================================================== */

#define REFERENCE_OPERATIONS 6e8 /* limit on the operations of the finest runs of all references */
#define SURELY 10.0 /* smaller errors, relative to the reference's error, are upper bounds */
#define USABLE 1.0  /* largest usable error, relative to the quantity's largest value */

whole_ratio trial_step(const trials *t, deviation_pace pace) {
    whole_ratio s = t->request.spacing;
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

const char *trial_step_text(const trials *t, deviation_pace pace, char text[NUMBER_SIZE]) {
    return number_shortest(ratio_times(1, trial_step(t, pace)), text);
}

const char *trial_place(const trials *t, int point) {
    return t->request.source->name(t->request.source->context, t->place[point]);
}

double trial_horizon_s(const trials *t) {
    return ratio_times((uint64_t)t->records, t->request.spacing);
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
    const char *of = t->request.of;
    nearest search = nearest_start(of, strlen(of));
    fprintf(stderr, "whirl: error: %s is not an output, coordinate or rate of '%s'\n", of,
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
    if (t->request.of == NULL) {
        return true;
    }
    t->what.column = reference_find(t->reference[0], t->request.of, &noisy);
    if (t->what.column < 0) {
        say_no_column(t);
        return false;
    }
    if (noisy) {
        fprintf(stderr,
                "whirl: error: %s has noise, which would count as an error of the step\n"
                "hint: choose a quantity without noise, or leave out the noise: --without EFFECT\n",
                t->request.of);
        return false;
    }
    return true;
}

/* Limits all points to their common trusted horizon. */
static void cut(trials *t) {
    t->records = t->request.records;
    t->reliable = true;
    double least = 0.0;
    for (int p = 0; p < t->points; p++) {
        const reference *r = t->reference[p];
        t->reliable = t->reliable && r->reliable;
        const double agreement = reference_agreement(r, t->what.column);
        if (r->records < t->records || (r->records == t->records && agreement > least)) {
            t->records = r->records;
            t->worst = p;
            least = agreement;
        }
    }
    for (int p = 0; p < t->points; p++) {
        reference_cut(t->reference[p], t->records);
        if (!t->reference[p]->reliable) {
            t->worst = p; /* the output names this point */
        }
    }
}

/* Drops the points at which nothing moves. If nothing moves at any point, all stay. */
static void drop_still(trials *t) {
    int kept = 0;
    for (int p = 0; p < t->points; p++) {
        kept += !t->reference[p]->still;
    }
    if (kept == 0 || kept == t->points) {
        return;
    }
    FILE *out = alloc_text(&t->still, NULL);
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

bool trial_begin(trials *t, const trial_request *w) {
    const int points = w->source->points;
    const image_settings standard = IMAGE_SETTINGS_DEFAULT;
    const setting plain = {w->plain != NULL ? *w->plain : standard, &engine_double};
    *t = (trials){.request = *w,
                  .place = alloc(points, sizeof *t->place),
                  .image = alloc(points, sizeof(image *)),
                  .reference = alloc(points, sizeof(reference *))};
    for (int p = 0; p < points; p++) {
        t->image[p] = w->source->make(w->source->context, p, &plain, NULL, NULL);
        if (t->image[p] == NULL) {
            return false;
        }
        const reference_request request = {.image = t->image[p],
                                           .spacing = w->spacing,
                                           .records = w->records,
                                           .operations = REFERENCE_OPERATIONS / points,
                                           .by = w->by};
        t->reference[p] = reference_new(&request);
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

const char *trial_until(const trials *t, char text[NUMBER_SIZE]) {
    return number_shortest(trial_horizon_s(t), text);
}

/* Frees an image and its step in fixed point, if it has one. */
static void drop(image *im) {
    if (im != NULL) {
        fixed_plan_free((fixed_plan *)(uintptr_t)im->fixed);
        image_free(im);
    }
}

static image *image_of(const trials *t, int point, const setting *s, deviation_pace pace) {
    char step[NUMBER_SIZE];
    char until[NUMBER_SIZE];
    const trial_request *w = &t->request;
    const bool fixed = setting_is_fixed(s);
    trial_step_text(t, pace, step);
    if (fixed) {
        trial_until(t, until);
    } else {
        snprintf(until, sizeof until, "%.17g", ratio_times((uint64_t)w->records, w->spacing));
    }
    image *im = w->source->make(w->source->context, t->place[point], s, step, until);
    if (im != NULL && fixed) { /* a full run finds the ranges that are not declared */
        diags *unsaid = diags_new();
        im->fixed = fixed_plan_make(im, false, unsaid);
        diags_free(unsaid);
        if (im->fixed == NULL) { /* no step in fixed point is possible */
            image_free(im);
            im = NULL;
        }
    }
    return im;
}

void trial_end(trials *t) {
    for (int p = 0; t->image != NULL && p < t->points; p++) {
        reference_free(t->reference[p]);
        image_free(t->image[p]);
    }
    free(t->place);
    free(t->still);
    free(t->reference);
    free(t->image);
}

/* --- trials ----------------------------------------------------------------------------------------*/

static void enter(int point, const deviation *d, trial_result *worst) {
    const bool bound = d->error < SURELY * d->known;
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
        if (what.column >= 0) {
            what.give_up =
                number_most(t->tolerated, USABLE * t->reference[p]->column[what.column].largest);
        }
        const deviation d = deviation_measure(t->reference[p], im, s->number, pace, what);
        drop(im);
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
    const double runs = setting_is_fixed(s) ? 2.0 : 1.0; /* a first run finds the ranges */
    return runs * steps * each * wh_methods[s->image.method].stages * t->points;
}

cost trial_cost(const trials *t, const setting *s, deviation_pace pace, bool *own) {
    cost dearest = {0};
    *own = true;
    for (int p = 0; p < t->points; p++) {
        image *im = image_of(t, p, s, pace);
        if (im == NULL) {
            *own = !setting_may_be_refused(&s->image) && !setting_is_fixed(s);
            return (cost){.why = "it cannot be derived"};
        }
        *own = *own && setting_is_own(s, im);
        image priced = *im;
        priced.contacts = t->without_events ? 0 : im->contacts;
        const cost c =
            *own ? cost_of(&priced, t->request.board, setting_cost_number(s)) : (cost){.why = ""};
        drop(im);
        if (p == 0 || c.instructions_worst.most > dearest.instructions_worst.most) {
            dearest = c;
        }
    }
    return dearest;
}
