#include "pole.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/engine/vector_field.h"
#include "host/number/functions.h"

/* === a pole on the way =========================================================================== */

enum { HALVINGS = 56 };  /* enough to locate a sign change on the path, down to round-off */
#define FARTHER 2.5      /* if samples show only round-off, their distances grow by this factor */
enum { TURNS_MOST = 4 }; /* an expression with at least this many sign changes is round-off */
#define NEAR 0.2
#define FURTHER 1.4 /* ratio of successive distances at which the sign is tested */
/* Relative limit of pole_may_touch(). */
#define TOUCHES 1e-3
/* SECTIONS golden sections find the minimum of a value to its last digit. */
#define GOLDEN 0.6180339887498949
enum { SECTIONS = 72 };
enum { PARTS_MOST = 16 }; /* most rejected places on the path of a step */

enum { GROWTH_POINTS = 10 }; /* number of sampled distances */
/* Each sampled distance, divided by the next smaller one: the third root of 5. A power of two would give all distances
 * the same digits and the same round-off, which would look like steady growth. */
#define GROWTH_CLOSER 1.7099759466766968
#define GROWTH_REACH 125.0 /* largest sampled distance, relative to the smallest */
#define GROWTH_BEYOND 1e60 /* an overflow is a pole only if the finite sample beside it is larger */

typedef enum growth {
    GROWTH_ROUGH, /* not steady; growth at larger distances may be steady */
    GROWTH_NONE,  /* steady, but slower than at a pole */
    GROWTH_POLE   /* steady, as at a pole */
} growth;

#define GROWS 1.64 /* must be less than GROWTH_CLOSER */
#define EVEN 1.1   /* growth is steady if its ratios differ by less than this factor */

typedef struct part {
    double low; /* shares of the path */
    double high;
} part;

typedef struct looker {
    const pole_way *way;
    double *sign; /* [signs] values at the begin of a part */
    double *then; /* [signs] values at the end of the part */
    double *value;
    double *side;  /* [GROWTH_POINTS * values] */
    bool *done;    /* [values] this expression has no pole at the place */
    double *touch; /* [4 * signs] */
} looker;

static growth growth_of(const double *value, int stride) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < GROWTH_POINTS; k++) {
        const double before = value[(k - 1) * stride];
        const double now = value[k * stride];
        const double by = before == now ? 1.0 : now / before; /* before and now may both be zero */
        if (isinf(now) && isfinite(before) && fabs(before) > GROWTH_BEYOND) {
            return GROWTH_POLE;
        }
        if (!(by > 0.0) || isinf(now)) { /* NaN, or another sign */
            return GROWTH_ROUGH;
        }
        least = number_least(least, by);
        most = number_most(most, by);
    }
    if (!(most < EVEN * least)) {
        return GROWTH_ROUGH;
    }
    return least > GROWS ? GROWTH_POLE : GROWTH_NONE;
}

static bool changes_sign(double from, double to) {
    return (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0);
}

bool pole_may_touch(const double value[static 4]) {
    const double begin = fabs(value[0]);
    const double end = fabs(value[3]);
    const double falls = (begin - fabs(value[1])) / POLE_ASIDE;
    const double rises = (end - fabs(value[2])) / POLE_ASIDE;
    if (!(falls > 0.0 && rises > 0.0) || value[0] * value[3] < 0.0) {
        return false;
    }
    /* share at which the tangents at both ends cross */
    const double share = (begin - end + rises) / (falls + rises);
    return begin - falls * share <= TOUCHES * number_least(begin, end);
}

/* The first value that may touch zero in this part, or -1. */
static int touches(const looker *l, part p) {
    const double aside = POLE_ASIDE * (p.high - p.low);
    const double share[4] = {p.low, p.low + aside, p.high - aside, p.high};
    for (int k = 0; k < 4; k++) {
        l->way->at(l->way->of, share[k], l->touch + (ptrdiff_t)k * l->way->signs, l->value);
    }
    for (int i = 0; i < l->way->signs; i++) {
        double value[4];
        for (int k = 0; k < 4; k++) {
            value[k] = l->touch[k * l->way->signs + i];
        }
        if (pole_may_touch(value)) {
            return i;
        }
    }
    return -1;
}

