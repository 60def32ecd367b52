/* diagnostic_expressions.c: translation of the model file's expressions, and of their slopes, into nodes. */
#include "diagnostic_expressions.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"

/* node[id] - 1 is the node already made of the poly or atom with this id. If node[id] is 0, there is none yet. */
typedef struct known {
    int *node;
    unsigned room;
} known;

typedef struct maker {
    image_draft *draft;
    image *made;
    const equations *equations;
    int *input; /* [mechanism->input_count] index in image.input, or -1 */
    int *let;   /* [mechanism->let_count] index of its node, or -1 */
    known polys;
    known atoms;
} maker;

static int enter(maker *k, diagnostics_node node) {
    image_diagnostics *b = &k->made->diagnostics;
    b->node = arena_room(k->made->memory, b->node, b->nodes, sizeof *b->node);
    b->node[b->nodes] = node;
    return b->nodes++;
}

static int enter_op(maker *k, diagnostics_code code, function_id function, int a, int b) {
    return enter(k, (diagnostics_node){.code = code, .function = function, .a = a, .b = b});
}

static int enter_number(maker *k, double value) {
    return enter(k, (diagnostics_node){.code = DIAGNOSTICS_NUMBER, .number = value});
}

static int enter_symbol(maker *k, const symbol *s, int primes) {
    const instance *inst = k->equations->instance;
    switch (s->kind) {
    case SYM_PARAMETER: return enter_number(k, inst->parameter[s->index]);
    case SYM_INPUT:
        return k->input[s->index] < 0 ? enter_number(k, inst->input[s->index])
                                      : enter(k, (diagnostics_node){.code = DIAGNOSTICS_INPUT,
                                                                    .a = k->input[s->index]});
    case SYM_COORDINATE:
    case SYM_STATE:
        return enter(k, (diagnostics_node){.code = DIAGNOSTICS_STATE, .a = s->index, .b = primes});
    case SYM_LET: /* of_expr() handles it */
    case SYM_OUTPUT:
    case SYM_RECORD: break; /* not in equations of motion */
    }
    return enter_number(k, (double)NAN);
}

static int of_expr(maker *k, const expr *tree) {
    static const diagnostics_code codes[] = {
        [EXPR_ADD] = DIAGNOSTICS_ADD,  [EXPR_SUB] = DIAGNOSTICS_SUB, [EXPR_MUL] = DIAGNOSTICS_MUL,
        [EXPR_DIV] = DIAGNOSTICS_DIV,  [EXPR_POW] = DIAGNOSTICS_POW, [EXPR_NEG] = DIAGNOSTICS_NEG,
        [EXPR_CALL] = DIAGNOSTICS_CALL};
    int node;
    if (tree->op == EXPR_NUMBER) {
        node = enter_number(k, tree->number);
    } else if (tree->op == EXPR_SYMBOL && tree->symbol->kind == SYM_LET) {
        int *let = &k->let[tree->symbol->index];
        if (*let < 0) { /* the nodes of a let are entered once */
            *let = of_expr(k, tree->symbol->value);
        }
        node = enter(k, (diagnostics_node){.code = DIAGNOSTICS_SAME, .a = *let});
    } else if (tree->op == EXPR_SYMBOL) {
        node = enter_symbol(k, tree->symbol, tree->primes);
    } else {
        const int a = of_expr(k, tree->left);
        const int b = tree->right != NULL ? of_expr(k, tree->right) : -1;
        node = enter_op(k, codes[tree->op], tree->function, a, b);
    }
    k->made->diagnostics.node[node].at = image_place(k->draft, tree->at);
    return node;
}

/* Returns a pointer to node[id], and enlarges the array if needed. The pointer is valid until the next call. */
static int *node_of(known *of, unsigned id) {
    if (id >= of->room) {
        of->node = alloc_more(of->node, 2 * (int64_t)id + 1, sizeof *of->node);
        memset(of->node + of->room, 0, (2 * (size_t)id + 1 - of->room) * sizeof *of->node);
        of->room = 2 * id + 1;
    }
    return &of->node[id];
}

