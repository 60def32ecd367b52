/* matrix_make.c: the whole step of a linear scene as one matrix. */
#include "host/derive/matrix_make.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/number/folding.h"
#include "host/number/functions.h"

/* A sum that is smaller than this, relative to its addends, counts as zero, as in host/algebra. Otherwise the round-off
 * of decimal parameters would be a spurious spring between two masses that move together. */
#define GHOST 1e-14

static int affine_states(const image *im) { return im->angles + im->reals; }
int affine_columns(const image *im) { return affine_states(im) + im->inputs + 1; }

/* Returns the column of a leaf, or -1 if it is neither state nor input. */
static int column_of(const image *im, const op *o) {
    if (o->code == OP_LINEAR) {
        return im->angles + o->a;
    }
    if (o->code == OP_RATE) { /* rates follow all positions, angles included */
        return im->coordinates + o->a;
    }
    return o->code == OP_INPUT ? affine_states(im) + o->a : -1;
}

static bool is_constant(const twofold *c, int columns) {
    bool constant = true;
    for (int i = 0; i < columns - 1; i++) {
        constant = constant && double_double_is_zero(c[i]);
    }
    return constant;
}

static twofold sum(twofold a, twofold b) {
    const twofold both = double_double_add(a, b);
    return folding_cancels(both.high, fabs(a.high) + fabs(b.high), GHOST) ? double_double_of(0.0)
                                                                          : both;
}

static void add(const twofold *a, const twofold *b, double sign, int columns, twofold *to) {
    for (int i = 0; i < columns; i++) {
        to[i] = sum(a[i], double_double_scale(b[i], sign));
    }
}

static void multiply(const twofold *a, twofold factor, int columns, twofold *to) {
    for (int i = 0; i < columns; i++) {
        to[i] = double_double_mul(a[i], factor);
    }
}

/* Computes the coefficients of operation `o` from those of all earlier operations. Returns false if `o` is not
 * affine. */
