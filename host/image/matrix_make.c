/* matrix_make.c: the whole step of a linear scene as one matrix. */
#include "host/image/matrix_make.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/number/folding.h"
#include "host/number/functions.h"

#define GHOST 1e-14 /* a sum below this, relative to its addends, is round-off and counts as zero */

static int affine_states(const image *im) { return im->angles + im->reals; }
int affine_columns(const image *im) { return affine_states(im) + im->inputs + 1; }

static int column_of(const image *im, const op *o) {
    if (o->code == OP_LINEAR) {
        return im->angles + o->a;
    }
    if (o->code == OP_RATE) { /* the columns of rates follow those of all positions */
        return im->coordinates + o->a;
    }
    return affine_states(im) + o->a;
}

static bool is_constant(const double_double *c, int columns) {
    bool constant = true;
    for (int i = 0; i < columns - 1; i++) {
        constant = constant && double_double_is_zero(c[i]);
    }
    return constant;
}

static double_double sum(folding *f, double_double a, double_double b) {
    const double_double both = double_double_add(a, b);
    return folding_cancels(f, both.high, fabs(a.high) + fabs(b.high), GHOST) ? double_double_of(0.0)
                                                                             : both;
}

static void add(folding *f, const double_double *a, const double_double *b, double sign,
                int columns, double_double *to) {
    for (int i = 0; i < columns; i++) {
        to[i] = sum(f, a[i], double_double_scale(b[i], sign));
    }
}

static void multiply(const double_double *a, double_double factor, int columns, double_double *to) {
    for (int i = 0; i < columns; i++) {
        to[i] = double_double_mul(a[i], factor);
    }
}

/* Computes the coefficients of operation `o` from those of its operands. Returns false if `o` is not affine. */
static bool step(const image *im, const op *o, const double_double *all, double_double *to) {
    const int columns = affine_columns(im);
    const double_double *a = all + (ptrdiff_t)(o->a >= 0 ? o->a : 0) * columns;
    const double_double *b = all + (ptrdiff_t)(o->b >= 0 ? o->b : 0) * columns;
    const int last = columns - 1;
    folding *const f = im->list[IMAGE_STEP]->folding;
    switch (o->code) {
    case OP_CONSTANT: to[last] = double_double_of(o->value); return true;
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT: to[column_of(im, o)] = double_double_of(1.0); return true;
    case OP_ADD: add(f, a, b, 1.0, columns, to); return true;
    case OP_SUB: add(f, a, b, -1.0, columns, to); return true;
    case OP_NEG: multiply(a, double_double_of(-1.0), columns, to); return true;
    case OP_MUL: {
        const bool left = is_constant(a, columns);
        multiply(left ? b : a, (left ? a : b)[last], columns, to);
        return left || is_constant(b, columns);
    }
    case OP_DIV:
        if (!is_constant(b, columns)) {
            return false;
        }
        for (int i = 0; i < columns; i++) {
            to[i] = double_double_div(a[i], b[last]);
        }
        return true;
    case OP_PHASE:
    case OP_CELL: return true; /* only nonlinear operations read a phase or a cell */
    case OP_SIN:
    case OP_COS:
    case OP_LINE:
    case OP_CUBIC:
    case OP_SQRT:
    case OP_ABS:
    case OP_SIGN:
    case OP_MIN:
    case OP_MAX:
    case OP_CALL:
    case OP_POW:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE: return false;
    }
    return false;
}

bool affine_rates(const image *im, double_double *rates) {
    const op_list *t = im->list[IMAGE_STEP];
    const int columns = affine_columns(im);
    const size_t row = (size_t)columns * sizeof *rates;
    double_double *all = alloc((int64_t)t->count * columns, sizeof *all);
    bool affine = true;
    for (int i = 0; i < t->count && affine; i++) {
        affine = step(im, &t->ops[i], all, all + (ptrdiff_t)i * columns);
    }
    if (affine) {
        const int positions = im->form == WH_SECOND_ORDER ? im->coordinates : 0;
        memset(rates, 0, (size_t)affine_states(im) * row);
        for (int i = 0; i < positions; i++) {
            rates[i * columns + im->coordinates + i] = double_double_of(1.0);
        }
        for (int i = 0; i < t->results; i++) {
            memcpy(rates + (ptrdiff_t)(positions + i) * columns,
                   all + (ptrdiff_t)t->result[i] * columns, row);
        }
    }
    free(all);
    return affine;
}

/* === the report of a nonlinear statement ====================================================== */

#define NO_DEGREE ((double)INFINITY) /* of an expression that is not a polynomial */

