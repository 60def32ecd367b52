#include "host/check/nonfinite.h"

#include <math.h>
#include <stdlib.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/base/diag.h"

diagnosis diagnosis_open(const image *im) {
    diagnosis b = {.image = im,
                   .state = alloc(im->count, sizeof *b.state),
                   .input = alloc(im->inputs, sizeof *b.input),
                   .value = alloc(im->diagnostics.nodes, sizeof *b.value)};
    image_inputs(im, b.input);
    for (int i = 0; i < im->count; i++) {
        b.state[i] = alloc(im->unknown[i].order + 1, sizeof **b.state);
    }
    return b;
}

void diagnosis_close(diagnosis *b) {
    for (int i = 0; i < b->image->count; i++) {
        free(b->state[i]);
    }
    free(b->state);
    free(b->input);
    free(b->value);
}

void diagnosis_place(diagnosis *b, const double *angle_rad, const double *real) {
    const image *im = b->image;
    for (int i = 0; i < im->angles; i++) {
        b->state[im->angle[i].unknown][0] = angle_rad[i];
    }
    for (int i = 0; i < im->reals; i++) {
        b->state[im->real[i].unknown][im->real[i].primes] = real[i];
    }
}

double diagnosis_value(const diagnosis *b, const diagnostics_node *n) {
    const double *value = b->value;
    switch (n->code) {
    case DIAGNOSTICS_NUMBER: return n->number;
    case DIAGNOSTICS_STATE:
        return n->b <= b->image->unknown[n->a].order ? b->state[n->a][n->b] : 0.0;
    case DIAGNOSTICS_INPUT: return b->input[n->a];
    case DIAGNOSTICS_SAME: return value[n->a];
    case DIAGNOSTICS_ADD: return value[n->a] + value[n->b];
    case DIAGNOSTICS_SUB: return value[n->a] - value[n->b];
    case DIAGNOSTICS_MUL: return value[n->a] * value[n->b];
    case DIAGNOSTICS_DIV: return value[n->a] / value[n->b];
    case DIAGNOSTICS_POW: return number_power(value[n->a], value[n->b]);
    case DIAGNOSTICS_NEG: return -value[n->a];
    case DIAGNOSTICS_CALL:
        return number_call(n->function, value[n->a], n->b < 0 ? 0.0 : value[n->b]);
    }
    return (double)NAN;
}

int diagnosis_operands(const diagnostics_node *n, int of[static 2]) {
    of[0] = n->a;
    of[1] = n->b;
    switch (n->code) {
    case DIAGNOSTICS_NUMBER:
    case DIAGNOSTICS_STATE:
    case DIAGNOSTICS_INPUT: return 0;
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_NEG: return 1;
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB:
    case DIAGNOSTICS_MUL:
    case DIAGNOSTICS_DIV:
    case DIAGNOSTICS_POW: return 2;
    case DIAGNOSTICS_CALL: return n->b < 0 ? 1 : 2;
    }
    return 0;
}

bool *diagnosis_parts(const image *im, int node) {
    bool *of = alloc((int64_t)node + 1, sizeof *of);
    of[node] = true;
    for (int i = node; i >= 0; i--) {
        int operand[2];
        const int count = of[i] ? diagnosis_operands(&im->diagnostics.node[i], operand) : 0;
        for (int k = 0; k < count; k++) {
            of[operand[k]] = true;
        }
    }
    return of;
}

/* === which expression it is =================================================================== */

static const char hint_domain[] =
    "avoid a root or logarithm of a negative number, a division by zero, or an overflow";

/* --- values ------------------------------------------------------------------------------------*/

static bool is_sine(const diagnostics_node *n) {
    return n->code == DIAGNOSTICS_CALL && (n->function == FN_SIN || n->function == FN_COS);
}

static double sine_limit_rad(const nonfinite_at *at) {
    return at->turns ? ANGLE_SINE_MOST_FLOAT_RAD : ANGLE_SINE_MOST_RAD;
}

