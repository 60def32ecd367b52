/* undefined.c: finding the expression that is no finite number. */
#include "undefined.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/arena.h"
#include "host/derive/contact_lists.h"
#include "host/lang/value.h"
#include "statement.h"

static const char hint_domain[] =
    "a root or logarithm of what is below zero, or a division by zero: keep the motion, or the "
    "expression, away from it";

/* The state somewhere on its way, as expressions and polys ask for it. */
typedef struct view {
    const undefined_at *at;
    double **state; /* [unknowns][order + 1] value, rate, ... */
    valuation values;
} view;

/* The unknowns at the last good state and their derivatives, moved on by `ahead_s`. */
static view look(const undefined_at *at, double ahead_s, diags *errors) {
    const program *p = at->program;
    const instance *inst = at->instance;
    const mechanism *m = inst->mechanism;
    struct arena *memory = inst->arena;
    view v = {.at = at, .values = valuation_new(m, memory, errors)};
    double *result = arena_alloc(memory, ((size_t)p->books->results + 1) * sizeof *result);
    double *input = arena_alloc(memory, ((size_t)p->inputs + 1) * sizeof *input);
    evaluator *ev = evaluator_new(p->books);
    program_inputs(p, inst, input);
    evaluator_run(ev, 0.0, at->angle_rad, at->real, at->real + (p->coordinates - p->angles), input,
                  result);
    evaluator_free(ev);
    v.state = arena_alloc(memory, ((size_t)p->count + 1) * sizeof *v.state);
    for (int i = 0; i < p->count; i++) {
        const int order = at->equations->unknowns[i].order;
        v.state[i] = arena_alloc(memory, ((size_t)order + 3) * sizeof **v.state);
        for (int k = 0; k < inst->start_count[i]; k++) {
            v.state[i][k] = inst->start[i][k]; /* of what is recovered from its momentum */
        }
        v.state[i][order] = isfinite(result[i]) ? result[i] : 0.0;
    }
    for (int i = 0; i < p->angles; i++) {
        v.state[p->angle[i].unknown][0] = at->angle_rad[i];
    }
    for (int i = 0; i < p->reals; i++) {
        v.state[p->real[i].unknown][p->real[i].primes] = at->real[i];
    }
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < at->equations->unknowns[i].order; k++) {
            v.state[i][k] += ahead_s * v.state[i][k + 1];
        }
    }
    for (int i = 0; i < m->parameter_count; i++) {
        v.values.parameter[i] = inst->parameter[i];
        v.values.parameter_state[i] = 2;
    }
    v.values.input = inst->input;
    v.values.state = v.state;
    v.values.primes_most =
        PROGRAM_COMPONENTS_MAX; /* the parser lets no more through than there are */
    return v;
}

static double symbol_at(void *context, const symbol *s, int primes) {
    const view *v = context;
    if (s->kind == SYM_PARAMETER) {
        return v->at->instance->parameter[s->index];
    }
    if (s->kind == SYM_INPUT) {
        return v->at->instance->input[s->index];
    }
    if ((s->kind == SYM_COORDINATE || s->kind == SYM_STATE) && primes <= s->order) {
        return v->state[s->index][primes];
    }
    return 0.0;
}

static bool is_finite(view *v, const poly *p) { return isfinite(poly_evaluate(p, symbol_at, v)); }

/* The innermost part of the tree that is not finite though its operands are; NULL when the tree is. */
static const expr *innermost(const expr *tree, view *v) {
    if (tree == NULL || isfinite(expr_value(tree, &v->values))) {
        return NULL;
    }
    const expr *part = innermost(tree->left, v);
    part = part != NULL ? part : innermost(tree->right, v);
    if (part == NULL && tree->op == EXPR_SYMBOL && tree->symbol->kind == SYM_LET) {
        part = innermost(tree->symbol->value, v);
    }
    return part != NULL ? part : tree;
}

/* Reports `what` at the innermost part, where that stands in the line of the statement at `where`. */
static void report(const view *v, place where, const expr *part, const char *what, diags *errors) {
    char text[STATEMENT_SIZE];
    const bool same =
        part != NULL && part->at.source == where.source && part->at.line == where.line;
    statement_text(where, text, sizeof text);
    diag_error(errors, same ? part->at : where, hint_domain, "%s %s is not a finite number: %s",
               v->at->when, what, text);
}

