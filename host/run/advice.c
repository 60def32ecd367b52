/* advice.c: see advice.h. */
#include "advice.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"
#include "step_text.h"
#include "swing.h"

/* What a cure leaves over, of the largest entry: well below what is warned of. */
#define CURED 3e-5
/* Off by more than this in a few steps is not resolved (watch.h says of what). */
#define NOT_RESOLVED 3e-3
/* A motion is the cause where what it has lost is at least this part of what is missing. */
#define IS_CAUSE 0.1
/* And all of it, where there is nothing else to expect: at least this part. */
#define IS_ALL 0.3
/* Where so much is missing, or all bounds were left, nothing is known of the motion as it should have been: a cure is to
 * leave so much less. */
#define SATURATED 0.3
#define SATURATED_LEAVES 0.1
/* Of a system's swing: its part of what moves, and of that what is lost. */
#define SWING_SHARE 0.01
#define SWING_LOST 0.01
/* Of the range, where it varies. */
#define SWING_OFF 0.01
/* So many times as many steps are no advice. */
#define STEPS_MORE 200.0
/* So many times as many in float are to be compensated. */
#define FLOAT_MORE 10.0

enum { STEP_TEXT = 80, CARRIED_TEXT = 240, CURE_TEXT = 160, DONE_TEXT = 80 };

advice advice_of(const image *im, const engine_kind *kind, const watch *w, const belief *balance) {
    return (advice){.image = im, .kind = kind, .watch = w, .balance = balance};
}

void advice_end(advice *a) {
    linearised_free(a->motions);
    a->motions = NULL;
}

static wh_method method_of(const image *im) {
    return im->settings.matrix == MATRIX_RK4 ? WH_RK4 : im->settings.method;
}

static const char *title_of(const image *im) { return wh_methods[method_of(im)].title; }

static const linearised *motions_of(advice *a) {
    if (a->motions == NULL) {
        a->motions = linearised_of(a->watch, method_of(a->image));
    }
    return a->motions;
}

/* --- words -----------------------------------------------------------------------------------------------*/

/* Who carries a motion, how fast it is and what that is in steps. */
static const char *carried_text(const advice *a, const linear_motion *m, char text[CARRIED_TEXT]) {
    const double size = complex_size(m->value);
    const bool swings = fabs(m->value.im) > 0.1 * size;
    const char *second = m->unknown[1] >= 0 ? a->image->unknown[m->unknown[1]].name : "";
    char much[100];
    if (swings) {
        snprintf(much, sizeof much, "%.3g rad/s (a period of %.3g s), h w = %.3g", size,
                 6.283185307179586 / fabs(m->value.im), size * a->watch->step_s);
    } else {
        snprintf(much, sizeof much, "a time constant of %.3g s, h/tau = %.3g", 1.0 / size,
                 size * a->watch->step_s);
    }
    snprintf(text, CARRIED_TEXT, "'%.60s'%s%.60s%s about t = %.6g s: %s",
             a->image->unknown[m->unknown[0]].name, second[0] != '\0' ? " and '" : "", second,
             second[0] != '\0' ? "'" : "", m->time_s, much);
    return text;
}

/* What the method makes of it in a run. */
static const char *done_text(const linearised *l, const linear_motion *m, char text[DONE_TEXT]) {
    const double twice = (1.0 + m->off) * (1.0 + m->off) - 1.0;
    if (m->ripple > 0.0) {
        snprintf(text, DONE_TEXT, "lets its energy go %.3g %% up and down",
                 100.0 * number_least(m->ripple, 1.0));
    } else if (limits_growth(l->method, l->form, linearised_as(m), l->step_s) <=
               limits_exact(m->value, l->step_s)) {
        const double left = 1.0 - number_least(m->off, 1.0);
        snprintf(text, DONE_TEXT, "takes %.3g %% of its energy over the run",
                 100.0 * (1.0 - left * left));
    } else if (twice < 1.0) {
        snprintf(text, DONE_TEXT, "adds %.3g %% to its energy over the run", 100.0 * twice);
    } else {
        snprintf(text, DONE_TEXT, "adds %.3g times its energy over the run", twice);
    }
    return text;
}

/* --- what would do ------------------------------------------------------------------------------------------*/

