/* advice.c: see advice.h. */
#include "advice.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "advice_numbers.h"
#include "host/base/room.h"
#include "host/base/statement.h"
#include "host/number/functions.h"
#include "remedy.h"
#include "step_text.h"

/* A motion is the cause where what it has lost is at least this part of what is missing. */
#define IS_CAUSE 0.1
/* And all of it, where there is nothing else to expect: at least this part. */
#define IS_ALL 0.3
/* Where so much is missing, or all bounds were left, nothing is known of the motion as it should have been: a cure is to
 * leave so much less. */
#define SATURATED 0.3

/* A method that carries no more of a direction than this carries nothing there. */
#define LIMIT_NONE 0.05

enum { CARRIED_TEXT = 240, DONE_TEXT = 80 };

advice advice_of(const image *im, const engine_kind *kind, const watch *w, const belief *balance) {
    return (advice){.judged = judged_of(im, kind, w, balance),
                    .cures = {.image = im, .kind = kind}};
}

void advice_end(advice *a) { judged_end(&a->judged); }

static const char *title_of(const image *im) { return wh_methods[judged_method(im)].title; }

/* --- words -----------------------------------------------------------------------------------------------*/

/* Who carries a motion, how fast it is and what that is in steps. */
static const char *carried_text(const judged *j, const linear_motion *m, char text[CARRIED_TEXT]) {
    const double size = complex_size(m->value);
    const bool swings = fabs(m->value.im) > 0.1 * size;
    const char *second = m->unknown[1] >= 0 ? j->image->unknown[m->unknown[1]].name : "";
    char much[100];
    if (swings) {
        snprintf(much, sizeof much, "%.3g rad/s (a period of %.3g s), h w = %.3g", size,
                 6.283185307179586 / fabs(m->value.im), size * j->watch->step_s);
    } else {
        snprintf(much, sizeof much, "a time constant of %.3g s, h/tau = %.3g", 1.0 / size,
                 size * j->watch->step_s);
    }
    snprintf(text, CARRIED_TEXT, "'%.60s'%s%.60s%s about t = %.6g s: %s",
             j->image->unknown[m->unknown[0]].name, second[0] != '\0' ? " and '" : "", second,
             second[0] != '\0' ? "'" : "", m->time_s, much);
    return text;
}

/* What the method makes of it in a run: of its energy, or of the amplitude of what has none. */
static const char *done_text(const judged *j, const linearised *l, const linear_motion *m,
                             char text[DONE_TEXT]) {
    const bool energy = j->image->has_energies;
    const char *what = energy ? "energy" : "amplitude";
    const double grown = 1.0 + m->off;
    const double added = energy ? grown * grown - 1.0 : m->off;
    if (m->ripple > 0.0) {
        snprintf(text, DONE_TEXT, "lets its %s go %.3g %% up and down", what,
                 100.0 * number_least(energy ? m->ripple : 0.5 * m->ripple, 1.0));
    } else if (limits_growth(l->method, l->form, linearised_as(m), l->step_s) <=
               limits_exact(m->value, l->step_s)) {
        const double left = 1.0 - number_least(m->off, 1.0);
        snprintf(text, DONE_TEXT, "takes %.3g %% of its %s over the run",
                 100.0 * (1.0 - (energy ? left * left : left)), what);
    } else if (added < 1.0) {
        snprintf(text, DONE_TEXT, "adds %.3g %% to its %s over the run", 100.0 * added, what);
    } else if (isfinite(added)) {
        snprintf(text, DONE_TEXT, "adds %.3g times its %s over the run", added, what);
    } else {
        snprintf(text, DONE_TEXT, "lets its %s grow without bound", what);
    }
    return text;
}

/* --- the energy ----------------------------------------------------------------------------------------------*/