static double size_at(const looker *l, int i, double share) {
    l->way->at(l->way->of, share, l->then, l->value);
    return fabs(l->then[i]);
}

static double least_of(const looker *l, int i, part p) {
    double lower = p.high - GOLDEN * (p.high - p.low);
    double upper = p.low + GOLDEN * (p.high - p.low);
    double at_lower = size_at(l, i, lower);
    double at_upper = size_at(l, i, upper);
    for (int k = 0; k < SECTIONS; k++) {
        if (at_lower < at_upper) {
            p.high = upper;
            upper = lower;
            at_upper = at_lower;
            lower = p.high - GOLDEN * (p.high - p.low);
            at_lower = size_at(l, i, lower);
        } else {
            p.low = lower;
            lower = upper;
            at_lower = at_upper;
            upper = p.low + GOLDEN * (p.high - p.low);
            at_upper = size_at(l, i, upper);
        }
    }
    return 0.5 * (p.low + p.high);
}

/* Halves the part until it locates the sign change of value i. */
static part halve(const looker *l, int i, part p) {
    const bool rises = l->sign[i] < 0.0;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (p.low + p.high);
        l->way->at(l->way->of, middle, l->then, l->value);
        if ((l->then[i] < 0.0) == rises) {
            p.low = middle;
        } else {
            p.high = middle;
        }
    }
    return p;
}

/* Does the sign of expression i alternate at distances from `from` to `most`? If so, the expression is round-off. */
static bool is_rounding(const looker *l, int i, double zero_at, double from, double most) {
    double before = 0.0;
    double off = from;
    int turns = 0;
    while (fabs(off) <= most) {
        l->way->at(l->way->of, zero_at + off, l->then, l->value);
        turns += before * l->value[i] < 0.0 || l->value[i] == 0.0;
        before = l->value[i];
        off *= FURTHER;
    }
    return turns >= TURNS_MOST;
}

static bool overflows(const looker *l, int i, double zero_at, double from) {
    const double most = from < 0.0 ? zero_at : 1.0 - zero_at;
    double off = from;
    do {
        off *= FARTHER;
        l->way->at(l->way->of, zero_at + off, l->then, l->value);
    } while (isinf(l->value[i]) && fabs(off) * FARTHER <= most);
    return fabs(l->value[i]) > GROWTH_BEYOND;
}

/* A possible pole: a place on the path at which a divisor changes its sign or may touch zero. */
typedef struct spot {
    part in;
    double zero_at;
    double nearest; /* smallest tested distance from zero_at */
    int of;
    bool touches; /* the value has no sign change */
} spot;

/* Sample over[NINE_TIMES] is about nine times as far from zero_at as the last sample of over[]. */
enum { NEAREST = 3, NINE_TIMES = GROWTH_POINTS - 5 };
#define LEFT 0.05 /* relative tolerance of the minimum in stands_off() */

static bool stands_off(double at_place, const double *over, double far) {
    double off[GROWTH_POINTS];
    off[0] = far;
    for (int k = 1; k < GROWTH_POINTS; k++) {
        off[k] = off[k - 1] / GROWTH_CLOSER;
    }
    const double bend = (1.0 / over[NINE_TIMES] - at_place) / (off[NINE_TIMES] * off[NINE_TIMES]);
    bool stands = at_place > 0.0;
    for (int k = GROWTH_POINTS - NEAREST; k < GROWTH_POINTS; k++) {
        const double left = 1.0 / over[k] - bend * off[k] * off[k];
        stands = stands && fabs(left - at_place) < LEFT * at_place;
    }
    return stands;
}