/* The degree of p in the states, the rates and the inputs together. */
static double degree_of(const poly *p) {
    double most = 0.0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double degree = m->angle != NULL && degree_of(m->angle) > 0.0 ? NO_DEGREE : 0.0;
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            const double exponent = m->factors[k].exponent;
            const bool whole = exponent > 0.0 && exponent == number_floor(exponent);
            double inside = x->kind == ATOM_SYMBOL && x->symbol->kind != SYM_PARAMETER ? 1.0 : 0.0;
            for (int j = 0; j < 2 && x->argument[j] != NULL; j++) {
                inside = number_most(inside, degree_of(x->argument[j]));
            }
            const bool power = whole && (x->kind == ATOM_SYMBOL || x->kind == ATOM_GROUP);
            degree += inside == 0.0 ? 0.0 : power ? exponent * inside : NO_DEGREE;
        }
        most = number_most(most, degree);
    }
    return most;
}

/* Is the degree of this statement too high for linear equations? */
static bool is_nonlinear(const equations *e, const term *t) {
    const bool differentiated = t->kind == TERM_T || t->kind == TERM_V || t->kind == TERM_F;
    const expr *const sides[] = {t->value, t->right};
    double degree = 0.0;
    for (int i = 0; i < 2 && sides[i] != NULL; i++) {
        const poly *side = equations_fold(e, poly_from_expr(e->algebra, sides[i]));
        degree = number_most(degree, degree_of(side));
    }
    return instance_has(e->instance, t->effect) && degree > (differentiated ? 2.0 : 1.0);
}

static void report_nonlinear(const image *im, const equations *e, diags *errors) {
    static const char hint[] =
        "leave out --matrix, or make every statement linear, including every 'let'";
    const mechanism *m = e->instance->mechanism;
    int k = 0;
    while (k < m->term_count && !is_nonlinear(e, &m->terms[k])) {
        k++;
    }
    if (k == m->term_count) {
        diag_error(errors, m->at, hint,
                   "the equations of '%s' are nonlinear, so --matrix cannot compute their step",
                   m->name);
        return;
    }
    const place at = m->terms[k].at;
    char line[STATEMENT_SIZE];
    statement_text(at, line, sizeof line);
    diag_error(errors, at, hint,
               "line %d makes '%s' nonlinear, so --matrix cannot compute its step: %s", at.line,
               im->name, line);
}

/* === the change in one step of x' = A x + B u + c, with constant u ============================= */

/* Each halving may cost one of the 104 bits of a double_double. The 53 bits of a double must remain. */
enum { HALVINGS_MOST = 50 };

/* Number of terms of the series. For a matrix of norm 1/2 or less, the remainder is below 2^-110 of the matrix. */
enum { POWERS = 26 };

static void product(const double_double *a, const double_double *b, int states, int columns,
                    double_double *to) {
    for (int i = 0; i < states; i++) {
        for (int k = 0; k < columns; k++) {
            double_double sum = double_double_of(0.0);
            for (int j = 0; j < states; j++) {
                sum = double_double_add(sum,
                                        double_double_mul(a[i * columns + j], b[j * columns + k]));
            }
            to[i * columns + k] = sum;
        }
    }
}

/* As exponential_exact(), but only the series up to the power `order`. With order 4, this is a step of RK4. */
static void exponential_series(double_double *step, int states, int columns, int order) {
    const int count = states * columns;
    double_double *power = alloc(count, sizeof *power);
    double_double *next = alloc(count, sizeof *next);
    double_double *of = alloc(count, sizeof *of);
    memcpy(of, step, (size_t)count * sizeof *of);
    memcpy(power, step, (size_t)count * sizeof *power);
    for (int k = 2; k <= order; k++) {
        product(of, power, states, columns, next);
        for (int i = 0; i < count; i++) {
            power[i] = double_double_div(next[i], double_double_of((double)k));
            step[i] = double_double_add(step[i], power[i]);
        }
    }
    free(power);
    free(next);
    free(of);
}

static double norm(const double_double *a, int states, int columns) {
    double most = 0.0;
    for (int i = 0; i < states; i++) {
        double sum = 0.0;
        for (int j = 0; j < states; j++) {
            sum += fabs(a[i * columns + j].high);
        }
        most = sum > most || isnan(sum) ? sum : most;
    }
    return most;
}

/* The sum of the absolute values in row i of A, or in column i if `row` is false, without the diagonal. */
static double off_diagonal(const double_double *a, int i, bool row, int states, int columns) {
    double sum = 0.0;
    for (int j = 0; j < states; j++) {
        sum += j == i ? 0.0 : fabs(a[row ? i * columns + j : j * columns + i].high);
    }
    return sum;
}

/* Changes the unit of state i to one that is `by` times as large. */
static void in_units(double_double *a, int i, double by, int states, int columns) {
    for (int j = 0; j < columns; j++) {
        a[i * columns + j] = double_double_scale(a[i * columns + j], 1.0 / by);
    }
    for (int j = 0; j < states; j++) {
        a[j * columns + i] = double_double_scale(a[j * columns + i], by);
    }
}