/* A singular position is told of by itself; NULL: no step may help. */
static char *at_one_go(advice *a) {
    const judged *j = &a->judged;
    const bool singular = judged_singular(j);
    const watch_look *l = singular ? &j->watch->singular : &j->watch->worst;
    char step[REMEDY_TEXT];
    if (!l->resolved) {
        return NULL;
    }
    const cure_outcome outcome = remedy_of_look(j, &a->cures, l, step);
    const char *does = outcome == CURE_DOES        ? "would do"
                       : outcome == CURE_NOT_TRIED ? "should do (not tried: that takes long)"
                                                   : "resolves that, but is not all that it takes";
    return singular
               ? room_words("these coordinates are singular about t = %.6g s; %s %s, or others",
                            l->singular_s, step, does)
               : room_words("what happens about t = %.6g s is too fast for the step; %s %s",
                            j->balance->jump_s, step, does);
}

static char *cure_of(advice *a) {
    judged *j = &a->judged;
    const belief *b = j->balance;
    if (b->exact || b->saturated || (b->slow && j->kind->unit != NULL)) {
        return NULL;
    }
    char carried[CARRIED_TEXT];
    char cure[REMEDY_TEXT];
    const double ratio = number_least(judged_missing(j), 1.0);
    const linearised *l = judged_motions(j);
    const watch_look *worst = &j->watch->worst;
    const double by_motion = number_least(linearised_worst(l), 1.0) / ratio;
    if (judged_singular(j) || (b->jump_s >= 0.0 && by_motion < IS_CAUSE && worst->done &&
                               worst->off > JUDGED_NOT_RESOLVED)) {
        return at_one_go(a);
    }
    /* else there is more to it than is linear */
    if (!remedy_text(j, &a->cures,
                     by_motion > IS_ALL ? l->step_s : remedy_step_by_order_s(j, ratio),
                     ratio > SATURATED, cure)) {
        return NULL;
    }
    if (by_motion >= IS_CAUSE) {
        char done[DONE_TEXT];
        return room_words("the step is too coarse for %s; %s %s; %s",
                          carried_text(j, l->worst, carried), title_of(j->image),
                          done_text(j, l, l->worst, done), cure);
    }
    return room_words("the step is too coarse for this motion; %s", cure);
}

/* What tables round does not fall with the step. */
char *advice_cure(advice *a) {
    char *cure = cure_of(a);
    if (a->judged.image->settings.tables == TABLES_NONE) {
        return cure;
    }
    const int own = a->judged.image->settings.cells;
    char cells[40] = "more --cells, or ";
    if (own > 0) {
        snprintf(cells, sizeof cells, "--cells %d, or ", 2 * own);
    }
    char *all = room_words("the tables may be too coarse (not tried): %sno --tables would tell%s%s",
                           2 * own > IMAGE_CELLS_MOST ? "" : cells,
                           cure != NULL ? "; if it is not they, " : "", cure != NULL ? cure : "");
    free(cure);
    return all;
}

/* --- the others ------------------------------------------------------------------------------------------------*/

static void say_singular(FILE *out, advice *a) {
    const judged *j = &a->judged;
    const watch_look *s = &j->watch->singular;
    const image *im = j->image;
    if (!judged_singular(j)) {
        return;
    }
    char near[120] = "";
    char off[160];
    char step[REMEDY_TEXT];
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
        const cure_outcome outcome = remedy_of_look(j, &a->cures, s, step);
        fprintf(out,
                "hint: %s resolves it%s; coordinates that are not singular there need no "
                "smaller step\n",
                step,
                outcome == CURE_DOES        ? ""
                : outcome == CURE_NOT_TRIED ? " (not tried on all of the run: that takes long)"
                                            : " there, but is not all that it takes");
    } else {
        fprintf(out,
                "hint: steps down to %s do not resolve it: take coordinates that are not singular "
                "there\n",
                step_text(s->fine_step_s, step));
    }
}