/* The cheapest other method of a higher order that takes this system and leaves little at the same step; -1: none. */
static int method_that_would_do(advice *a, double allowed) {
    const linearised *l = motions_of(a);
    const wh_method own = method_of(a->image);
    int found = -1;
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_method_row *row = &wh_methods[m];
        if (row->order <= wh_methods[own].order || row->takes == WH_NO_RATES ||
            !wh_method_takes((wh_method)m, l->form) ||
            (found >= 0 && row->stages >= wh_methods[found].stages)) {
            continue;
        }
        if (linearised_off(l, (wh_method)m, l->step_s) <= allowed) {
            found = m;
        }
    }
    return found;
}

/* The step at which the rest is as small as the method's order makes it from `ratio`. */
static double step_by_order_s(const advice *a, double ratio) {
    const double order = wh_methods[method_of(a->image)].order;
    return a->watch->step_s *
           number_power(CURED / number_most(number_least(ratio, 1.0), CURED), 1.0 / order);
}

/* A step of this method that resolves what a look found some of Runge-Kutta 4 to resolve. */
static double step_by_look_s(const advice *a, const watch_look *l) {
    const double order = wh_methods[method_of(a->image)].order;
    const double parts = a->watch->step_s / l->fine_step_s;
    return a->watch->step_s / number_power(parts, order < 4.0 ? 4.0 / order : 1.0);
}

/* What would do, as options; false where nothing is known that would. A step that is not beyond `most_s`: where it is so
 * small that a better method has more of it, that one is named with its own. */
static bool would_do(advice *a, double most_s, bool saturated, char text[CURE_TEXT]) {
    const double allowed = saturated ? SATURATED_LEAVES * CURED : CURED;
    const linearised *l = motions_of(a);
    const bool crude = wh_methods[l->method].order < wh_methods[WH_METHOD_DEFAULT].order;
    const int method = method_that_would_do(a, allowed);
    const double own_s = linearised_step_s(l, l->method, most_s, allowed);
    const double usual_s =
        crude ? linearised_step_s(l, WH_METHOD_DEFAULT, 0.5 * l->step_s, allowed) : 0.0;
    char step[STEP_TEXT];
    text[0] = '\0';
    if (own_s * STEPS_MORE > l->step_s && method >= 0) {
        snprintf(text, CURE_TEXT, "--step %s would do, or --method %s", step_text(own_s, step),
                 wh_methods[method].word);
    } else if (own_s * STEPS_MORE > l->step_s) {
        snprintf(text, CURE_TEXT, "--step %s would do", step_text(own_s, step));
    } else if (method >= 0) {
        snprintf(text, CURE_TEXT, "--method %s would do", wh_methods[method].word);
    } else if (usual_s > 0.0) {
        snprintf(text, CURE_TEXT, "--method %s --step %s would do",
                 wh_methods[WH_METHOD_DEFAULT].word, step_text(usual_s, step));
    }
    return text[0] != '\0';
}

/* Options with which what was looked at is resolved: so many small steps round a float's sums away, unless they are
 * compensated; and a crude method that would take too many of them has none, but the one that resolved it has. */
static const char *options_text(const advice *a, const watch_look *look, char text[STEP_TEXT]) {
    const wh_method own = method_of(a->image);
    const double own_s = linearised_nice_s(step_by_look_s(a, look));
    const bool crude = wh_methods[own].order < wh_methods[WH_METHOD_DEFAULT].order &&
                       !(own_s * STEPS_MORE > a->watch->step_s);
    const double step_s = crude ? linearised_nice_s(look->fine_step_s) : own_s;
    const bool rounds = a->kind == &engine_float && !a->image->settings.compensated &&
                        step_s * FLOAT_MORE <= a->watch->step_s;
    char step[STEP_WORD];
    step_text(step_s, step);
    snprintf(text, STEP_TEXT, "%s%s%s--step %s%s", crude ? "--method " : "",
             crude ? wh_methods[WH_METHOD_DEFAULT].word : "", crude ? " " : "", step,
             rounds ? " --compensated" : "");
    return text;
}

bool advice_singular(const advice *a) {
    return a->watch->singular.done && a->watch->singular.off >= NOT_RESOLVED;
}

/* --- the energy ----------------------------------------------------------------------------------------------*/