/* Is node i a sine outside the range of core/number/sine.h? In float the sine of a turn angle has no such range. */
static bool sine_beyond(const diagnosis *v, int i, const nonfinite_at *at, const bool *turning) {
    const diagnostics_node *n = &v->image->diagnostics.node[i];
    const double angle_rad = is_sine(n) ? v->value[n->a] : 0.0;
    const bool beyond = fabs(angle_rad) >= sine_limit_rad(at) && isfinite(angle_rad);
    return beyond && !(at->turns && turning[n->a]);
}

/* [diagnostics.nodes]: true for nodes that depend on a turn angle. The caller frees it. */
static bool *nodes_that_turn(const image *im) {
    bool *turning = alloc(im->diagnostics.nodes, sizeof *turning);
    for (int i = 0; i < im->diagnostics.nodes; i++) {
        const diagnostics_node *n = &im->diagnostics.node[i];
        int operand[2];
        const int count = diagnosis_operands(n, operand);
        for (int k = 0; k < count; k++) {
            turning[i] = turning[i] || turning[operand[k]];
        }
        for (int k = 0; k < im->angles && n->code == DIAGNOSTICS_STATE; k++) {
            turning[i] = turning[i] || (im->angle[k].unknown == n->a && n->b == 0);
        }
    }
    return turning;
}

/* Evaluates the expressions at a state that is extrapolated by `ahead_s` from the last good state. */
static diagnosis look(const nonfinite_at *at, double ahead_s) {
    const image *im = at->image;
    diagnosis v = diagnosis_open(im);
    const state_list books = state_list_open(im, IMAGE_BOOKS);
    const double *highest = state_list_at(&books, at->angle_rad, at->real);
    for (int i = 0; i < im->count; i++) {
        const image_unknown *u = &im->unknown[i];
        for (int k = 0; k < u->order && k < u->starts; k++) {
            v.state[i][k] = u->start[k]; /* for components that are not in the state */
        }
        v.state[i][u->order] = isfinite(highest[i]) ? highest[i] : 0.0;
    }
    state_list_close(&books);
    diagnosis_place(&v, at->angle_rad, at->real);
    for (int i = 0; i < im->count; i++) {
        for (int k = 0; k < im->unknown[i].order; k++) {
            v.state[i][k] += ahead_s * v.state[i][k + 1];
        }
    }
    bool *turning = nodes_that_turn(im);
    for (int i = 0; i < im->diagnostics.nodes; i++) {
        const bool unknown = sine_beyond(&v, i, at, turning);
        v.value[i] = unknown ? (double)NAN : diagnosis_value(&v, &im->diagnostics.node[i]);
    }
    free(turning);
    return v;
}

/* --- questions ---------------------------------------------------------------------------------*/

/* The innermost part of `node` that is not finite but has finite operands; -1 if `node` is finite. */
static int innermost(const diagnosis *v, int node) {
    int operand[2];
    int part = -1;
    if (isfinite(v->value[node])) {
        return -1;
    }
    const int count = diagnosis_operands(&v->image->diagnostics.node[node], operand);
    for (int k = 0; k < count && part < 0; k++) {
        part = innermost(v, operand[k]);
    }
    return part >= 0 ? part : node;
}

/* Reports that `what` is not finite, at the place `part` of the statement at `where`. */
static void report(const nonfinite_at *at, place where, place part, const char *what,
                   const char *hint, diags *errors) {
    char text[STATEMENT_SIZE];
    const bool same = part.source != NULL && part.source == where.source && part.line == where.line;
    statement_text(where, text, sizeof text);
    diag_error(errors, same ? part : where, hint, "%s %s is not a finite number: %s", at->when,
               what, text);
}

/* A hint for node i, the innermost one that is not finite. */
static const char *hint_of(const diagnosis *v, int i, const nonfinite_at *at) {
    static char hint[240];
    const diagnostics_node *n = &v->image->diagnostics.node[i];
    const bool sine = is_sine(n) && isfinite(v->value[n->a]);
    snprintf(
        hint, sizeof hint,
        "the value is %s() of %.6g rad, but sine and cosine are computed only up to %g rad: start "
        "the angle within a turn%s",
        function_name(n->function), sine ? v->value[n->a] : 0.0, sine_limit_rad(at),
        at->turns ? "" : ", or use --number float, which stores an angle as a fraction of a turn");
    return sine ? hint : hint_domain;
}

