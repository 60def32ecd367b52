#include "denominators.h"

#include <stdlib.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/number/functions.h"

enum {
    MOVES = 1U,    /* depends on the state */
    HIDDEN = 2U,   /* and on values outside the state: a highest derivative, a rate recovered from a
             * momentum */
    DIVIDES = 4U,  /* a factor of a divisor */
    OF_A_TAN = 8U, /* the argument of a tangent */
    NEEDED = 16U,
    LEAPS = 32U, /* and on values that an event may change at once */
    BENDS = 64U, /* and not in a straight line */
};

/* Places are continuous at an event, unless a crossing sets them. */
static bool leaps(const image *im, const diagnostics_node *n) {
    bool set = n->b > 0;
    for (int i = 0; i < im->set_count; i++) {
        const component c = image_component(im, im->target[i]);
        set = set || (c.unknown == n->a && c.primes == n->b);
    }
    return set;
}

static unsigned moves_of(const image *im, const diagnostics_node *n) {
    if (n->code != DIAGNOSTICS_STATE) {
        return 0;
    }
    const bool known = n->b < im->unknown[n->a].order && image_find_component(im, n->a, n->b) >= 0;
    return MOVES | (known ? 0U : HIDDEN) | (leaps(im, n) ? LEAPS : 0U);
}

/* Is it nonlinear in the moving values? */
static bool bends(const denominators *d, const diagnostics_node *n, const int *of, int count) {
    const bool first = count > 0 && (d->is[of[0]] & MOVES) != 0;
    const bool second = count > 1 && (d->is[of[1]] & MOVES) != 0;
    if (n->code == DIAGNOSTICS_MUL) {
        return first && second;
    }
    if (n->code == DIAGNOSTICS_DIV) {
        return second;
    }
    return (n->code == DIAGNOSTICS_POW || n->code == DIAGNOSTICS_CALL) && (first || second);
}

static void find_what_moves(denominators *d) {
    const image *im = d->at.image;
    for (int i = 0; i < im->blame.nodes; i++) {
        const diagnostics_node *n = &im->blame.node[i];
        int of[2];
        const int count = blamed_operands(n, of);
        unsigned is = moves_of(im, n);
        for (int k = 0; k < count; k++) {
            is |= d->is[of[k]] & (MOVES | HIDDEN | LEAPS | BENDS);
        }
        is |= bends(d, n, of, count) ? BENDS : 0U;
        d->is[i] = (unsigned char)is;
        d->at.value[i] = blamed_node(&d->at, n); /* constants: once and for all */
    }
}

static void mark(denominators *d, int node, unsigned as) { d->is[node] |= (unsigned char)as; }

static bool is_size_or_root(const diagnostics_node *n) {
    return n->code == DIAGNOSTICS_CALL && (n->function == FN_ABS || n->function == FN_SQRT);
}

/* Splits divisors into their factors. Starts at the last node, because operands precede their results. */
static void find_factors(denominators *d) {
    const image *im = d->at.image;
    for (int i = im->blame.nodes - 1; i >= 0; i--) {
        const diagnostics_node *n = &im->blame.node[i];
        const unsigned is = d->is[i];
        if (n->code == DIAGNOSTICS_DIV) {
            mark(d, n->b, DIVIDES);
        } else if (n->code == DIAGNOSTICS_POW && (d->is[n->b] & MOVES) == 0 &&
                   d->at.value[n->b] < 0.0) {
            mark(d, n->a, DIVIDES);
        } else if (n->code == DIAGNOSTICS_CALL && n->function == FN_TAN) {
            mark(d, n->a, OF_A_TAN);
        }
        if ((is & DIVIDES) == 0) {
            continue;
        }
        const bool has_factors = n->code == DIAGNOSTICS_MUL || n->code == DIAGNOSTICS_DIV ||
                                 n->code == DIAGNOSTICS_NEG || n->code == DIAGNOSTICS_SAME ||
                                 n->code == DIAGNOSTICS_POW || is_size_or_root(n);
        if (has_factors) { /* the divisors of a divisor have been marked above */
            d->is[i] &= (unsigned char)~DIVIDES;
            mark(d, n->a, DIVIDES);
            if (n->code == DIAGNOSTICS_MUL) {
                mark(d, n->b, DIVIDES);
            }
        }
    }
}

static void find_order(denominators *d) {
    const image_blame *b = &d->at.image->blame;
    for (int i = b->nodes - 1; i >= 0; i--) {
        const unsigned as = (d->is[i] & (MOVES | HIDDEN)) == MOVES ? d->is[i] : 0U;
        const bool watched = (as & (DIVIDES | OF_A_TAN)) != 0;
        if ((as & DIVIDES) != 0) {
            d->divisor[d->count++] =
                (divisor){.node = i, .leaps = (as & LEAPS) != 0, .bends = (as & BENDS) != 0};
        }
        if ((as & OF_A_TAN) != 0) {
            d->divisor[d->count++] =
                (divisor){.node = i, .of_a_tan = true, .leaps = (as & LEAPS) != 0};
        }
        if (watched || (d->is[i] & NEEDED) != 0) {
            int of[2];
            const int count = blamed_operands(&b->node[i], of);
            mark(d, i, NEEDED);
            for (int k = 0; k < count; k++) {
                mark(d, of[k], NEEDED);
            }
        }
    }
    for (int i = 0; i < b->nodes; i++) {
        if ((d->is[i] & (NEEDED | MOVES)) == (NEEDED | MOVES)) {
            d->order[d->ordered++] = i;
        }
    }
}