static bool on_the_way(const advice *a) {
    const belief *b = a->balance;
    return b->known && a->watch->balanced && !b->exact &&
           a->watch->most_J > ADVICE_ON_THE_WAY * b->largest_J && a->watch->most_J > b->rounding_J;
}

bool advice_lost(const advice *a) {
    const belief *b = a->balance;
    const watch *w = a->watch;
    const bool by_the_rule =
        w->balanced && w->doubts > 0 && w->most_J < BELIEF_LIMIT * b->largest_J;
    return (belief_lost(b, BELIEF_LIMIT) && !by_the_rule) || on_the_way(a);
}

/* What is missing of the largest entry, at the end or on the way. */
static double missing(const advice *a) {
    const belief *b = a->balance;
    const double way =
        a->watch->balanced && b->largest_J > 0.0 ? a->watch->most_J / b->largest_J : 0.0;
    return number_most(b->ratio, way);
}

/* A singular position is told of by itself; NULL: no step may help. */
static char *at_one_go(const advice *a) {
    const bool singular = advice_singular(a);
    const watch_look *l = singular ? &a->watch->singular : &a->watch->worst;
    char step[STEP_TEXT];
    if (!l->resolved) {
        return NULL;
    }
    options_text(a, l, step);
    return singular ? room_words("these coordinates are singular about t = %.6g s; %s would "
                                 "do, or others",
                                 l->singular_s, step)
                    : room_words("what happens about t = %.6g s is too fast for the step; %s "
                                 "would do",
                                 a->balance->jump_s, step);
}

static char *cure_of(advice *a) {
    const belief *b = a->balance;
    if (b->exact || b->saturated || (b->slow && a->kind->unit != NULL)) {
        return NULL;
    }
    char carried[CARRIED_TEXT];
    char cure[CURE_TEXT];
    const double ratio = number_least(missing(a), 1.0);
    const linearised *l = motions_of(a);
    const watch_look *worst = &a->watch->worst;
    const double by_motion = number_least(linearised_worst(l), 1.0) / ratio;
    if (advice_singular(a) ||
        (b->jump_s >= 0.0 && by_motion < IS_CAUSE && worst->done && worst->off > NOT_RESOLVED)) {
        return at_one_go(a);
    }
    /* else there is more to it than is linear */
    if (!would_do(a, by_motion > IS_ALL ? l->step_s : step_by_order_s(a, ratio), ratio > SATURATED,
                  cure)) {
        return NULL;
    }
    if (by_motion >= IS_CAUSE) {
        char done[DONE_TEXT];
        return room_words("the step is too coarse for %s; %s %s; %s",
                          carried_text(a, l->worst, carried), title_of(a->image),
                          done_text(l, l->worst, done), cure);
    }
    return room_words("the step is too coarse for this motion; %s", cure);
}

/* What tables round does not fall with the step. */
char *advice_cure(advice *a) {
    char *cure = cure_of(a);
    if (a->image->settings.tables == TABLES_NONE) {
        return cure;
    }
    char *all = room_words("the tables may be too coarse: more --cells, or no --tables, tell%s%s",
                           cure != NULL ? "; if it is not they, " : "", cure != NULL ? cure : "");
    free(cure);
    return all;
}

/* --- the others ------------------------------------------------------------------------------------------------*/

static void say_singular(FILE *out, const advice *a) {
    const watch_look *s = &a->watch->singular;
    const image *im = a->image;
    if (!advice_singular(a)) {
        return;
    }
    char near[120] = "";
    char off[160];
    char step[STEP_TEXT];
    if (s->near >= 0) {
        const component c = image_component(im, s->near);
        const image_unit *unit = &im->unknown[c.unknown].unit[0];
        snprintf(near, sizeof near, ", nearest at %.60s = %.3g %.20s", im->unknown[c.unknown].name,
                 image_shown(unit, s->near_at), unit->shown);
    }
    if (s->component >= 0) {
        const image_unknown *u = &im->unknown[image_component(im, s->component).unknown];
        snprintf(off, sizeof off, "; the steps there put '%.60s' %.2g%s off", u->name, s->off,
                 u->is_angle ? " rad" : " of its range");
    } else {
        snprintf(off, sizeof off, "; the steps there put the rates %.2g %% off", 100.0 * s->off);
    }
    fprintf(out,
            "%s: about t = %.6g s these coordinates are singular: the inertia of '%s' falls to "
            "%.2g of its largest%s%s\n",
            s->failed ? "hint" : "whirl run: warning", s->singular_s,
            im->unknown[image_component(im, s->singular).unknown].name, s->inertia, near,
            s->failed ? "" : off);
    if (s->resolved) {
        fprintf(out,
                "hint: %s resolves it; coordinates that are not singular there need no "
                "smaller step\n",
                options_text(a, s, step));
    } else {
        fprintf(out,
                "hint: steps down to %s do not resolve it: take coordinates that are not singular "
                "there\n",
                step_text(s->fine_step_s, step));
    }
}