static void say_missed(FILE *out, advice *a, int through, double begin_s) {
    const image *im = a->judged.image;
    char statement[STATEMENT_SIZE];
    char finer[REMEDY_TEXT];
    fprintf(out, "whirl run: warning: the step after t = %.6g s passed ", begin_s);
    if (through < im->contacts) {
        statement_text(im->contact[through].at, statement, sizeof statement);
        fprintf(out, "through a contact: %s\n", statement);
    } else {
        const component c = image_component(im, through - im->contacts);
        fprintf(out, "over a force on %s, far larger than at both its ends\n",
                im->unknown[c.unknown].name);
    }
    const cure_outcome outcome = remedy_finer(&a->judged, &a->cures, finer);
    fprintf(out,
            outcome == CURE_DOES        ? "hint: %s meets it\n"
            : outcome == CURE_NOT_TRIED ? "hint: %s may meet it (not tried: that takes long)\n"
                                        : "hint: %s does not do, either: it is thinner "
                                          "than the way of a step\n",
            finer);
}

static void say_jumped(FILE *out, advice *a) {
    const judged *j = &a->judged;
    double begin_s;
    char statement[STATEMENT_SIZE];
    char finer[REMEDY_TEXT];
    if (!jumped_some(j->watch->jumped)) {
        return;
    }
    const int through = jumped_through(j->watch->jumped, &begin_s);
    if (through >= 0) {
        say_missed(out, a, through, begin_s);
        return;
    }
    const blame_question *q = jumped_over(j->watch->jumped, &begin_s);
    statement_text(q->where, statement, sizeof statement);
    fprintf(out,
            "whirl run: warning: the step after t = %.6g s jumped over a place where %s grows "
            "without bound: %s\n",
            begin_s, q->what, statement);
    const cure_outcome outcome = remedy_finer(j, &a->cures, finer);
    fprintf(out,
            outcome == CURE_DOES ? "hint: no motion gets through there; %s stays on its side, and "
                                   "would do\n"
            : outcome == CURE_NOT_TRIED
                ? "hint: no motion gets through there; %s may stay on its side (not tried: that "
                  "takes long)\n"
                : "hint: no motion gets through there, and what the run says behind it is none; "
                  "finer steps fail, too\n",
            finer);
}

static void say_between(FILE *out, advice *a) {
    const judged *j = &a->judged;
    const between_found found = between_seen(j->watch->between);
    if (found.component < 0) {
        return;
    }
    const component c = image_component(j->image, found.component);
    const watch_look fine = {.fine_step_s = found.fine_step_s};
    char step[REMEDY_TEXT];
    const cure_outcome outcome = remedy_of_look(j, &a->cures, &fine, step);
    fprintf(
        out,
        "whirl run: warning: more goes on between the stages of a step than they see, seen first at t "
        "= %.6g s: in the mean, %s%.*s is %.3g %% of its largest off\n"
        "hint: what drives it is too fast for the step, or of a period that divides it; %s %s\n",
        found.begin_s, j->image->unknown[c.unknown].name, c.primes + 1, "''''''''''",
        100.0 * found.off, step,
        outcome == CURE_DOES        ? "would do"
        : outcome == CURE_NOT_TRIED ? "should do (not tried: that takes long)"
                                    : "sees that, but is not all that it takes");
}

static void say_swing(FILE *out, advice *a) {
    judged *j = &a->judged;
    char carried[CARRIED_TEXT];
    char cure[REMEDY_TEXT];
    char done[DONE_TEXT];
    if (!judged_swing(j)) {
        return;
    }
    const linearised *l = judged_motions(j);
    if (j->swing_off > 0.0) {
        snprintf(done, sizeof done, "puts it up to %.2g %% of its range off", 100.0 * j->swing_off);
    } else {
        done_text(j, l, l->worst, done);
    }
    fprintf(out, "whirl run: warning: the step is too coarse for %s; %s %s\n",
            carried_text(j, l->worst, carried), title_of(j->image), done);
    if (remedy_text(j, &a->cures, l->step_s, l->worst->off > SATURATED, cure)) {
        fprintf(out, "hint: %s\n", cure);
    }
}

void advice_say(FILE *out, advice *a) {
    advice_numbers_say(out, &a->judged);
    say_jumped(out, a);
    say_singular(out, a);
    say_between(out, a);
    say_swing(out, a);
}

/* Exponents by which what grows by itself leaves all bounds, some 1e9 times what it was. */
#define GROWN_FAR 20.0