/* Returns the first expression with a pole at s->zero_at, or -1. `far` is negative for the side below zero_at. */
static int grows_from(const looker *l, const spot *s, double far) {
    const double zero_at = s->zero_at;
    const int values = l->way->values;
    const double extent = far < 0.0 ? zero_at - s->in.low : s->in.high - zero_at;
    double over[GROWTH_POINTS]; /* 1 / |value| at the distances */
    double off = far;
    for (int k = 0; k < GROWTH_POINTS; k++) {
        l->way->at(l->way->of, zero_at + off, l->then, l->side + (ptrdiff_t)k * values);
        over[k] = 1.0 / fabs(l->then[s->of]);
        off = k + 1 < GROWTH_POINTS ? off / GROWTH_CLOSER : off;
    }
    const growth to_zero = growth_of(over, 1);
    const bool is_zero =
        s->touches ? to_zero == GROWTH_POLE && !stands_off(size_at(l, s->of, zero_at), over, far)
                   : to_zero != GROWTH_ROUGH;
    if (!is_zero) {
        return -1;
    }
    for (int i = 0; i < values; i++) {
        const growth kind = l->done[i] ? GROWTH_NONE : growth_of(l->side + i, values);
        const bool pole = isinf(l->side[i]) ? overflows(l, i, zero_at, far)
                                            : kind == GROWTH_POLE &&
                                                  !is_rounding(l, i, zero_at, off, NEAR * extent);
        l->done[i] = kind == GROWTH_NONE;
        if (pole) {
            return i;
        }
    }
    return -1;
}

static bool all_done(const looker *l) {
    int done = 0;
    for (int i = 0; i < l->way->values; i++) {
        done += l->done[i];
    }
    return done == l->way->values;
}

/* The first expression with a pole at the place, or -1. Tests one side, outwards until the growth is steady. */
static int pole_on_side(const looker *l, const spot *s, double side) {
    int found = -1;
    memset(l->done, 0, (size_t)l->way->values * sizeof *l->done);
    double far = GROWTH_REACH * s->nearest;
    while (far < 1.0 && found < 0 && !all_done(l)) {
        const bool inside =
            side < 0.0 ? s->zero_at - far >= s->in.low : s->zero_at + far <= s->in.high;
        found = inside ? grows_from(l, s, side * far) : -1;
        far *= FARTHER;
    }
    return found;
}

static int pole_at(const looker *l, const spot *s) {
    const int found = pole_on_side(l, s, -1.0);
    return found >= 0 ? found : pole_on_side(l, s, 1.0);
}

/* Searches this part for a sign change. If there is none, it searches for a value that may touch zero. Returns the
 * expression with a pole there, or -1. *at: the interval that contains the place; {p.high, p.high} if there is none. */
static int pole_in(const looker *l, part p, part *at) {
    l->way->at(l->way->of, p.low, l->sign, l->value);
    l->way->at(l->way->of, p.high, l->then, l->value);
    int i = 0;
    while (i < l->way->signs && !changes_sign(l->sign[i], l->then[i])) {
        i++;
    }
    if (i < l->way->signs) {
        *at = halve(l, i, p);
        return pole_at(l, &(spot){p, 0.5 * (at->low + at->high), l->way->nearest[i], i, false});
    }
    i = touches(l, p);
    if (i >= 0) {
        const double zero_at = least_of(l, i, p);
        *at = (part){zero_at, zero_at};
        return pole_at(l, &(spot){p, zero_at, l->way->nearest[i], i, true});
    }
    *at = (part){p.high, p.high};
    return -1;
}

static int look(const looker *l) {
    part waiting[PARTS_MOST + 2] = {{0.0, 1.0}};
    int left = 1;
    int places = 0;
    int found = -1;
    while (left > 0 && places <= PARTS_MOST && found < 0) {
        const part p = waiting[--left];
        part at;
        found = pole_in(l, p, &at);
        if (at.low < p.high) {
            waiting[left++] = (part){at.high, p.high};
            waiting[left++] = (part){p.low, at.low};
            places++;
        }
    }
    return found;
}

int pole_on(const pole_way *w) {
    const looker l = {.way = w,
                      .sign = alloc(w->signs, sizeof *l.sign),
                      .then = alloc(w->signs, sizeof *l.then),
                      .value = alloc(w->values, sizeof *l.value),
                      .side = alloc((int64_t)GROWTH_POINTS * w->values, sizeof *l.side),
                      .done = alloc(w->values, sizeof *l.done),
                      .touch = alloc(4 * (int64_t)w->signs, sizeof *l.touch)};
    const int found = look(&l);
    free(l.sign);
    free(l.then);
    free(l.value);
    free(l.side);
    free(l.done);
    free(l.touch);
    return found;
}