/* A swing that varies along its way is to be off by as much, or by half of what linearising it at one place says. */
static bool is_borne_out(advice *a, const linear_motion *m) {
    const double half = 0.25 * number_least(m->off, 1.0) * number_root(m->share);
    if (!swing_varies(a->motions, m)) {
        return true;
    }
    a->swing_off = swing_off(a->watch);
    return a->swing_off >= number_most(number_least(half, SWING_OFF), 0.5 * SWING_OFF);
}

/* A system has no energy to miss: its motions are asked. */
bool advice_swing(advice *a) {
    if (!a->swing_known) {
        const bool is_asked = !a->image->has_energies && a->image->settings.matrix != MATRIX_EXACT;
        const linear_motion *m = is_asked ? motions_of(a)->worst : NULL;
        a->swing_known = true;
        a->swing = m != NULL && m->share >= SWING_SHARE &&
                   linearised_worst(a->motions) >= SWING_LOST && is_borne_out(a, m);
    }
    return a->swing;
}

static void say_swing(FILE *out, advice *a) {
    char carried[CARRIED_TEXT];
    char cure[CURE_TEXT];
    char done[DONE_TEXT];
    if (!advice_swing(a)) {
        return;
    }
    const linearised *l = motions_of(a);
    if (a->swing_off > 0.0) {
        snprintf(done, sizeof done, "puts it up to %.2g %% of its range off", 100.0 * a->swing_off);
    } else {
        done_text(l, l->worst, done);
    }
    fprintf(out, "whirl run: warning: the step is too coarse for %s; %s %s\n",
            carried_text(a, l->worst, carried), title_of(a->image), done);
    if (would_do(a, l->step_s, l->worst->off > SATURATED, cure)) {
        fprintf(out, "hint: %s\n", cure);
    }
}

void advice_say(FILE *out, advice *a) {
    say_singular(out, a);
    say_swing(out, a);
}

/* Records are in the order of time: the first such motion is from before everything grew. */
void advice_say_diverged(FILE *out, advice *a) {
    say_singular(out, a);
    if (a->image->settings.matrix == MATRIX_EXACT || a->watch->records == 0 || advice_singular(a)) {
        return;
    }
    motions_of(a);
    linearised *l = a->motions;
    const linear_motion *found = NULL;
    l->span_s = a->image->until_s;
    for (int i = 0; i < l->motions && found == NULL; i++) {
        const linear_motion *m = &l->motion[i];
        if (m->value.re <= 1e-6 * complex_size(m->value) &&
            limits_growth(l->method, l->form, linearised_as(m), l->step_s) > 1.001) {
            found = m;
        }
    }
    for (int i = 0; i < l->motions && found == NULL; i++) {
        found = l->motion[i].off > SWING_LOST ? &l->motion[i] : NULL;
    }
    if (found != NULL) {
        char carried[CARRIED_TEXT];
        char cure[CURE_TEXT];
        const double limit = limits_interval(l->method, l->form, linearised_as(found));
        int kept = 0;
        while (kept < l->motions && l->motion[kept].time_s <= found->time_s) {
            l->motion[kept].share =
                1.0; /* what is left of one beside what has grown says nothing */
            kept++;
        }
        l->motions = kept;
        const bool told = would_do(a, l->step_s, true, cure);
        carried_text(a, found, carried);
        if (limit < l->step_s * complex_size(found->value)) {
            fprintf(out, "hint: %s is more than %s carries (%.3g in this direction)%s%s\n", carried,
                    title_of(a->image), limit, told ? "; " : "", cure);
        } else {
            fprintf(out, "hint: the step is too coarse for %s%s%s\n", carried, told ? "; " : "",
                    cure);
        }
    }
}