/* Not finite itself? Then it is reported. */
static bool check(view *v, place where, const expr *tree, const char *what, diags *errors) {
    const expr *part = innermost(tree, v);
    if (part != NULL) {
        report(v, where, part, what, errors);
    }
    return part != NULL;
}

/* Its slope along a coordinate, or with `rates` along a coordinate's rate? */
static bool check_slopes(view *v, place where, const expr *tree, const char *what, bool rates,
                         diags *errors) {
    algebra *a = v->at->equations->algebra;
    const poly *value = poly_from_expr(a, tree);
    const mechanism *m = v->at->instance->mechanism;
    for (int i = 0; i < m->coordinate_count; i++) {
        for (int primes = 0; primes <= (rates ? 1 : 0); primes++) {
            if (!is_finite(v, poly_derivative(a, value, m->coordinates[i], primes))) {
                report(v, where, NULL, what, errors);
                return true;
            }
        }
    }
    return false;
}

/* --- where to look -----------------------------------------------------------------------------*/

/* Tries `find` on the state and on the way that it was about to go. */
static bool look_ahead(const undefined_at *at, bool (*find)(view *v, int which, diags *errors),
                       int which, diags *errors) {
    static const double shares[] = {0.0, 0.25, 0.5, 0.75, 1.0, 1.01, 1.5, 2.0};
    for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++) {
        if (shares[i] == 0.0 || shares[i] <= 2.0 * at->ahead_steps) {
            view v = look(at, shares[i] * at->instance->step_s, errors);
            if (find(&v, which, errors)) {
                return true;
            }
        }
    }
    return false;
}

static bool find_term(view *v, int which, diags *errors) {
    const mechanism *m = v->at->instance->mechanism;
    (void)which;
    for (int i = 0; i < m->term_count; i++) {
        const term *t = &m->terms[i];
        char slope[80];
        if (!instance_has_term(v->at->instance, t)) {
            continue;
        }
        if (check(v, t->at, t->value, term_part(t->kind), errors) ||
            (t->right != NULL && check(v, t->at, t->right, term_part(t->kind), errors))) {
            return true;
        }
        snprintf(slope, sizeof slope, "the slope of %s", term_part(t->kind));
        const bool energy = t->kind == TERM_T || t->kind == TERM_V || t->kind == TERM_F;
        if (energy && check_slopes(v, t->at, t->value, slope, true, errors)) {
            return true;
        }
    }
    return false;
}

bool undefined_term(const undefined_at *at, diags *errors) {
    return look_ahead(at, find_term, 0, errors);
}

/* --- contacts ----------------------------------------------------------------------------------*/

static bool find_contact(view *v, int k, diags *errors) {
    const contact_statement *h = v->at->program->contacts->row[k].from;
    switch (h->kind) {
    case CONTACT_STOP:
        return check(v, h->at, h->value, "the gap of this stop", errors) ||
               check_slopes(v, h->at, h->value, "the rate of the gap of this stop", false, errors);
    case CONTACT_HOLD:
        return check(v, h->at, h->condition, "the condition of this hold", errors) ||
               check(v, h->at, h->value, "what this hold holds", errors) ||
               check_slopes(v, h->at, h->value, "the rate of what this hold holds", false, errors);
    case CONTACT_FRICTION:
        return check(v, h->at, h->normal, "the normal force of this friction", errors) ||
               check(v, h->at, h->static_friction, "the static coefficient of this friction",
                     errors) ||
               check(v, h->at, h->kinetic_friction, "the kinetic coefficient of this friction",
                     errors);
    case CONTACT_WHEN: return check(v, h->at, h->value, "the value of this crossing", errors);
    }
    return false;
}

/* Of a stop whose gap is a number: a restitution counts at an impact only, so it comes last. */
static bool find_restitution(view *v, int k, diags *errors) {
    const contact_statement *h = v->at->program->contacts->row[k].from;
    return h->kind == CONTACT_STOP &&
           check(v, h->at, h->restitution, "the restitution of this stop", errors);
}

void undefined_contact(const undefined_at *at, int k, diags *errors) {
    if (look_ahead(at, find_contact, k, errors) || look_ahead(at, find_restitution, k, errors)) {
        return;
    }
    const contact_statement *h = at->program->contacts->row[k].from;
    const view v = {.at = at};
    report(&v, h->at, NULL, contact_undefined(h->kind), errors);
}