static int of_poly(maker *k, const poly *p);

static int of_atom(maker *k, const atom *x) {
    int node = *node_of(&k->atoms, x->id) - 1;
    if (node < 0 && x->kind == ATOM_SYMBOL) {
        node = enter_symbol(k, x->symbol, x->primes);
    } else if (node < 0) {
        const int a = of_poly(k, x->argument[0]);
        const int b = x->argument[1] != NULL ? of_poly(k, x->argument[1]) : -1;
        node = x->kind == ATOM_GROUP   ? a
               : x->kind == ATOM_POWER ? enter_op(k, DIAGNOSTICS_POW, 0, a, b)
                                       : enter_op(k, DIAGNOSTICS_CALL, x->function, a, b);
    }
    *node_of(&k->atoms, x->id) = node + 1;
    return node;
}

static int of_term(maker *k, const poly_term *t) {
    const mono *m = t->mono;
    int node = enter_number(k, t->coefficient);
    for (int i = 0; i < m->count; i++) {
        int power = of_atom(k, m->factors[i].atom);
        if (m->factors[i].exponent != 1.0) {
            const int exponent = enter_number(k, m->factors[i].exponent);
            power = enter_op(k, DIAGNOSTICS_POW, 0, power, exponent);
        }
        node = enter_op(k, DIAGNOSTICS_MUL, 0, node, power);
    }
    if (m->trig != TRIG_NONE) {
        const int angle = of_poly(k, m->angle);
        const function_id wave = m->trig == TRIG_SIN ? FN_SIN : FN_COS;
        node =
            enter_op(k, DIAGNOSTICS_MUL, 0, node, enter_op(k, DIAGNOSTICS_CALL, wave, angle, -1));
    }
    return node;
}

static int of_poly(maker *k, const poly *p) {
    const int before = *node_of(&k->polys, p->id);
    if (before > 0) {
        return before - 1;
    }
    int node = p->count == 0 ? enter_number(k, 0.0) : of_term(k, &p->terms[0]);
    for (int i = 1; i < p->count; i++) {
        const int more = of_term(k, &p->terms[i]);
        node = enter_op(k, DIAGNOSTICS_ADD, 0, node, more);
    }
    *node_of(&k->polys, p->id) = node + 1;
    return node;
}

/* Has p only sums and products of numbers, symbols, sines and cosines? Then it is differentiable everywhere. */
static bool has_slopes(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        if (m->angle != NULL && !has_slopes(m->angle)) {
            return false;
        }
        for (int j = 0; j < m->count; j++) {
            const mono_factor *f = &m->factors[j];
            const bool whole = f->exponent > 0.0 && f->exponent == number_floor(f->exponent);
            const bool plain = f->atom->kind == ATOM_SYMBOL ||
                               (f->atom->kind == ATOM_GROUP && has_slopes(f->atom->argument[0]));
            if (!whole || !plain) {
                return false;
            }
        }
    }
    return true;
}

static void ask(maker *k, place where, int node, bool derived, const char *what) {
    image_diagnostics *b = &k->made->diagnostics;
    b->question = arena_room(k->made->memory, b->question, b->questions, sizeof *b->question);
    b->question[b->questions++] = (diagnostics_question){
        .node = node, .derived = derived, .what = image_text(k->draft, what), .where = where};
}

static void ask_value(maker *k, place where, const expr *tree, const char *what) {
    if (tree != NULL) {
        ask(k, where, of_expr(k, tree), false, what);
    }
}

/* Enters the derivatives of `tree` by all coordinates (primes 0) or rates (primes 1), if they may be undefined. */
static void ask_slopes(maker *k, place where, const expr *tree, const char *what, int primes) {
    const equations *e = k->equations;
    const poly *value = poly_from_expr(e->algebra, tree);
    if (has_slopes(value)) {
        return;
    }
    for (int i = 0; i < e->count; i++) {
        const poly *slope = poly_derivative(e->algebra, value, e->unknowns[i].symbol, primes);
        if (!poly_is_zero(slope)) {
            ask(k, where, of_poly(k, slope), true, what);
        }
    }
}