/* Balances A by powers of two (Parlett & Reinsch, Numerische Mathematik 13 (1969) 293). */
static void balance(double_double *a, double *unit, int states, int columns) {
    for (int i = 0; i < states; i++) {
        unit[i] = 1.0;
    }
    for (int round = 0; round < 20; round++) {
        for (int i = 0; i < states; i++) {
            const double row = off_diagonal(a, i, true, states, columns);
            const double column = off_diagonal(a, i, false, states, columns);
            double by = 1.0;
            while (row > 0.0 && column > 0.0 && column * by * 2.0 <= row / by) {
                by *= 2.0;
            }
            while (row > 0.0 && column > 0.0 && row / by * 2.0 <= column * by) {
                by /= 2.0;
            }
            in_units(a, i, by, states, columns);
            unit[i] *= by;
        }
    }
}

#define LEAST_PART 0x1p-100 /* an entry below this, relative to its row's largest, becomes zero */

static void drop_least(double_double *step, int states, int columns) {
    for (int i = 0; i < states; i++) {
        double most = 0.0;
        for (int j = 0; j < states; j++) {
            const double size = fabs(step[i * columns + j].high);
            most = size > most ? size : most;
        }
        for (int j = 0; j < states; j++) {
            if (fabs(step[i * columns + j].high) < LEAST_PART * most) {
                step[i * columns + j] = double_double_of(0.0);
            }
        }
    }
}

/* Replaces step = [A B c] h by the first `states` rows of exp([A B c; 0 0 0] h) - 1. Squaring exp - 1 instead of exp
 * keeps the digits of small changes (Moler & Van Loan, Nineteen Dubious Ways to Compute the Exponential of a Matrix,
 * method 3). Returns false if the matrix is too large. */
static bool exponential_exact(double_double *step, int states, int columns) {
    const int count = states * columns;
    double *unit = alloc(states, sizeof *unit);
    double_double *square = alloc(count, sizeof *square);
    int halvings = 0;
    balance(step, unit, states, columns);
    double size = norm(step, states, columns);
    for (; halvings < HALVINGS_MOST && size > 0.5; halvings++) {
        size /= 2.0;
    }
    bool good = size <= 0.5;
    for (int i = 0; i < count; i++) {
        step[i] = double_double_scale(step[i], number_scaled(1.0, -halvings));
    }
    exponential_series(step, states, columns, POWERS);
    for (; halvings > 0 && good; halvings--) { /* (1 + E)^2 = 1 + 2 E + E^2 */
        product(step, step, states, columns, square);
        for (int i = 0; i < count; i++) {
            step[i] = double_double_add(double_double_scale(step[i], 2.0), square[i]);
        }
    }
    drop_least(step, states, columns);
    for (int i = 0; i < states; i++) {
        in_units(step, i, 1.0 / unit[i], states, columns);
    }
    free(unit);
    free(square);
    return good;
}

/* === the matrix of a step ===================================================================== */

static bool is_possible(const image *im, diags *errors) {
    static const char hint[] = "leave out --matrix";
    if (im->contacts > 0) {
        diag_error(errors, im->contact[0].at,
                   "leave the effect out with --without EFFECT, or leave out --matrix",
                   "--matrix is not for scenes with events: '%s' has this %s", im->name,
                   im->contact[0].word);
    } else if (im->ledger.kept) {
        diag_error(
            errors, im->at, "--without ledger, or leave out --matrix",
            "the ledger of '%s' needs the stages of a step, which steps with --matrix do not have",
            im->name);
    } else if (im->settings.tables != TABLES_NONE) {
        diag_error(
            errors, im->at, "leave out --tables, or --matrix",
            "--matrix %s and --tables %s exclude each other: a step by one matrix looks up no tables",
            image_matrix_words[im->settings.matrix], image_tables_words[im->settings.tables]);
    } else if (im->settings.method != WH_METHOD_DEFAULT) {
        diag_error(
            errors, im->at, "leave out --method, or --matrix",
            "--matrix %s and --method %s exclude each other: the matrix takes the place of the method's stages",
            image_matrix_words[im->settings.matrix], wh_methods[im->settings.method].word);
    } else if (affine_states(im) == 0) {
        diag_error(errors, im->at, hint, "'%s' has no coordinate or state to integrate", im->name);
    } else {
        return true;
    }
    return false;
}

/* The operation for a column that is not a turn angle: a state, an input or the constant 1. */
static int leaf(const image *im, op_list *t, int column) {
    const int real = column - im->angles;
    const int linears = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    if (real >= im->reals + im->inputs) {
        return op_list_constant(t, 1.0);
    }
    if (real >= im->reals) {
        return op_list_leaf(t, OP_INPUT, real - im->reals);
    }
    return real < linears ? op_list_leaf(t, OP_LINEAR, real)
                          : op_list_leaf(t, OP_RATE, real - linears);
}