static bool find(const diagnosis *v, const nonfinite_at *at, int first, int count, diags *errors) {
    const image_diagnostics *b = &v->image->diagnostics;
    for (int i = first; i < first + count; i++) {
        const diagnostics_question *q = &b->question[i];
        if (!isfinite(v->value[q->node])) {
            const place none = {.source = NULL};
            const int inner = innermost(v, q->node);
            const place part = q->derived ? none : b->node[inner].at;
            report(at, q->where, part, q->what, hint_of(v, inner, at), errors);
            return true;
        }
    }
    return false;
}

/* Calls find() for the last good state, then for states that are extrapolated from it. */
static bool look_ahead(const nonfinite_at *at, int first, int count, diags *errors) {
    static const double shares[] = {0.0, 0.25, 0.5, 0.75, 1.0, 1.01, 1.5, 2.0};
    bool found = false;
    for (size_t i = 0; i < sizeof shares / sizeof shares[0] && !found; i++) {
        if (shares[i] == 0.0 || shares[i] <= 2.0 * at->ahead_steps) {
            diagnosis v = look(at, shares[i] * at->image->step_s);
            found = find(&v, at, first, count, errors);
            diagnosis_close(&v);
        }
    }
    return found;
}

bool nonfinite_term(const nonfinite_at *at, diags *errors) {
    return look_ahead(at, 0, at->image->diagnostics.terms, errors);
}

bool nonfinite_set(const nonfinite_at *at, diags *errors) {
    const image_diagnostics *b = &at->image->diagnostics;
    return b->sets > 0 && look_ahead(at, b->terms, b->sets, errors);
}

void nonfinite_contact(const nonfinite_at *at, int k, diags *errors) {
    const image_contact *c = &at->image->contact[k];
    if (!look_ahead(at, c->first_question, c->questions, errors) &&
        !look_ahead(at, c->first_late, c->late, errors)) {
        report(at, c->at, (place){.source = NULL}, c->undefined, hint_domain, errors);
    }
}

bool nonfinite_energies(const image *im, const engine_kind *kind, const double *state,
                        double time_s, diags *errors) {
    char when[60];
    snprintf(when, sizeof when, "at t = %.9g s", time_s);
    const nonfinite_at at = {.image = im,
                             .angle_rad = state,
                             .real = state + im->angles,
                             .turns = kind == &engine_float,
                             .when = when};
    return nonfinite_term(&at, errors);
}

/* --- a step that failed ------------------------------------------------------------------------*/

/* For WH_E_SINGULAR: see core/contact/contact_rank.h. */
static void say_flat(const nonfinite_at *at, place where, diags *errors) {
    char text[STATEMENT_SIZE];
    statement_text(where, text, sizeof text);
    diag_error(
        errors, where,
        "choose lengths with which the linkage cannot lie flat, or hold one more coordinate in the flat position",
        "%s the holds allow more than one motion, because this hold follows from the others at "
        "this position: %s",
        at->when, text);
}

bool nonfinite_step(const image *im, const engine_kind *kind, const void *run, wh_status status,
                    diags *errors) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    char when[80];
    const int fault = kind->fault(run);
    snprintf(when, sizeof when, "in the step after t = %.9g s",
             ratio_times(kind->steps(run), im->step));
    kind->state(run, angle_rad, real);
    const nonfinite_at at = {.image = im,
                             .angle_rad = angle_rad,
                             .real = real,
                             .turns = kind == &engine_float,
                             .ahead_steps = 1.0,
                             .when = when};
    if (status == WH_E_UNDEFINED) {
        nonfinite_contact(&at, fault, errors);
        return true;
    }
    if (status == WH_E_SINGULAR) {
        say_flat(&at, im->contact[fault].at, errors);
        return true;
    }
    return nonfinite_set(&at, errors) || nonfinite_term(&at, errors);
}