/* === divisors ==================================================================================== */
/* Finds the divisors of a scene, and the expressions that may grow at a zero of a divisor. Divisors and bases of
 * negative powers are split into factors. A factor of a highest derivative also counts as a divisor: solving
 * (k + s)*s' = -v*s for s' divides by k + s. */

typedef struct divisor {
    int node;      /* index in image_diagnostics.node, or in the list IMAGE_BOOKS if `derived` */
    bool of_a_tan; /* the divisor is the cosine of a tangent's argument */
    bool derived;
    bool leaps;    /* an event may change the value abruptly */
    bool bends;    /* the value is nonlinear in the state, and may touch zero */
    double before; /* value before the step */
    double aside;  /* value at the share POLE_ASIDE of the step's path: near its begin */
    double now;    /* value after the step */
} divisor;

typedef struct denominators {
    diagnosis at;
    unsigned char *is; /* [nodes] */
    int *order;        /* [ordered] nodes on which the tested values depend, operands first */
    int ordered;
    divisor *divisor; /* [count] */
    int count;
    bool some_bend;
    int *asked; /* [questions] indices in im->diagnostics.question[] */
    int questions;
    vector_field *field; /* for derived denominators; NULL if there are none */
} denominators;

enum {
    MOVES = 1U,    /* depends on the state */
    HIDDEN = 2U,   /* depends on a highest derivative, or on a rate recovered from a momentum */
    DIVIDES = 4U,  /* a factor of a divisor */
    OF_A_TAN = 8U, /* is the argument of a tangent */
    NEEDED = 16U,
    LEAPS = 32U, /* depends on values that an event may change abruptly */
    BENDS = 64U, /* depends on the state nonlinearly */
};

/* May an event change this value abruptly? Rates may jump; positions do so only if a crossing sets them. */
static bool leaps(const image *im, const diagnostics_node *n) {
    bool set = n->b > 0;
    for (int i = 0; i < im->set_count; i++) {
        const component c = image_component(im, im->target[i]);
        set = set || (c.unknown == n->a && c.primes == n->b);
    }
    return set;
}

/* Is the node nonlinear in an operand that depends on the state? */
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
    for (int i = 0; i < im->diagnostics.nodes; i++) {
        const diagnostics_node *n = &im->diagnostics.node[i];
        int of[2];
        const int count = diagnosis_operands(n, of);
        unsigned is = 0U;
        if (n->code == DIAGNOSTICS_STATE) {
            const bool known =
                n->b < im->unknown[n->a].order && image_find_component(im, n->a, n->b) >= 0;
            is = MOVES | (known ? 0U : HIDDEN) | (leaps(im, n) ? LEAPS : 0U);
        }
        for (int k = 0; k < count; k++) {
            is |= d->is[of[k]] & (MOVES | HIDDEN | LEAPS | BENDS);
        }
        is |= bends(d, n, of, count) ? BENDS : 0U;
        d->is[i] = (unsigned char)is;
        d->at.value[i] = diagnosis_value(&d->at, n); /* constants are evaluated here, only once */
    }
}

static void mark(denominators *d, int node, unsigned as) { d->is[node] |= (unsigned char)as; }

static bool is_size_or_root(const diagnostics_node *n) {
    return n->code == DIAGNOSTICS_CALL && (n->function == FN_ABS || n->function == FN_SQRT);
}

/* Splits divisors into their factors. Starts at the last node, because operands precede their results. */
static void find_factors(denominators *d) {
    const image *im = d->at.image;
    for (int i = im->diagnostics.nodes - 1; i >= 0; i--) {
        const diagnostics_node *n = &im->diagnostics.node[i];
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
        if (has_factors) { /* the divisor of a quotient has been marked above */
            d->is[i] &= (unsigned char)~DIVIDES;
            mark(d, n->a, DIVIDES);
            if (n->code == DIAGNOSTICS_MUL) {
                mark(d, n->b, DIVIDES);
            }
        }
    }
}