/* Enters the sum of row[k] times the operation for column k. constant() rounds row[k] first. */
static int enter_row(const image *im, op_list *t, const double_double *row,
                     double (*constant)(double_double entry)) {
    int sum = op_list_constant(t, 0.0);
    for (int k = 0; k < affine_columns(im); k++) {
        const double entry = constant(row[k]);
        if (entry != 0.0) {
            sum = op_list_add(t, sum, op_list_mul(t, op_list_constant(t, entry), leaf(im, t, k)));
        }
    }
    return sum;
}

/* Enters the row with 1 added to row[of]. A small row[of] would lose digits in row[of] + 1. */
static int enter_near(const image *im, op_list *t, double_double *row, int of) {
    if (row[of].high < -0.5 || row[of].high > 1.0) {
        row[of] = double_double_add(row[of], double_double_of(1.0));
        return enter_row(im, t, row, double_double_constant);
    }
    return op_list_add(t, leaf(im, t, of), enter_row(im, t, row, double_double_constant));
}

/* The part of an entry beyond a float's digits; 0 if a float cannot represent that part. */
static double rest(double_double entry) {
    const double beyond = double_double_beyond_float(entry);
    return fits_float(beyond) ? beyond : 0.0;
}

/* On entry, row[] is the change of turn angle i in a step of length h. Enters the change divided by h. */
static int enter_angle(const image *im, op_list *t, double_double *row, int i, double_double h) {
    for (int k = 0; k < affine_columns(im); k++) {
        row[k] = double_double_div(row[k], h);
    }
    if (im->form != WH_SECOND_ORDER) {
        return enter_row(im, t, row, double_double_constant);
    }
    const int rate = im->coordinates + i;
    row[rate] = double_double_sub(row[rate], double_double_of(1.0));
    return enter_near(im, t, row, rate);
}

/* Returns the list of a step. `change`, the changes in a step of length h, is overwritten. */
static op_list *make_list(const image *im, double_double *change, double_double h) {
    const int states = affine_states(im);
    const bool compensated = im->settings.compensated;
    op_list *t = op_list_new(im->angles, states + (compensated ? im->reals : 0));
    t->folding = im->list[IMAGE_STEP]->folding;
    for (int i = 0; i < states; i++) {
        double_double *row = change + (ptrdiff_t)i * affine_columns(im);
        if (i < im->angles) {
            t->result[i] = enter_angle(im, t, row, i, h);
        } else if (compensated) {
            t->result[i] = enter_row(im, t, row, double_double_constant);
            t->result[im->reals + i] = enter_row(im, t, row, rest);
        } else {
            t->result[i] = enter_near(im, t, row, i);
        }
    }
    op_list_prune(t);
    op_list_order(t);
    return t;
}

static void keep_numbers(image_draft *d, const double_double *change) {
    image *im = d->made;
    image_matrix *m = &im->matrix;
    m->states = affine_states(im);
    m->columns = affine_columns(im);
    m->entry = image_room(d, m->states * m->columns, sizeof *m->entry);
    for (int i = 0; i < m->states; i++) {
        for (int k = 0; k < m->columns; k++) {
            const double_double entry = change[i * m->columns + k];
            m->entry[i * m->columns + k] =
                k == i ? double_double_add(entry, double_double_of(1.0)).high : entry.high;
        }
    }
}

/* On entry, change[] has the result of affine_rates(). */
static bool make(image_draft *d, double_double *change, diags *errors) {
    image *im = d->made;
    const int states = affine_states(im);
    const int columns = affine_columns(im);
    const double_double h = im->step.denominator != 0
                                ? double_double_ratio(im->step.numerator, im->step.denominator)
                                : double_double_of(im->step_s);
    bool good = true;
    for (int i = 0; i < states * columns; i++) {
        change[i] = double_double_mul(change[i], h);
    }
    if (im->settings.matrix == MATRIX_EXACT) {
        good = exponential_exact(change, states, columns);
    } else {
        exponential_series(change, states, columns, wh_methods[WH_RK4].order);
    }
    for (int i = 0; i < states * columns; i++) {
        good = good && double_double_is_finite(change[i]);
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

bool matrix_make(image_draft *d, const equations *e, diags *errors) {
    image *im = d->made;
    if (!is_possible(im, errors)) {
        return false;
    }
    double_double *change = alloc((int64_t)affine_states(im) * affine_columns(im), sizeof *change);
    const bool affine = affine_rates(im, change);
    const bool good = affine && make(d, change, errors);
    if (!affine) {
        report_nonlinear(im, e, errors);
    }
    free(change);
    return good;
}
