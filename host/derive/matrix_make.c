/* matrix_make.c: from rates to what a step adds, rounded once, and to the list that adds it. */
#include "matrix_make.h"

#include <stddef.h>
#include <stdlib.h>

#include "affine.h"
#include "exponential.h"
#include "host/base/room.h"
#include "not_linear.h"

/* --- what has none ---------------------------------------------------------------------------------*/

static bool is_possible(const image *im, diags *errors) {
    static const char hint[] = "leave out --matrix";
    if (im->contacts > 0) {
        diag_error(errors, im->contact[0].at, "leave it out, --without; or leave out --matrix",
                   "a step with events is no matrix: '%s' has this %s", im->name,
                   im->contact[0].word);
    } else if (im->ledger.kept) {
        diag_error(errors, im->at, "--without ledger, or leave out --matrix",
                   "the ledger of '%s' wants the stages of a step, and a matrix has none",
                   im->name);
    } else if (im->settings.tables != TABLES_NONE) {
        diag_error(errors, im->at, "leave out --tables, or --matrix",
                   "a matrix looks nothing up: --matrix %s and --tables %s",
                   image_matrix_words[im->settings.matrix],
                   image_tables_words[im->settings.tables]);
    } else if (im->settings.method != WH_METHOD_DEFAULT) {
        diag_error(errors, im->at, "leave out --method, or --matrix",
                   "a matrix takes the place of a method's stages: --matrix %s and --method %s",
                   image_matrix_words[im->settings.matrix], wh_methods[im->settings.method].word);
    } else if (affine_states(im) == 0) {
        diag_error(errors, im->at, hint, "'%s' has no state to step", im->name);
    } else {
        return true;
    }
    return false;
}

/* --- the list --------------------------------------------------------------------------------------*/

/* The operation for a column: a state, an input or what is constant. No column of a turn angle has entries. */
static int leaf(const image *im, tape *t, int column) {
    const int real = column - im->angles;
    const int linears = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    if (real >= im->reals + im->inputs) {
        return tape_constant(t, 1.0);
    }
    if (real >= im->reals) {
        return tape_leaf(t, OP_INPUT, real - im->reals);
    }
    return real < linears ? tape_leaf(t, OP_LINEAR, real) : tape_leaf(t, OP_RATE, real - linears);
}

/* The sum of a row's entries, each the double that stands for it, times their columns. */
static int enter_row(const image *im, tape *t, const twofold *row,
                     double (*constant)(twofold entry)) {
    int sum = tape_constant(t, 0.0);
    for (int k = 0; k < affine_columns(im); k++) {
        const double entry = constant(row[k]);
        if (entry != 0.0) {
            sum = tape_add(t, sum, tape_mul(t, tape_constant(t, entry), leaf(im, t, k)));
        }
    }
    return sum;
}

/* The row, in which column `of` has one more than it says. Where that is nearly 1, only the difference is rounded. */
static int enter_near(const image *im, tape *t, twofold *row, int of) {
    if (row[of].high < -0.5 || row[of].high > 1.0) {
        row[of] = twofold_add(row[of], twofold_of(1.0));
        return enter_row(im, t, row, twofold_constant);
    }
    return tape_add(t, leaf(im, t, of), enter_row(im, t, row, twofold_constant));
}

/* Digits of an entry that a float has no room for, where a float has room for those. */
static double rest(twofold entry) {
    const double beyond = twofold_beyond_float(entry);
    return fits_float(beyond) ? beyond : 0.0;
}

/* The mean rate of turn angle i over a step of h in which it moves by row[]: of a coordinate, nearly its rate. */
static int enter_angle(const image *im, tape *t, twofold *row, int i, twofold h) {
    for (int k = 0; k < affine_columns(im); k++) {
        row[k] = twofold_div(row[k], h);
    }
    if (im->form != WH_SECOND_ORDER) {
        return enter_row(im, t, row, twofold_constant);
    }
    const int rate = im->coordinates + i;
    row[rate] = twofold_sub(row[rate], twofold_of(1.0));
    return enter_near(im, t, row, rate);
}

/* `change` is what a step of h adds; it is used up. */
static tape *make_list(const image *im, twofold *change, twofold h) {
    const int states = affine_states(im);
    const bool compensated = im->settings.compensated;
    tape *t = tape_new(im->angles, states + (compensated ? im->reals : 0));
    for (int i = 0; i < states; i++) {
        twofold *row = change + (ptrdiff_t)i * affine_columns(im);
        if (i < im->angles) {
            t->result[i] = enter_angle(im, t, row, i, h);
        } else if (compensated) {
            t->result[i] = enter_row(im, t, row, twofold_constant);
            t->result[im->reals + i] = enter_row(im, t, row, rest);
        } else {
            t->result[i] = enter_near(im, t, row, i);
        }
    }
    tape_prune(t);
    tape_order(t);
    return t;
}

/* --- the matrix ------------------------------------------------------------------------------------*/

static twofold step_of(const image *im) {
    return im->step.denominator != 0 ? twofold_ratio(im->step.numerator, im->step.denominator)
                                     : twofold_of(im->step_s);
}

static void keep_numbers(image_draft *d, const twofold *change) {
    image *im = d->made;
    image_matrix *m = &im->matrix;
    m->states = affine_states(im);
    m->columns = affine_columns(im);
    m->entry = image_room(d, m->states * m->columns, sizeof *m->entry);
    for (int i = 0; i < m->states; i++) {
        for (int k = 0; k < m->columns; k++) {
            const twofold entry = change[i * m->columns + k];
            m->entry[i * m->columns + k] =
                k == i ? twofold_add(entry, twofold_of(1.0)).high : entry.high;
        }
    }
}

/* change[] holds the rates. */
static bool make(image_draft *d, twofold *change, diags *errors) {
    image *im = d->made;
    const int states = affine_states(im);
    const int columns = affine_columns(im);
    const twofold h = step_of(im);
    bool good = true;
    for (int i = 0; i < states * columns; i++) {
        change[i] = twofold_mul(change[i], h);
    }
    if (im->settings.matrix == MATRIX_EXACT) {
        good = exponential_exact(change, states, columns);
    } else {
        exponential_series(change, states, columns, wh_methods[WH_RK4].order);
    }
    for (int i = 0; i < states * columns; i++) {
        good = good && twofold_is_finite(change[i]);
    }
    if (!good) {
        diag_error(errors, im->at, "a smaller --step",
                   "the matrix of '%s' has numbers that are too large: something grows or decays "
                   "too fast for a step of %.9g s",
                   im->name, im->step_s);
        return false;
    }
    keep_numbers(d, change);
    im->list[IMAGE_MATRIX] = make_list(im, change, h);
    return true;
}

bool matrix_make(image_draft *d, bool has_blame, bool *wants_blame, diags *errors) {
    image *im = d->made;
    *wants_blame = false;
    if (!is_possible(im, errors)) {
        return false;
    }
    twofold *change = room((int64_t)affine_states(im) * affine_columns(im), sizeof *change);
    const int bad = affine_rates(im, change);
    bool good = bad < 0;
    if (!good && has_blame) {
        not_linear_report(im, bad, errors);
    } else if (!good) {
        *wants_blame = true;
    } else {
        good = make(d, change, errors);
    }
    free(change);
    return good;
}