/* Energies, losses, forces, equations, their slopes, and the normal forces of frictions. */
static void find_questions(denominators *d) {
    const image *im = d->at.image;
    d->asked = alloc(im->blame.questions, sizeof *d->asked);
    for (int i = 0; i < im->blame.terms; i++) {
        d->asked[d->questions++] = i;
    }
    for (int c = 0; c < im->contacts; c++) {
        const image_contact *of = &im->contact[c];
        for (int i = 0; i < of->questions && of->kind == WH_FRICTION; i++) {
            d->asked[d->questions++] = of->first_question + i;
        }
    }
}

/* Does a highest derivative of a system have a moving factor, so that the slope is divided by it? */
static bool has_factors_that_move(const denominators *d) {
    const image *im = d->at.image;
    for (int i = 0; i < im->blame.nodes && !im->has_energies; i++) {
        const diagnostics_node *n = &im->blame.node[i];
        const bool factor = n->code == DIAGNOSTICS_MUL || n->code == DIAGNOSTICS_DIV;
        if (factor && (d->is[i] & HIDDEN) != 0 && (d->is[n->a] & MOVES) != 0 &&
            (d->is[n->b] & MOVES) != 0) {
            return true;
        }
    }
    return false;
}

/* The factors of divisors in the list that solves for the slopes. */
static void find_derived(denominators *d) {
    const op_list *t = d->at.image->list[IMAGE_BOOKS];
    bool *divides = alloc(t->count, sizeof *divides);
    for (int i = t->count - 1; i >= 0; i--) {
        const op *o = &t->ops[i];
        if (o->code == OP_DIV) {
            divides[o->b] = true;
        }
        if (divides[i] && (o->code == OP_MUL || o->code == OP_DIV)) {
            divides[o->a] = true;
            divides[o->b] = true;
        } else if (divides[i] && (o->code == OP_NEG || o->code == OP_ABS || o->code == OP_SQRT)) {
            divides[o->a] = true;
        } else if (divides[i] && o->code != OP_CONSTANT) {
            d->divisor[d->count++] = (divisor){.node = i, .derived = true, .bends = true};
        }
    }
    free(divides);
}

/* --- at a state ---------------------------------------------------------------------------------------*/

denominators denominators_open(const image *im) {
    const int nodes = im->blame.nodes;
    denominators d = {
        .at = blamed_open(im),
        .is = alloc(nodes, sizeof *d.is),
        .order = alloc(nodes, sizeof *d.order),
        .divisor = alloc(2 * (int64_t)nodes + im->list[IMAGE_BOOKS]->count, sizeof *d.divisor)};
    find_what_moves(&d);
    find_factors(&d);
    find_order(&d);
    find_questions(&d);
    if (has_factors_that_move(&d)) {
        d.field = vector_field_open(im, &engine_float); /* which wraps angles: of either number */
        find_derived(&d);
        d.slope = alloc(d.field->n, sizeof *d.slope);
    }
    for (int i = 0; i < d.count; i++) {
        d.some_bend = d.some_bend || d.divisor[i].bends;
    }
    return d;
}

void denominators_close(denominators *d) {
    blamed_close(&d->at);
    vector_field_close(d->field);
    free(d->is);
    free(d->order);
    free(d->divisor);
    free(d->asked);
    free(d->slope);
}

void denominators_see(denominators *d, const double *state) {
    const image *im = d->at.image;
    blamed_place(&d->at, state, state + im->angles);
    engine_operations += (uint64_t)(d->ordered + d->count);
    for (int i = 0; i < d->ordered; i++) {
        d->at.value[d->order[i]] = blamed_node(&d->at, &im->blame.node[d->order[i]]);
    }
    if (d->field != NULL) {
        vector_field_slope(d->field, state, d->slope);
    }
}

void denominators_see_all(denominators *d, const double *state, double *value) {
    const image *im = d->at.image;
    blamed_place(&d->at, state, state + im->angles);
    engine_operations += (uint64_t)im->blame.nodes;
    for (int i = 0; i < im->blame.nodes; i++) {
        if ((d->is[i] & MOVES) != 0) {
            d->at.value[i] = blamed_node(&d->at, &im->blame.node[i]);
        }
    }
    for (int i = 0; i < d->questions; i++) {
        value[i] = d->at.value[im->blame.question[d->asked[i]].node];
    }
    if (d->field != NULL) {
        vector_field_slope(d->field, state, value + d->questions);
    }
}

int denominators_values(const denominators *d) {
    return d->questions + (d->field != NULL ? d->field->n : 0);
}

double denominators_value(const denominators *d, const divisor *of) {
    if (of->derived) {
        return evaluator_value(d->field->evaluator, of->node);
    }
    const double value = d->at.value[of->node];
    return of->of_a_tan ? number_cosine(value) : value;
}

/* Does this node depend on the highest derivative of that unknown? */
static bool has_highest(const image *im, int node, int unknown) {
    bool *of = blamed_parts(im, node);
    bool has = false;
    for (int i = 0; i <= node && !has; i++) {
        const diagnostics_node *n = &im->blame.node[i];
        has = of[i] && n->code == DIAGNOSTICS_STATE && n->a == unknown &&
              n->b == im->unknown[unknown].order;
    }
    free(of);
    return has;
}

int denominators_question(const denominators *d, int value) {
    const image *im = d->at.image;
    if (value < d->questions) {
        return d->asked[value];
    }
    const int unknown = image_component(im, value - d->questions).unknown;
    for (int i = 0; i < im->blame.terms; i++) {
        if (has_highest(im, im->blame.question[i].node, unknown)) {
            return i;
        }
    }
    return 0;
}