static bool find_set(view *v, int which, diags *errors) {
    const contact_lists *c = v->at->program->contacts;
    (void)which;
    for (int k = 0; k < c->count; k++) {
        const contact_statement *h = c->row[k].from;
        for (int i = 0; i < h->set_count && h->kind == CONTACT_WHEN; i++) {
            if (check(v, h->sets[i].at, h->sets[i].value, "the value that is set", errors)) {
                return true;
            }
        }
    }
    return false;
}

bool undefined_set(const undefined_at *at, diags *errors) {
    return at->program->contacts != NULL && look_ahead(at, find_set, 0, errors);
}

/* --- angles ------------------------------------------------------------------------------------*/

/* The largest angle of which the list takes a sine, among those kept as turn angles. */
static double largest_phase(const tape *t, const double *angle_rad) {
    double most = 0.0;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        double sum = o->code == OP_PHASE ? o->value : 0.0;
        for (int k = 0; k < t->angles && o->code == OP_PHASE && o->turns != NULL; k++) {
            sum += o->turns[k] * angle_rad[k];
        }
        most = number_most(most, fabs(sum));
    }
    return most;
}

bool undefined_angle(const undefined_at *at, diags *errors) {
    const program *p = at->program;
    const mechanism *m = at->instance->mechanism;
    const double limit = at->turns ? ANGLE_SINE_MOST_FLOAT_RAD : ANGLE_SINE_MOST_RAD;
    const bool phase = !at->turns && largest_phase(p->books, at->angle_rad) >= limit * (1.0 - 1e-6);
    const symbol *worst = NULL;
    double most = 0.0;
    for (int i = 0; i < p->angles + p->reals; i++) {
        const component c = i < p->angles ? p->angle[i] : p->real[i - p->angles];
        const double value = i < p->angles ? at->angle_rad[i] : at->real[i - p->angles];
        const symbol *s = m->coordinates[c.unknown];
        const bool counts =
            i < p->angles ? phase : s->is_angle && fabs(value) >= limit * (1.0 - 1e-6);
        if (c.primes == 0 && counts && fabs(value) > most) {
            worst = s;
            most = fabs(value);
        }
    }
    if (worst == NULL) {
        return false;
    }
    diag_error(errors, worst->at,
               at->turns ? "start it within a turn: whole turns change nothing in a sine"
                         : "start it within a turn: whole turns change nothing in a sine; or "
                           "--number float, whose angles count turns as integers",
               "%s the angle '%s' is at %.9g rad: sine and cosine are known up to %g rad only",
               at->when, worst->name, most, limit);
    return true;
}

/* --- a step that failed ------------------------------------------------------------------------*/

/* Holds that close a linkage leave it more than one motion where it lies flat (core/contact_rank.h). */
static void say_flat(const undefined_at *at, place where, diags *errors) {
    char text[STATEMENT_SIZE];
    statement_text(where, text, sizeof text);
    diag_error(
        errors, where,
        "give the linkage lengths with which it cannot lie flat, or hold one coordinate more there",
        "%s the holds leave more than one way to go on, this one says no more than the others: "
        "%s",
        at->when, text);
}

bool undefined_step(const equations *e, const program *p, const instance *inst,
                    const engine_kind *kind, const void *run, wh_status status, diags *errors) {
    double angle_rad[PROGRAM_COMPONENTS_MAX];
    double real[2 * PROGRAM_COMPONENTS_MAX];
    char when[80];
    const int fault = kind->fault(run);
    snprintf(when, sizeof when, "in the step after t = %.9g s",
             ratio_times(kind->steps(run), inst->step));
    kind->state(run, angle_rad, real);
    const undefined_at at = {.equations = e,
                             .program = p,
                             .instance = inst,
                             .angle_rad = angle_rad,
                             .real = real,
                             .turns = kind == &engine_float,
                             .ahead_steps = 1.0,
                             .when = when};
    if (undefined_angle(&at, errors)) {
        return true;
    }
    if (status == WH_E_UNDEFINED) {
        undefined_contact(&at, fault, errors);
        return true;
    }
    if (status == WH_E_SINGULAR) {
        say_flat(&at, p->contacts->row[fault].from->at, errors);
        return true;
    }
    return undefined_set(&at, errors) || undefined_term(&at, errors);
}
