/* remedy.c: see remedy.h. */
#include "remedy.h"

#include <stdio.h>

#include "host/number/functions.h"
#include "step_text.h"

/* What a cure leaves over, of the largest entry: well below what is warned of. */
#define CURED 3e-5
/* Where the motion as it should have been is not known, so much less. */
#define SATURATED_LEAVES 0.1
/* So many times as many steps are no advice: by theory, and where they were tried. */
#define STEPS_MORE 200.0
#define STEPS_MORE_TRIED 20000.0
/* So many times as many as another method's stages come to are named behind that method. */
#define STEPS_DEAR 5.0
/* Is there any at all? So many times as many tell, a quarter of them, and so on, what is at most this share of all trials. */
#define PARTS_TELL 1024
#define PARTS_TELL_LEAST 16
#define SHARE_TELLS 0.1
/* So many times as many in float are to be compensated. */
#define FLOAT_MORE 10.0

/* A proposal and what became of it. */
typedef struct remedy {
    cure_wish what;
    cure_outcome outcome;
} remedy;

static const remedy none = {.outcome = CURE_DOES_NOT};

static bool is_crude(wh_method method) {
    return wh_methods[method].order < wh_methods[WH_METHOD_DEFAULT].order;
}

/* So many small steps round a float's sums away, unless they are compensated. */
static cure_wish compensated_if_fine(const judged *j, cure_wish what) {
    const bool rounds = j->kind == &engine_float && what.step_s * FLOAT_MORE <= j->watch->step_s;
    what.compensated = what.compensated || rounds;
    return what;
}

/* Where nothing but a float's digits is in its way, in double. */
static cure_outcome try_either(const judged *j, cures *c, cure_wish *what) {
    cure_outcome outcome = cure_try(c, what);
    if (outcome == CURE_ROUNDS && j->kind == &engine_float) {
        cure_wish more = *what;
        more.in_double = true;
        more.compensated = j->image->settings.compensated;
        outcome = cure_try(c, &more);
        *what = outcome == CURE_DOES ? more : *what;
    }
    return outcome == CURE_ROUNDS ? CURE_DOES_NOT : outcome;
}

static const char *number_text(const remedy *r) {
    return r->what.in_double ? " --number double" : "";
}

/* From this one on down; where trying ends, the next one untried, unless it is too fine to be believed so. A first one that was
 * seen to do something is believed. */
static remedy finer_until_it_does(const judged *j, cures *c, cure_wish first, bool seen) {
    remedy r = {.what = first};
    while (r.what.step_s * STEPS_MORE_TRIED > j->watch->step_s) {
        r.what = seen ? compensated_if_fine(j, r.what) : r.what;
        r.outcome = try_either(j, c, &r.what);
        if (r.outcome == CURE_DOES) {
            return r;
        }
        if (r.outcome == CURE_NOT_TRIED) {
            const bool believed = r.what.step_s * STEPS_MORE > j->watch->step_s ||
                                  (seen && r.what.step_s >= first.step_s);
            return believed ? r : none;
        }
        r.what.step_s = linearised_nice_s(0.7 * r.what.step_s);
    }
    return none;
}

static cure_wish own_cure(const judged *j, wh_method method, double step_s) {
    return (cure_wish){
        .method = method, .step_s = step_s, .compensated = j->image->settings.compensated};
}

/* The cheapest other method of a higher order that takes this system and leaves little at the same step, but for those
 * in `without`; -1: none. */
static int method_by_theory(judged *j, double allowed, unsigned without) {
    const linearised *l = judged_motions(j);
    const wh_method own = judged_method(j->image);
    int found = -1;
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_method_row *row = &wh_methods[m];
        if (row->order <= wh_methods[own].order || row->takes == WH_NO_RATES ||
            (without & (1U << m)) != 0 || !wh_method_takes((wh_method)m, l->form) ||
            (found >= 0 && row->stages >= wh_methods[found].stages)) {
            continue;
        }
        if (linearised_off(l, (wh_method)m, l->step_s) <= allowed) {
            found = m;
        }
    }
    return found;
}

static remedy by_method(judged *j, cures *c, double allowed) {
    unsigned failed = 0;
    for (int m; (m = method_by_theory(j, allowed, failed)) >= 0; failed |= 1U << m) {
        remedy r = {.what = own_cure(j, (wh_method)m, j->image->step_s)};
        r.outcome = try_either(j, c, &r.what);
        if (r.outcome != CURE_DOES_NOT) {
            return r;
        }
    }
    return none;
}

/* Of this method. Where the theory has no step, and trying it is all that is left, from half of the run's on. */
static remedy by_step(judged *j, cures *c, wh_method method, double most_s, double allowed) {
    const double step_s = linearised_step_s(judged_motions(j), method, most_s, allowed);
    if (step_s > 0.0) {
        return finer_until_it_does(j, c, own_cure(j, method, step_s), false);
    }
    const cure_wish half = own_cure(j, method, linearised_nice_s(0.5 * j->watch->step_s));
    const remedy r = is_crude(method) ? none : finer_until_it_does(j, c, half, false);
    return r.outcome == CURE_DOES ? r : none;
}

/* "--step 50us --compensated" */
static void options_text(const judged *j, const remedy *r, char *text, size_t size) {
    char step[STEP_WORD];
    snprintf(text, size, "--step %s%s%s", step_text(r->what.step_s, step),
             r->what.compensated && !j->image->settings.compensated ? " --compensated" : "",
             number_text(r));
}

static bool is_some(const remedy *r) { return r->outcome != CURE_DOES_NOT; }

static const char *would_do(const remedy *r) {
    return r->outcome == CURE_DOES ? "would do" : "should do (not tried: that takes long)";
}

