#include "host/engine/start.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/number/phase.h"

/* === methods in words ========================================================================= */

static void put(char text[METHODS_TEXT_SIZE], const char *before, const char *word) {
    const size_t length = strlen(text);
    snprintf(text + length, METHODS_TEXT_SIZE - length, "%s%s", before, word);
}

const char *methods_of_form(wh_form form, char text[METHODS_TEXT_SIZE]) {
    const char *waiting = NULL; /* the next method to write; if it is the last, "or" precedes it */
    text[0] = '\0';
    for (int i = 0; i < WH_METHODS; i++) {
        if (wh_method_takes((wh_method)i, form) && wh_methods[i].takes != WH_NO_RATES) {
            if (waiting != NULL) {
                put(text, text[0] != '\0' ? ", " : "", waiting);
            }
            waiting = wh_methods[i].word;
        }
    }
    put(text, text[0] != '\0' ? " or " : "", waiting != NULL ? waiting : "");
    return text;
}

static void put_only(char text[METHODS_TEXT_SIZE], uint8_t takes, const char *what) {
    const char *before = "; ";
    for (int i = 0; i < WH_METHODS; i++) {
        if (wh_methods[i].takes == takes) {
            put(text, before, wh_methods[i].word);
            before = ", ";
        }
    }
    put(text, before[0] == ',' ? what : "", "");
}

const char *methods_in_help(char text[METHODS_TEXT_SIZE]) {
    text[0] = '\0';
    put(text, wh_methods[WH_METHOD_DEFAULT].word, " (default)");
    for (int i = WH_METHODS - 1; i >= 0; i--) {
        if (i != WH_METHOD_DEFAULT && wh_method_takes((wh_method)i, WH_FIRST_ORDER)) {
            put(text, ", ", wh_methods[i].word);
        }
    }
    put_only(text, WH_SECOND_ORDER_ONLY, " (second order only)");
    put_only(text, WH_NO_RATES, " (if accelerations depend on no rates)");
    return text;
}

/* === checks of the start ====================================================================== */

#define ROUNDING 1e-9 /* largest distance beyond a stop that counts as round-off, m or rad */

static bool is_apart(const image_contact *stop, double gap, diags *errors) {
    static const char hint[] = "start on the stop or on its free side, or leave the stop out";
    if (stop->kind != WH_STOP || (gap >= -ROUNDING && isfinite(gap))) {
        return true;
    }
    const bool has_unit = strcmp(stop->unit, "1") != 0;
    if (!isfinite(gap)) {
        diag_error(errors, stop->at, hint,
                   "the distance to this stop is not a finite number where the run starts");
    } else {
        diag_error(errors, stop->at, hint, "the run starts beyond this stop, by %.6g%s%s", -gap,
                   has_unit ? " " : "", has_unit ? stop->unit : "");
    }
    return false;
}

bool start_angles_are_held(const image *im, diags *errors) {
    bool held = true;
    for (int i = 0; i < im->angles; i++) {
        const image_unknown *u = &im->unknown[im->angle[i].unknown];
        if (!phase_holds_start(u->start[0])) {
            diag_error(errors, u->start_at[0].source != NULL ? u->start_at[0] : u->at,
                       "start the angle within a turn: a sine does not change with whole turns",
                       "'%s' starts at %.9g rad, but float represents angles only up to %g rad",
                       u->name, u->start[0], PHASE_START_MOST_RAD);
            held = false;
        }
    }
    return held;
}

bool start_is_possible(const image *im, const engine_kind *kind, diags *errors) {
    bool good = kind != &engine_float || start_angles_are_held(im, errors);
    if (im->contacts == 0 || !good) {
        return good;
    }
    const state_list signals = state_list_open(im, IMAGE_SIGNALS);
    const double *signal = state_list_at(&signals, im->start_rad, im->start_real);
    for (int k = 0; k < im->contacts; k++) {
        good = is_apart(&im->contact[k], signal[2 * k], errors) && good;
    }
    state_list_close(&signals);
    return good;
}

/* An unknown whose rate the accelerations contain, or -1. */
static int rate_taken(const image *im) {
    const op_list *t = im->list[IMAGE_STEP];
    for (int k = 0; k < t->count; k++) {
        for (int i = 0; i < im->count && t->ops[k].code == OP_RATE; i++) {
            if (im->place[i] == t->ops[k].a) {
                return i;
            }
        }
    }
    return -1;
}

/* Returns false, and reports the reason, if the accelerations contain rates, or if there are contacts or a ledger. */
static bool is_free_of_rates(const image *im, const char *title, diags *errors) {
    char others[METHODS_TEXT_SIZE];
    char hint[METHODS_TEXT_SIZE + 160];
    const int taken = rate_taken(im);
    snprintf(hint, sizeof hint,
             "this method needs forces that depend on positions only; choose --method %s",
             methods_of_form(im->form, others));
    if (taken >= 0) {
        diag_error(errors, im->unknown[taken].at, hint,
                   "%s is not defined here: the accelerations depend on the rate of '%s'", title,
                   im->unknown[taken].name);
    } else if (im->contacts > 0) {
        diag_error(errors, im->contact[0].at, hint, "%s is not defined with contacts", title);
    } else if (im->ledger.kept) {
        diag_error(errors, im->at, hint, "%s is not defined with a ledger", title);
    }
    return taken < 0 && im->contacts == 0 && !im->ledger.kept;
}

bool start_has_method(const image *im, wh_method method, diags *errors) {
    const char *title = wh_methods[method].title;
    if (wh_method_takes(method, im->form)) {
        return wh_methods[method].takes != WH_NO_RATES || is_free_of_rates(im, title, errors);
    }
    char others[METHODS_TEXT_SIZE];
    char hint[METHODS_TEXT_SIZE + 160];
    methods_of_form(im->form, others);
    for (int i = 0; i < im->count; i++) {
        const image_unknown *u = &im->unknown[i];
        if (u->order != 2) {
            snprintf(hint, sizeof hint,
                     "this method needs equations of order 2 for every unknown; choose --method %s",
                     others);
            diag_error(errors, u->at, hint, "%s is not defined here: '%s' is of order %d", title,
                       u->name, u->order);
            return false;
        }
    }
    snprintf(
        hint, sizeof hint,
        "use --without conserve, so that Whirl computes the acceleration of this coordinate, or choose --method %s",
        others);
    diag_error(errors, im->at, hint,
               "%s is not defined here: the rate of '%s' follows from its conserved momentum",
               title, im->unknown[im->from_momentum[0]].name);
    return false;
}