static void find_order(denominators *d) {
    const image_diagnostics *b = &d->at.image->diagnostics;
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
            const int count = diagnosis_operands(&b->node[i], of);
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

static void find_questions(denominators *d) {
    const image *im = d->at.image;
    d->asked = alloc(im->diagnostics.questions, sizeof *d->asked);
    for (int i = 0; i < im->diagnostics.terms; i++) {
        d->asked[d->questions++] = i;
    }
    for (int c = 0; c < im->contacts; c++) {
        const image_contact *of = &im->contact[c];
        for (int i = 0; i < of->questions && of->kind == WH_FRICTION; i++) {
            d->asked[d->questions++] = of->first_question + i;
        }
    }
}

/* Is a highest derivative multiplied or divided by a value that depends on the state? */
static bool has_factors_that_move(const denominators *d) {
    const image *im = d->at.image;
    for (int i = 0; i < im->diagnostics.nodes && !im->has_energies; i++) {
        const diagnostics_node *n = &im->diagnostics.node[i];
        const bool factor = n->code == DIAGNOSTICS_MUL || n->code == DIAGNOSTICS_DIV;
        if (factor && (d->is[i] & HIDDEN) != 0 && (d->is[n->a] & MOVES) != 0 &&
            (d->is[n->b] & MOVES) != 0) {
            return true;
        }
    }
    return false;
}

/* Appends the factors of all divisors in the list IMAGE_BOOKS to d->divisor[]. */
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

static denominators denominators_open(const image *im) {
    const int nodes = im->diagnostics.nodes;
    denominators d = {
        .at = diagnosis_open(im),
        .is = alloc(nodes, sizeof *d.is),
        .order = alloc(nodes, sizeof *d.order),
        .divisor = alloc(2 * (int64_t)nodes + im->list[IMAGE_BOOKS]->count, sizeof *d.divisor)};
    find_what_moves(&d);
    find_factors(&d);
    find_order(&d);
    find_questions(&d);
    if (has_factors_that_move(&d)) {
        d.field = vector_field_open(im, &engine_float); /* engine_float, because it wraps angles */
        find_derived(&d);
    }
    for (int i = 0; i < d.count; i++) {
        d.some_bend = d.some_bend || d.divisor[i].bends;
    }
    return d;
}

static void denominators_close(denominators *d) {
    diagnosis_close(&d->at);
    vector_field_close(d->field);
    free(d->is);
    free(d->order);
    free(d->divisor);
    free(d->asked);
}

static void denominators_see(denominators *d, const double *state) {
    const image *im = d->at.image;
    diagnosis_place(&d->at, state, state + im->angles);
    engine_operations += (uint64_t)(d->ordered + d->count);
    for (int i = 0; i < d->ordered; i++) {
        d->at.value[d->order[i]] = diagnosis_value(&d->at, &im->diagnostics.node[d->order[i]]);
    }
    if (d->field != NULL) { /* evaluates the operations that denominators_value() reads */
        double slope[3 * IMAGE_COMPONENTS_MAX];
        vector_field_slope(d->field, state, slope);
    }
}

static void denominators_see_all(denominators *d, const double *state, double *value) {
    const image *im = d->at.image;
    diagnosis_place(&d->at, state, state + im->angles);
    engine_operations += (uint64_t)im->diagnostics.nodes;
    for (int i = 0; i < im->diagnostics.nodes; i++) {
        if ((d->is[i] & MOVES) != 0) {
            d->at.value[i] = diagnosis_value(&d->at, &im->diagnostics.node[i]);
        }
    }
    for (int i = 0; i < d->questions; i++) {
        value[i] = d->at.value[im->diagnostics.question[d->asked[i]].node];
    }
    if (d->field != NULL) {
        vector_field_slope(d->field, state, value + d->questions);
    }
}

static double denominators_value(const denominators *d, const divisor *of) {
    if (of->derived) {
        return evaluator_value(d->field->list.evaluator, of->node);
    }
    const double value = d->at.value[of->node];
    return of->of_a_tan ? number_cosine(value) : value;
}

/* Does this node depend on the highest derivative of `unknown`? */
static bool has_highest(const image *im, int node, int unknown) {
    bool *of = diagnosis_parts(im, node);
    bool has = false;
    for (int i = 0; i <= node && !has; i++) {
        const diagnostics_node *n = &im->diagnostics.node[i];
        has = of[i] && n->code == DIAGNOSTICS_STATE && n->a == unknown &&
              n->b == im->unknown[unknown].order;
    }
    free(of);
    return has;
}

/* Converts an index of value[] in pole_way.at() to an index of image_diagnostics.question. */
static int denominators_question(const denominators *d, int value) {
    const image *im = d->at.image;
    if (value < d->questions) {
        return d->asked[value];
    }
    const int unknown = image_component(im, value - d->questions).unknown;
    for (int i = 0; i < im->diagnostics.terms; i++) {
        if (has_highest(im, im->diagnostics.question[i].node, unknown)) {
            return i;
        }
    }
    return 0;
}

/* === step by step ================================================================================ */

#define RESOLVED 2e-13 /* smallest tested distance from a pole, as a share of a component */

struct pole_crossing {
    const image *image;
    int components;
    denominators of;
    double *from; /* [components] state before the step: angles, then reals */
    double *to;   /* [components] state after the step */
    uint64_t events;
    bool leapt; /* the present step had events */
    bool blind; /* the state before this step is unknown */
    uint64_t unseen;
    missed *contacts;
    int found; /* index in image_diagnostics.question of the expression with the pole; -1: none */
    missed_found through;
    double found_s;
};

pole_crossing *pole_crossing_open(const image *im) {
    pole_crossing *j = alloc(1, sizeof *j);
    j->image = im;
    j->components = im->angles + im->reals;
    j->of = denominators_open(im);
    j->contacts = missed_open(im);
    j->found = -1;
    j->through = MISSED_NOTHING;
    j->from = alloc(j->components, sizeof *j->from);
    j->to = alloc(j->components, sizeof *j->to);
    if (j->of.count == 0 && j->contacts == NULL) {
        pole_crossing_close(j);
        return NULL;
    }
    return j;
}

void pole_crossing_close(pole_crossing *j) {
    if (j != NULL) {
        missed_close(j->contacts);
        denominators_close(&j->of);
        free(j->from);
        free(j->to);
        free(j);
    }
}

/* --- the path of a step -------------------------------------------------------------------------------*/

/* Is the denominator tested in this step? A jump of rates at an impact passes no pole. */
static bool counts(const pole_crossing *j, const divisor *d) { return !(j->leapt && d->leaps); }

/* The change of component i in the step; for an angle, at most half a turn. */
static double way_of(const pole_crossing *j, int i) {
    const double way = j->to[i] - j->from[i];
    return i < j->image->angles ? number_centred(way, 6.283185307179586) : way;
}

static void state_at(const pole_crossing *j, double share,
                     double state[static 3 * IMAGE_COMPONENTS_MAX]) {
    for (int i = 0; i < j->components; i++) {
        state[i] = j->from[i] + share * way_of(j, i);
    }
}

static void go_to(void *of, double share, double *sign, double *value) {
    pole_crossing *j = of;
    double state[3 * IMAGE_COMPONENTS_MAX];
    state_at(j, share, state);
    denominators_see_all(&j->of, state, value);
    for (int i = 0; i < j->of.count; i++) {
        const divisor *d = &j->of.divisor[i];
        sign[i] = counts(j, d) ? denominators_value(&j->of, d) : 0.0;
    }
}

/* The change of this component in the step, relative to its value. */
static double relative_way_of(const pole_crossing *j, int c) {
    const double size = number_most(fabs(j->from[c]), fabs(j->to[c]));
    return size > 0.0 ? fabs(way_of(j, c)) / size : 0.0;
}

/* Largest relative change of the components on which this divisor depends. A derived divisor may depend on all. */
static double relative_way(const pole_crossing *j, const divisor *d) {
    double most = 0.0;
    for (int c = 0; c < j->components && d->derived; c++) {
        most = number_most(most, relative_way_of(j, c));
    }
    if (d->derived) {
        return most;
    }
    bool *of = diagnosis_parts(j->image, d->node);
    for (int i = 0; i <= d->node; i++) {
        const diagnostics_node *n = &j->image->diagnostics.node[i];
        if (of[i] && n->code == DIAGNOSTICS_STATE) {
            most =
                number_most(most, relative_way_of(j, image_find_component(j->image, n->a, n->b)));
        }
    }
    free(of);
    return most;
}

/* The first expression with a pole on the path, or -1. */
static int pole_between(pole_crossing *j) {
    const int slopes = j->of.field != NULL ? j->of.field->n : 0;
    double *nearest = alloc(j->of.count, sizeof *nearest);
    for (int i = 0; i < j->of.count; i++) {
        nearest[i] = RESOLVED / relative_way(j, &j->of.divisor[i]);
    }
    const int value = pole_on(&(pole_way){.of = j,
                                          .signs = j->of.count,
                                          .values = j->of.questions + slopes,
                                          .nearest = nearest,
                                          .at = go_to});
    free(nearest);
    return value >= 0 ? denominators_question(&j->of, value) : -1;
}

/* --- step by step ------------------------------------------------------------------------------------*/

/* May a nonlinear divisor have touched zero without changing its sign? */
static bool may_touch(pole_crossing *j) {
    double state[3 * IMAGE_COMPONENTS_MAX];
    if (!j->of.some_bend) {
        return false;
    }
    state_at(j, POLE_ASIDE, state);
    denominators_see(&j->of, state);
    for (int i = 0; i < j->of.count; i++) {
        j->of.divisor[i].aside = denominators_value(&j->of, &j->of.divisor[i]);
    }
    state_at(j, 1.0 - POLE_ASIDE, state);
    denominators_see(&j->of, state);
    bool may = false;
    for (int i = 0; i < j->of.count && !may; i++) {
        const divisor *d = &j->of.divisor[i];
        const double value[4] = {d->before, d->aside, denominators_value(&j->of, d), d->now};
        may = d->bends && counts(j, d) && pole_may_touch(value);
    }
    return may;
}

void pole_crossing_enter(pole_crossing *j, const engine_kind *kind, const void *run) {
    if (pole_crossing_some(j) || j == NULL) {
        return;
    }
    const uint64_t steps = kind->steps(run);
    uint64_t overruns;
    uint64_t events = kind->events(run, &overruns);
    events += overruns;
    bool changed = false;
    const bool looks = steps > 0 && !j->blind;
    memcpy(j->from, j->to, (size_t)j->components * sizeof *j->to);
    kind->state(run, j->to, j->to + j->image->angles);
    j->leapt = events != j->events;
    j->events = events;
    j->through = missed_enter(j->contacts, kind, run, looks ? j->from : NULL, j->to, j->leapt);
    denominators_see(&j->of, j->to);
    for (int i = 0; i < j->of.count; i++) {
        divisor *d = &j->of.divisor[i];
        d->before = d->now;
        d->now = denominators_value(&j->of, d);
        changed = changed || (changes_sign(d->before, d->now) && counts(j, d));
    }
    j->unseen += j->blind ? 1U : 0U;
    j->blind = false;
    if (looks && j->through.what < 0 && (changed || may_touch(j))) {
        j->found = pole_between(j);
    }
    if (pole_crossing_some(j)) {
        j->found_s = ratio_times(steps - 1, j->image->step);
    }
}

void pole_crossing_pass(pole_crossing *j) {
    if (j != NULL && !pole_crossing_some(j)) {
        j->blind = true;
        j->unseen++;
    }
}

uint64_t pole_crossing_unseen(const pole_crossing *j) { return j != NULL ? j->unseen : 0; }

bool pole_crossing_some(const pole_crossing *j) {
    return j != NULL && (j->found >= 0 || j->through.what >= 0);
}

double pole_crossing_begin_s(const pole_crossing *j) { return j->found_s; }

missed_found pole_crossing_through(const pole_crossing *j) {
    return j != NULL ? j->through : MISSED_NOTHING;
}

const diagnostics_question *pole_crossing_over(const pole_crossing *j) {
    return &j->image->diagnostics.question[j->found];
}
