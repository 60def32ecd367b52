/* verdict.c: see verdict.h. */
#include "verdict.h"

#include <stdlib.h>

#include "busy_text.h"
#include "host/base/room.h"
#include "remedy.h"

verdict *verdict_open(const image *im, const engine_kind *kind) {
    verdict *v = room(1, sizeof *v);
    v->image = im;
    v->kind = kind;
    v->books = books_open(im);
    v->watch = watch_open(im, kind);
    v->busy = busy_open(im, 1);
    v->about = advice_of(im, kind, v->watch, &v->balance);
    return v;
}

void verdict_close(verdict *v) {
    if (v != NULL) {
        advice_end(&v->about);
        busy_close(v->busy);
        watch_close(v->watch);
        books_close(v->books);
        free(v);
    }
}

void verdict_enter(verdict *v, const void *run) {
    if (v->books != NULL) {
        books_enter(v->books, v->kind, run);
    }
    watch_enter(v->watch, v->kind, v->books, run);
    busy_enter(v->busy, v->kind, run, v->books != NULL ? v->books->energy_J[1] : 0.0);
}

void verdict_end(verdict *v, const void *run, bool failed, const volatile sig_atomic_t *stop) {
    watch_end(v->watch, failed);
    v->about.cures.stop = stop;
    v->balance = belief_of(v->books, v->kind, run);
    if (failed) {
        return;
    }
    v->retrial = retrial_of(v->busy, v->kind, v->balance.known ? v->balance.largest_J : 0.0, stop);
    v->against =
        (judged_blurred(&v->about.judged) ? VERDICT_BIT(VERDICT_MASS) : 0U) |
        (judged_numbers(&v->about.judged) ? VERDICT_BIT(VERDICT_FOLDED) : 0U) |
        (judged_energy(&v->about.judged) ? VERDICT_BIT(VERDICT_ENERGY) : 0U) |
        (judged_singular(&v->about.judged) ? VERDICT_BIT(VERDICT_SINGULAR) : 0U) |
        (jumped_some(v->watch->jumped) ? VERDICT_BIT(VERDICT_JUMPED) : 0U) |
        (between_seen(v->watch->between).component >= 0 ? VERDICT_BIT(VERDICT_BETWEEN) : 0U) |
        (judged_swing(&v->about.judged) ? VERDICT_BIT(VERDICT_SWING) : 0U) |
        (v->retrial.told ? VERDICT_BIT(VERDICT_CONTACTS) : 0U);
}

/* What the energy's balance is to be warned of with: the contacts, where they are to blame, or where the step that they take
 * is asked for the energy, too. */
static char *cure_of(verdict *v) {
    const bool contacts = (v->against & VERDICT_BIT(VERDICT_CONTACTS)) != 0;
    return contacts && v->busy->overruns > 0
               ? room_words("steps that had more events than they take do that: see there")
           : contacts && v->retrial.parts > 0
               ? room_words("the step is too coarse, for its contacts, too: see there")
               : advice_cure(&v->about);
}

static void say_contacts(FILE *out, const char *who, verdict *v) {
    char options[REMEDY_TEXT];
    busy_cure cure = {.options = options};
    const bool is_tried = v->retrial.told && v->retrial.parts > 0;
    if (is_tried) {
        const double step_s = ratio_times(1, v->image->step) / (double)v->retrial.parts;
        cure.outcome = remedy_from(&v->about.judged, &v->about.cures, step_s, options);
    }
    busy_say(out, who, v->busy, &v->retrial, is_tried ? &cure : NULL);
}

void verdict_say(FILE *out, verdict *v, bool fails) {
    static const char warning[] = "whirl run: warning";
    if (fails || (v->against & VERDICT_BIT(VERDICT_ENERGY)) != 0) {
        char *cure = cure_of(v);
        belief_say(out, fails ? "whirl run: error" : warning, &v->balance, v->kind,
                   v->image->settings.method, fails ? 0.0 : v->watch->most_J, cure);
        free(cure);
    }
    if (v->busy != NULL) {
        say_contacts(out, warning, v);
    }
    advice_say(out, &v->about);
}