static void ask_term(maker *k, const term *t) {
    const char *part = term_part(t->kind);
    char slope[80];
    const place where = image_place(k->draft, t->at);
    const bool differentiated = t->kind == TERM_T || t->kind == TERM_V || t->kind == TERM_F;
    ask_value(k, where, t->value, part);
    ask_value(k, where, t->right, part);
    if (differentiated) {
        snprintf(slope, sizeof slope, "the slope of %s", part);
        if (t->kind != TERM_F) { /* no equation contains a derivative of F by a coordinate */
            ask_slopes(k, where, t->value, slope, 0);
        }
        ask_slopes(k, where, t->value, slope, 1);
    }
}

static void ask_contact(maker *k, const contact_statement *h, image_contact *row) {
    const image_diagnostics *b = &k->made->diagnostics;
    const place where = row->at;
    row->first_question = b->questions;
    switch (h->kind) {
    case CONTACT_STOP:
        ask_value(k, where, h->value, "the gap of this stop");
        ask_slopes(k, where, h->value, "the rate of the gap of this stop", 0);
        break;
    case CONTACT_HOLD:
        ask_value(k, where, h->condition, "the condition of this hold");
        ask_value(k, where, h->value, "the expression of this hold");
        ask_slopes(k, where, h->value, "the rate of the expression of this hold", 0);
        break;
    case CONTACT_FRICTION:
        ask_value(k, where, h->normal, "the normal force of this friction");
        ask_value(k, where, h->static_friction, "the static coefficient of this friction");
        ask_value(k, where, h->kinetic_friction, "the kinetic coefficient of this friction");
        break;
    case CONTACT_WHEN:
        ask_value(k, where, h->value,
                  contact_loosens(h) ? "the normal force of this friction"
                                     : "the value of this crossing");
        break;
    }
    row->questions = b->questions - row->first_question;
    row->first_late = b->questions;
    if (h->kind == CONTACT_STOP) { /* needed only at an impact */
        ask_value(k, where, h->restitution, "the restitution of this stop");
    }
    row->late = b->questions - row->first_late;
}

static void ask_all(maker *k) {
    const equations *e = k->equations;
    const mechanism *m = e->instance->mechanism;
    image *im = k->made;
    for (int i = 0; i < m->term_count; i++) {
        if (instance_has(e->instance, m->terms[i].effect)) {
            ask_term(k, &m->terms[i]);
        }
    }
    im->diagnostics.terms = im->diagnostics.questions;
    for (int c = 0; c < im->contacts; c++) {
        const contact_statement *h = e->contacts->law[c].from;
        for (int i = 0; i < h->set_count && h->kind == CONTACT_WHEN; i++) {
            ask_value(k, image_place(k->draft, h->sets[i].at), h->sets[i].value,
                      "the value that is set");
        }
    }
    im->diagnostics.sets = im->diagnostics.questions - im->diagnostics.terms;
    for (int c = 0; c < im->contacts; c++) {
        ask_contact(k, e->contacts->law[c].from, &im->contact[c]);
    }
}

void diagnostics_make(image_draft *d, const equations *e) {
    const instance *inst = e->instance;
    const mechanism *m = inst->mechanism;
    maker k = {.draft = d,
               .made = d->made,
               .equations = e,
               .input = alloc(m->input_count, sizeof *k.input),
               .let = alloc(m->let_count, sizeof *k.let)};
    for (int i = 0, number = 0; i < m->input_count; i++) {
        k.input[i] = instance_lacks(inst, m->inputs[i]) == NULL ? number++ : -1;
    }
    memset(k.let, -1, (size_t)m->let_count * sizeof *k.let);
    ask_all(&k);
    free(k.input);
    free(k.let);
    free(k.polys.node);
    free(k.atoms.node);
}