/* By evaluations: a method with more stages against more steps, of which some are to be had for the name's sake. */
static bool is_cheaper(const judged *j, const remedy *method, const remedy *step) {
    const double more_stages = (double)wh_methods[method->what.method].stages /
                               (double)wh_methods[judged_method(j->image)].stages;
    return STEPS_DEAR * more_stages * step->what.step_s < j->watch->step_s;
}

bool remedy_text(judged *j, cures *c, double most_s, bool saturated, char text[REMEDY_TEXT]) {
    const double allowed = saturated ? SATURATED_LEAVES * CURED : CURED;
    const wh_method own = judged_method(j->image);
    const remedy method = by_method(j, c, allowed);
    const remedy step = by_step(j, c, own, most_s, allowed);
    const bool usual = is_crude(own) && !is_some(&method) && !is_some(&step);
    char word[STEP_WORD];
    text[0] = '\0';
    const bool both = is_some(&step) && is_some(&method);
    if (both && method.outcome == CURE_DOES && is_cheaper(j, &method, &step)) {
        const int length = snprintf(text, REMEDY_TEXT, "--method %s%s would do, or --step %s%s",
                                    wh_methods[method.what.method].word, number_text(&method),
                                    step_text(step.what.step_s, word), number_text(&step));
        snprintf(text + length, (size_t)(REMEDY_TEXT - length), "%s",
                 step.outcome == CURE_DOES ? "" : " (not tried)");
    } else if (is_some(&step)) {
        const int length =
            snprintf(text, REMEDY_TEXT, "--step %s%s %s", step_text(step.what.step_s, word),
                     number_text(&step), would_do(&step));
        if (is_some(&method)) {
            snprintf(text + length, (size_t)(REMEDY_TEXT - length), ", or --method %s%s%s",
                     wh_methods[method.what.method].word, number_text(&method),
                     method.outcome == CURE_DOES ? "" : " (not tried)");
        }
    } else if (is_some(&method)) {
        snprintf(text, REMEDY_TEXT, "--method %s%s %s", wh_methods[method.what.method].word,
                 number_text(&method), would_do(&method));
    } else if (usual) {
        const remedy r = by_step(j, c, WH_METHOD_DEFAULT, 0.5 * j->watch->step_s, allowed);
        if (is_some(&r)) {
            snprintf(text, REMEDY_TEXT, "--method %s --step %s%s %s",
                     wh_methods[WH_METHOD_DEFAULT].word, step_text(r.what.step_s, word),
                     number_text(&r), would_do(&r));
        }
    }
    return text[0] != '\0';
}

bool remedy_is_double(const judged *j, cures *c) {
    cure_wish what = own_cure(j, judged_method(j->image), j->image->step_s);
    what.in_double = true;
    return j->kind == &engine_float && cure_try(c, &what) == CURE_DOES;
}

cure_outcome remedy_from(const judged *j, cures *c, double step_s, char text[REMEDY_TEXT]) {
    const cure_wish first = own_cure(j, judged_method(j->image), step_s);
    const remedy r = finer_until_it_does(j, c, first, false);
    options_text(j, &r, text, REMEDY_TEXT);
    return r.outcome;
}

cure_outcome remedy_finer(const judged *j, cures *c, char text[REMEDY_TEXT]) {
    const cure_wish half =
        own_cure(j, judged_method(j->image), linearised_nice_s(0.5 * j->watch->step_s));
    const remedy r = finer_until_it_does(j, c, half, true);
    options_text(j, &r, text, REMEDY_TEXT);
    return r.outcome;
}

bool remedy_goes_through(const judged *j, cures *c) {
    for (int parts = PARTS_TELL; parts >= PARTS_TELL_LEAST; parts /= 4) {
        const double step_s = linearised_nice_s(j->watch->step_s / parts);
        const cure_wish what = compensated_if_fine(j, own_cure(j, judged_method(j->image), step_s));
        if (cure_share(c, &what) <= SHARE_TELLS) {
            return cure_try(c, &what) == CURE_NOT_TRIED || c->ended;
        }
    }
    return true;
}

double remedy_step_by_order_s(const judged *j, double ratio) {
    const double order = wh_methods[judged_method(j->image)].order;
    return j->watch->step_s *
           number_power(CURED / number_most(number_least(ratio, 1.0), CURED), 1.0 / order);
}

/* --- of a close look ---------------------------------------------------------------------------------------*/

/* A step of this method that resolves what a look found some of Runge-Kutta 4 to resolve. */
static double step_by_look_s(const judged *j, const watch_look *l) {
    const double order = wh_methods[judged_method(j->image)].order;
    const double parts = j->watch->step_s / l->fine_step_s;
    return j->watch->step_s / number_power(parts, order < 4.0 ? 4.0 / order : 1.0);
}

/* A crude method that would take too many steps has none, but the one that resolved it has. */
cure_outcome remedy_of_look(const judged *j, cures *c, const watch_look *look,
                            char text[REMEDY_TEXT]) {
    const wh_method own = judged_method(j->image);
    const double own_s = linearised_nice_s(step_by_look_s(j, look));
    const bool other = is_crude(own) && !(own_s * STEPS_MORE > j->watch->step_s);
    cure_wish what = own_cure(j, other ? WH_METHOD_DEFAULT : own,
                              other ? linearised_nice_s(look->fine_step_s) : own_s);
    what = compensated_if_fine(j, what);
    remedy r = finer_until_it_does(j, c, what, true);
    if (!is_some(&r)) {
        r.what = what;
    }
    const int length =
        other ? snprintf(text, REMEDY_TEXT, "--method %s ", wh_methods[WH_METHOD_DEFAULT].word) : 0;
    options_text(j, &r, text + length, (size_t)(REMEDY_TEXT - length));
    return r.outcome;
}