static bool step(const image *im, const op *o, const twofold *all, twofold *to) {
    const int columns = affine_columns(im);
    const twofold *a = all + (ptrdiff_t)(o->a >= 0 ? o->a : 0) * columns;
    const twofold *b = all + (ptrdiff_t)(o->b >= 0 ? o->b : 0) * columns;
    const int last = columns - 1;
    switch (o->code) {
    case OP_CONSTANT: to[last] = double_double_of(o->value); return true;
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT: to[column_of(im, o)] = double_double_of(1.0); return true;
    case OP_ADD: add(a, b, 1.0, columns, to); return true;
    case OP_SUB: add(a, b, -1.0, columns, to); return true;
    case OP_NEG: multiply(a, double_double_of(-1.0), columns, to); return true;
    case OP_MUL:
        if (is_constant(a, columns)) {
            multiply(b, a[last], columns, to);
        } else if (is_constant(b, columns)) {
            multiply(a, b[last], columns, to);
        } else {
            return false;
        }
        return true;
    case OP_DIV:
        if (!is_constant(b, columns)) {
            return false;
        }
        for (int i = 0; i < columns; i++) {
            to[i] = double_double_div(a[i], b[last]);
        }
        return true;
    case OP_PHASE:
    case OP_CELL: return true; /* no coefficients: an operation on such a value is not affine */
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

int affine_rates(const image *im, twofold *rates) {
    const op_list *t = im->list[IMAGE_STEP];
    const int columns = affine_columns(im);
    const size_t row = (size_t)columns * sizeof *rates;
    twofold *all = alloc((int64_t)t->count * columns, sizeof *all);
    int bad = -1;
    for (int i = 0; i < t->count && bad < 0; i++) {
        bad = step(im, &t->ops[i], all, all + (ptrdiff_t)i * columns) ? -1 : i;
    }
    if (bad < 0) {
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
    return bad;
}

/* Sets taking[columns] for the columns on which operation `number` of the step's list depends, turn angles included. */
static void affine_takes(const image *im, int number, bool *taking) {
    const op_list *t = im->list[IMAGE_STEP];
    bool *needed = alloc(number + 1, sizeof *needed);
    op_list_mark_needed(t, number, needed);
    for (int i = number; i >= 0; i--) {
        const op *o = &t->ops[i];
        if (!needed[i]) {
            continue;
        }
        const int column = column_of(im, o);
        if (column >= 0) {
            taking[column] = true;
        }
        for (int k = 0; k < t->angles && o->turns != NULL; k++) {
            taking[k] = taking[k] || o->turns[k] != 0;
        }
    }
    free(needed);
}

/* === the report of a nonlinear term =========================================================== */

/* The degree of an expression that is not a polynomial. It is small enough that sums of degrees fit into an int. */
enum { NO_POWER = 1000 };

/* The dependencies of a node of the blame list. */
typedef struct made_of {
    int degree;      /* degree in states, rates and inputs together */
    uint64_t states; /* a bit for each unknown; unknowns beyond 64 share bits */
    uint64_t inputs; /* a bit for each input, in the same way */
} made_of;

static uint64_t bit(int number) { return UINT64_C(1) << (number % 64); }

static int capped(int degree) { return degree > NO_POWER ? NO_POWER : degree; }

static int power(const image_blame *b, const made_of *of, const diagnostics_node *n) {
    const diagnostics_node *exponent = &b->node[n->b];
    const double e = exponent->code == DIAGNOSTICS_NUMBER ? exponent->number : -1.0;
    if (of[n->a].degree == 0 && of[n->b].degree == 0) {
        return 0;
    }
    for (int whole = 0; whole <= 8; whole++) {
        if (e == (double)whole) {
            return whole * of[n->a].degree;
        }
    }
    return NO_POWER;
}

static made_of node_made_of(const image_blame *b, const made_of *of, int i) {
    const diagnostics_node *n = &b->node[i];
    const bool has_a = n->code != DIAGNOSTICS_NUMBER && n->code != DIAGNOSTICS_STATE &&
                       n->code != DIAGNOSTICS_INPUT;
    const made_of none = {0, 0, 0};
    const made_of x = has_a ? of[n->a] : none;
    const made_of y =
        has_a && n->code != DIAGNOSTICS_SAME && n->code != DIAGNOSTICS_NEG && n->b >= 0 ? of[n->b]
                                                                                        : none;
    made_of both = {0, x.states | y.states, x.inputs | y.inputs};
    switch (n->code) {
    case DIAGNOSTICS_NUMBER: break;
    case DIAGNOSTICS_STATE: both = (made_of){1, bit(n->a), 0}; break;
    case DIAGNOSTICS_INPUT: both = (made_of){1, 0, bit(n->a)}; break;
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_NEG: both.degree = x.degree; break;
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB: both.degree = x.degree > y.degree ? x.degree : y.degree; break;
    case DIAGNOSTICS_MUL: both.degree = capped(x.degree + y.degree); break;
    case DIAGNOSTICS_DIV: both.degree = y.degree == 0 ? x.degree : NO_POWER; break;
    case DIAGNOSTICS_POW: both.degree = capped(power(b, of, n)); break;
    case DIAGNOSTICS_CALL: both.degree = x.degree == 0 && y.degree == 0 ? 0 : NO_POWER; break;
    }
    return both;
}

/* Does the operation pass the degree of one operand on to its result, unchanged? `other` is the degree of the other
 * operand. */
static bool passes_on(diagnostics_code code, int other) {
    switch (code) {
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_NEG:
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB: return true;
    case DIAGNOSTICS_MUL:
    case DIAGNOSTICS_DIV: return other == 0;
    case DIAGNOSTICS_POW:
    case DIAGNOSTICS_CALL:
    case DIAGNOSTICS_NUMBER:
    case DIAGNOSTICS_STATE:
    case DIAGNOSTICS_INPUT: return false;
    }
    return false;
}

/* `node` has a degree above `most`. Returns the innermost node below it that alone is the reason. */
static int innermost(const image_blame *b, const made_of *of, int node, int most) {
    for (;;) {
        const diagnostics_node *n = &b->node[node];
        const bool has_b = n->code != DIAGNOSTICS_SAME && n->code != DIAGNOSTICS_NEG && n->b >= 0;
        const int degree_a = of[n->a].degree;
        const int degree_b = has_b ? of[n->b].degree : 0;
        if (degree_a > (passes_on(n->code, degree_b) ? most : NO_POWER - 1)) {
            node = n->a;
        } else if (degree_b > (passes_on(n->code, degree_a) ? most : NO_POWER - 1)) {
            node = n->b;
        } else {
            return node;
        }
    }
}

/* Returns the names of the dependencies, such as "theta", "x and y" or "x, y and M". */
static char *names(const image *im, made_of of) {
    char *text = NULL;
    size_t length = 0;
    const char *name[128];
    int count = 0;
    for (int i = 0; i < im->count && count < 64; i++) {
        if ((of.states & bit(i)) != 0) {
            name[count++] = im->unknown[i].name;
        }
    }
    for (int i = 0; i < im->inputs && count < 128; i++) {
        if ((of.inputs & bit(i)) != 0) {
            name[count++] = im->input[i].name;
        }
    }
    FILE *out = alloc_text(&text, &length);
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s%s", i == 0 ? "" : i + 1 < count ? ", " : " and ", name[i]);
    }
    alloc_text_end(out);
    return text;
}

static void report(const image *im, const made_of *of, int node, place where, diags *errors) {
    const diagnostics_node *n = &im->blame.node[node];
    const place at = n->at.source != NULL ? n->at : where;
    char *of_what = names(im, of[node]);
    char line[STATEMENT_SIZE];
    char what[64];
    statement_text(at, line, sizeof line);
    switch (n->code) {
    case DIAGNOSTICS_CALL:
        snprintf(what, sizeof what, "%s() of", function_name(n->function));
        break;
    case DIAGNOSTICS_DIV: snprintf(what, sizeof what, "a division by an expression of"); break;
    case DIAGNOSTICS_POW: snprintf(what, sizeof what, "a power of"); break;
    case DIAGNOSTICS_NUMBER:
    case DIAGNOSTICS_STATE:
    case DIAGNOSTICS_INPUT:
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB:
    case DIAGNOSTICS_MUL:
    case DIAGNOSTICS_NEG:
        snprintf(what, sizeof what, "a %s of", strchr(of_what, ' ') != NULL ? "product" : "power");
        break;
    }
    diag_error(errors, at, "leave out --matrix: it is only for linear equations",
               "%s %s in line %d makes '%s' not linear, so its step is not a matrix: %s", what,
               of_what, at.line, im->name, line);
    free(of_what);
}

/* Reports that `operation` of the step's list is not linear. The image needs a blame list. */
static void not_linear_report(const image *im, int operation, diags *errors) {
    const image_blame *b = &im->blame;
    const int states = affine_states(im);
    made_of *of = alloc(b->nodes, sizeof *of);
    bool *taking = alloc(affine_columns(im), sizeof *taking);
    made_of wanted = {0, 0, 0};
    bool found = false;
    affine_takes(im, operation, taking);
    for (int i = 0; i < states + im->inputs; i++) {
        if (!taking[i]) {
            continue;
        }
        if (i < states) {
            wanted.states |= bit(image_component(im, i).unknown);
        } else {
            wanted.inputs |= bit(i - states);
        }
    }
    for (int i = 0; i < b->nodes; i++) {
        of[i] = node_made_of(b, of, i);
    }
    for (int k = 0; k < b->terms && !found; k++) {
        const diagnostics_question *q = &b->question[k];
        const int node =
            q->derived || of[q->node].degree <= q->power ? -1 : innermost(b, of, q->node, q->power);
        if (node >= 0 && ((of[node].states & wanted.states) | (of[node].inputs & wanted.inputs))) {
            report(im, of, node, q->where, errors);
            found = true;
        }
    }
    if (!found) {
        wanted.degree = NO_POWER;
        char *of_what = names(im, wanted);
        diag_error(errors, im->mechanism_at, "leave out --matrix: it is only for linear equations",
                   "the equations of '%s' are not linear in %s, so their step is not a matrix",
                   im->mechanism, of_what);
        free(of_what);
    }
    free(of);
    free(taking);
}

/* === the change in one step of x' = A x + B u + c, with constant u ============================= */

/* Each halving of the step needs a squaring, which may lose one of the 104 bits. After 50 squarings, a double's digits
 * remain. */
enum { HALVINGS_MOST = 50 };

/* Number of terms of the series. For a matrix of norm 1/2 or less, the remainder is then 2^-110 of the matrix. */
enum { POWERS = 26 };

/* Computes the product to = a * b, with the first `states` columns of `a`; `b` has as many columns as `to`. */
static void product(const twofold *a, const twofold *b, int states, int columns, twofold *to) {
    for (int i = 0; i < states; i++) {
        for (int k = 0; k < columns; k++) {
            twofold sum = double_double_of(0.0);
            for (int j = 0; j < states; j++) {
                sum = double_double_add(sum,
                                        double_double_mul(a[i * columns + j], b[j * columns + k]));
            }
            to[i * columns + k] = sum;
        }
    }
}

/* As exponential_exact(), but without scaling, and with a series that ends with the power `order`. A Runge-Kutta
 * method with that order and as many stages gives this result, whatever its weights. */
static void exponential_series(twofold *step, int states, int columns, int order) {
    const int count = states * columns;
    twofold *power = alloc(count, sizeof *power);
    twofold *next = alloc(count, sizeof *next);
    twofold *of = alloc(count, sizeof *of);
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

/* Returns the largest sum of absolute entries in a row of A. */
static double norm(const twofold *a, int states, int columns) {
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

/* Returns the sum of the absolute values in row i of A (`row`), or in column i, without the diagonal. */
static double off_diagonal(const twofold *a, int i, bool row, int states, int columns) {
    double sum = 0.0;
    for (int j = 0; j < states; j++) {
        sum += j == i ? 0.0 : fabs(a[row ? i * columns + j : j * columns + i].high);
    }
    return sum;
}

/* Changes the unit of state i to one that is `by` times as large. */
static void in_units(twofold *a, int i, double by, int states, int columns) {
    for (int j = 0; j < columns; j++) {
        a[i * columns + j] = double_double_scale(a[i * columns + j], 1.0 / by);
    }
    for (int j = 0; j < states; j++) {
        a[j * columns + i] = double_double_scale(a[j * columns + i], by);
    }
}

/* Balances A by powers of two, which makes corresponding rows and columns similar in size (Parlett & Reinsch,
 * Numerische Mathematik 13 (1969) 293). Otherwise a stiffness of 1e9 N/m next to a rate of 1e-3 m/s would need many
 * halvings. */
static void balance(twofold *a, double *unit, int states, int columns) {
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

/* An entry below this, relative to the largest in its row in balanced units, becomes zero. Example: the last of twenty
 * masses in a row contributes 1e-60 to the first one's motion within a millisecond, which is below the range of
 * float. */
#define LEAST_PART 0x1p-100

static void drop_least(twofold *step, int states, int columns) {
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

/* On entry, step[states * columns] has the rates A | B | c times the step. On return, it has exp([A B c; 0 0 0] h) -
 * 1 without its lower rows: the change of the states in one step. The method is scaling and squaring of the
 * exponential minus one, which keeps the digits of small changes (Moler & Van Loan, Nineteen Dubious Ways to Compute
 * the Exponential of a Matrix, method 3). The matrix is balanced first. Returns false if a number overflows, or if
 * the scaled steps are so small that digits would be lost; step[] is then invalid. */
static bool exponential_exact(twofold *step, int states, int columns) {
    const int count = states * columns;
    double *unit = alloc(states, sizeof *unit);
    twofold *square = alloc(count, sizeof *square);
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
    for (int i = 0; i < count; i++) {
        good = good && double_double_is_finite(step[i]);
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
        diag_error(errors, im->at, hint, "'%s' has no state to step", im->name);
    } else {
        return true;
    }
    return false;
}

/* Returns the operation for a column: a state, an input or the constant. Columns of turn angles have no entries. */
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

/* Enters the sum of a row's entries, each rounded by constant(), times their columns. */
static int enter_row(const image *im, op_list *t, const twofold *row,
                     double (*constant)(twofold entry)) {
    int sum = op_list_constant(t, 0.0);
    for (int k = 0; k < affine_columns(im); k++) {
        const double entry = constant(row[k]);
        if (entry != 0.0) {
            sum = op_list_add(t, sum, op_list_mul(t, op_list_constant(t, entry), leaf(im, t, k)));
        }
    }
    return sum;
}

/* Enters a row after adding 1 to its entry in column `of`. If the sum is near 1, only its difference from 1 is rounded. */
static int enter_near(const image *im, op_list *t, twofold *row, int of) {
    if (row[of].high < -0.5 || row[of].high > 1.0) {
        row[of] = double_double_add(row[of], double_double_of(1.0));
        return enter_row(im, t, row, double_double_constant);
    }
    return op_list_add(t, leaf(im, t, of), enter_row(im, t, row, double_double_constant));
}

/* Returns the part of an entry beyond a float's digits; 0 if a float cannot represent that part. */
static double rest(twofold entry) {
    const double beyond = double_double_beyond_float(entry);
    return fits_float(beyond) ? beyond : 0.0;
}

/* Enters the mean rate of turn angle i over a step of length h, from the angle's change row[]. For a coordinate it is
 * nearly the rate. */
static int enter_angle(const image *im, op_list *t, twofold *row, int i, twofold h) {
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

/* Returns the list of a step. `change` has the change in a step of length h, and is overwritten. */
static op_list *make_list(const image *im, twofold *change, twofold h) {
    const int states = affine_states(im);
    const bool compensated = im->settings.compensated;
    op_list *t = op_list_new(im->angles, states + (compensated ? im->reals : 0));
    for (int i = 0; i < states; i++) {
        twofold *row = change + (ptrdiff_t)i * affine_columns(im);
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
                k == i ? double_double_add(entry, double_double_of(1.0)).high : entry.high;
        }
    }
}

/* Makes the matrix and its list. On entry, change[] has the rates. */
static bool make(image_draft *d, twofold *change, diags *errors) {
    image *im = d->made;
    const int states = affine_states(im);
    const int columns = affine_columns(im);
    const twofold h = im->step.denominator != 0
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

bool matrix_make(image_draft *d, bool has_blame, bool *wants_blame, diags *errors) {
    image *im = d->made;
    *wants_blame = false;
    if (!is_possible(im, errors)) {
        return false;
    }
    twofold *change = alloc((int64_t)affine_states(im) * affine_columns(im), sizeof *change);
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
