/* fixed_refuse.c: see fixed_refuse.h. */
#include "fixed_refuse.h"

#include <stdio.h>
#include <string.h>

#include "fixed_list.h"

static bool has_noise(const image *im) {
    const tape *t = im->list[IMAGE_OBSERVE];
    for (int i = 0; t != NULL && i < t->count; i++) {
        if (t->ops[i].code == OP_NOISE) {
            return true;
        }
    }
    return false;
}

static const char refused_part[] =
    "--number float; or put it into an effect, and leave that out: --without EFFECT";

bool fixed_has_step(const image *im, diags *errors) {
    const image_settings *s = &im->settings;
    if (has_noise(im)) {
        diag_error(errors, im->at, refused_part,
                   "outputs of '%s' have noise, which fixed point has not", im->name);
    } else if (im->contacts > 0) {
        diag_error(errors, im->contact[0].at, refused_part,
                   "there are no events in fixed point: '%s' has this %s", im->name,
                   im->contact[0].word);
    } else if (im->drives > 0) {
        diag_error(errors, im->input[im->drive[0].input].at,
                   "leave out its rate, or choose --number float",
                   "inputs stand still inside a step in fixed point: '%s' has a rate",
                   im->input[im->drive[0].input].name);
    } else if (s->stabilized) {
        diag_error(errors, im->at, "leave out --stabilized, or choose --number float",
                   "there is no --stabilized in fixed point");
    } else if (im->ledger.kept) {
        diag_error(errors, im->at, "--without ledger, or --number float",
                   "'%s' keeps a ledger, which fixed point has not", im->name);
    } else if (s->method != WH_RK4) {
        diag_error(errors, im->at, "leave out --method, or choose --number float",
                   "fixed point knows --method rk4 only, not %s", wh_methods[s->method].word);
    } else if (s->compensated) {
        diag_error(errors, im->at, "leave out --compensated, or choose --number float",
                   "sums in fixed point are not compensated");
    } else if (s->matrix != MATRIX_NONE) {
        diag_error(errors, im->at, "leave out --matrix, or choose --number float",
                   "there is no --matrix %s in fixed point", image_matrix_words[s->matrix]);
    } else if (s->tables != TABLES_NONE) {
        diag_error(errors, im->at, "leave out --tables, or choose --number float",
                   "there are no --tables %s in fixed point", image_tables_words[s->tables]);
    } else if (im->angles + im->reals == 0) {
        diag_error(errors, im->at, NULL, "'%s' has no state to step", im->name);
    } else {
        return true;
    }
    return false;
}

/* Does everything start within its range? */
static bool starts_inside(const image *im, const interval *range, diags *errors) {
    bool good = true;
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const double value = i < im->reals ? im->start_real[i] : im->input[i - im->reals].value;
        if (value < range[i].low || value > range[i].high) {
            diag_error(errors, im->range[i].at, "widen the range, or start within it",
                       "'%s' starts at %.9g, outside its range", im->range[i].name, value);
            good = false;
        }
    }
    return good;
}

/* Ranges that are no larger than anything may be. */
static bool ranges_are_bounded(const image *im, const interval *range, diags *errors) {
    bool good = true;
    for (int i = 0; i < im->reals + im->inputs; i++) {
        if (!(interval_size(range[i]) <= FIXED_SIZE_MOST)) {
            diag_error(errors, im->range[i].at, "declare a narrower one: range NAME = A .. B",
                       "the range of '%s' reaches beyond %.2g", im->range[i].name, FIXED_SIZE_MOST);
            good = false;
        }
    }
    return good;
}

bool fixed_ranges_hold(const image *im, const interval *range, diags *errors) {
    return ranges_are_bounded(im, range, errors) && starts_inside(im, range, errors);
}

bool fixed_inputs_declared(const image *im, const interval *range, diags *errors) {
    bool good = true;
    for (int i = im->reals; i < im->reals + im->inputs; i++) {
        const char *si = im->input[i - im->reals].unit.si;
        const bool has_unit = strcmp(si, "1") != 0;
        if (!im->range[i].declared) {
            char hint[200];
            snprintf(hint, sizeof hint, "in the scene: range %.60s = %.9g .. %.9g%s%.40s%s",
                     im->range[i].name, range[i].low < 0.0 ? range[i].low : 0.0,
                     range[i].high > 0.0 ? range[i].high : 0.0, has_unit ? " [" : "",
                     has_unit ? si : "", has_unit ? "]" : "");
            diag_error(errors, im->range[i].at, hint,
                       "code in fixed point needs the range of the input '%s'", im->range[i].name);
            good = false;
        }
    }
    return good;
}