static bool grows_itself(const linear_motion *m) {
    return m->value.re > 1e-6 * complex_size(m->value);
}

/* The motion that the method lets grow, or at least puts off; NULL: none. Records are in the order of time: the first such
 * is from before everything grew. *own: what grows most by itself, or NULL. */
static const linear_motion *motion_to_blame(const linearised *l, const linear_motion **own) {
    const linear_motion *found = NULL;
    *own = NULL;
    for (int i = 0; i < l->motions && found == NULL; i++) {
        const linear_motion *m = &l->motion[i];
        if (grows_itself(m)) {
            *own = *own == NULL || m->value.re > 1.001 * (*own)->value.re ? m : *own;
        } else if (limits_growth(l->method, l->form, linearised_as(m), l->step_s) > 1.001) {
            found = m;
        }
    }
    for (int i = 0; i < l->motions && found == NULL; i++) {
        const linear_motion *m = &l->motion[i];
        found = !grows_itself(m) && m->off > JUDGED_SWING_LOST ? m : NULL;
    }
    return found;
}

void advice_say_undefined(FILE *out, advice *a) {
    const judged *j = &a->judged;
    char finer[REMEDY_TEXT];
    if (remedy_is_double(j, &a->cures)) {
        fputs("hint: float has too few digits for it: --number double would do\n", out);
    } else if (j->image->settings.matrix != MATRIX_EXACT && remedy_goes_through(j, &a->cures) &&
               remedy_finer(j, &a->cures, finer) == CURE_DOES) {
        fprintf(out, "hint: steps that are too coarse may lead there: %s would do\n", finer);
    }
}

void advice_say_diverged(FILE *out, advice *a) {
    judged *j = &a->judged;
    const bool is_asked =
        j->image->settings.matrix != MATRIX_EXACT && j->watch->records > 0 && !judged_singular(j);
    if (is_asked && remedy_is_double(j, &a->cures)) {
        fputs("hint: float has too few digits for it: --number double would do\n", out);
        return;
    }
    fputs("hint: a smaller --step may carry it further; if it fails at the same time, look for a "
          "singular position there\n",
          out);
    say_singular(out, a);
    if (!is_asked) {
        return;
    }
    linearised *l = judged_motions(j);
    const linear_motion *own;
    l->span_s = j->image->until_s;
    const linear_motion *found = motion_to_blame(l, &own);
    if (found == NULL && own != NULL && own->value.re * l->span_s > GROWN_FAR) {
        char carried[CARRIED_TEXT];
        fprintf(
            out,
            "hint: %s: such a motion grows by itself; where that is meant, --until ends the run "
            "before\n",
            carried_text(j, own, carried));
        return;
    }
    if (found != NULL) {
        char carried[CARRIED_TEXT];
        char cure[REMEDY_TEXT];
        const double limit = limits_interval(l->method, l->form, linearised_as(found));
        int kept = 0;
        while (kept < l->motions && l->motion[kept].time_s <= found->time_s) {
            l->motion[kept].share =
                1.0; /* what is left of one beside what has grown says nothing */
            kept++;
        }
        l->motions = kept;
        const bool told = remedy_text(j, &a->cures, l->step_s, true, cure);
        carried_text(j, found, carried);
        if (limit < LIMIT_NONE) {
            fprintf(out,
                    "hint: %s: %s lets such a motion grow at any step, less at a finer one%s%s\n",
                    carried, title_of(j->image), told ? "; " : "", cure);
        } else if (limit < l->step_s * complex_size(found->value)) {
            fprintf(out, "hint: %s is more than %s carries (%.3g in this direction)%s%s\n", carried,
                    title_of(j->image), limit, told ? "; " : "", cure);
        } else {
            fprintf(out, "hint: the step is too coarse for %s%s%s\n", carried, told ? "; " : "",
                    cure);
        }
    } else {
        char cure[REMEDY_TEXT];
        if (remedy_text(j, &a->cures, l->step_s, true, cure)) {
            fprintf(out, "hint: %s\n", cure);
        }
    }
}
