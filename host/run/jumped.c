/* jumped.c: see jumped.h. */
#include "jumped.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blamed.h"
#include "host/base/room.h"
#include "host/number/functions.h"

/* The way is halved so often, and by so many more at a time, in which a pole grows 2^HALVINGS, within a factor of two: by
 * more than GROWS; one over a root grows by less. */
enum { HALVINGS_FIRST = 4, HALVINGS = 6 };
#define GROWS 16.0
/* Not where what moves differs by less than this part of itself: there nothing but rounding grows. */
#define RESOLVED 1e-10

/* What a node is good for. */
enum {
    MOVES = 1U, /* depends on the state */
    HIDDEN =
        2U, /* and on what is none of its components: a highest derivative, what a momentum gives */
    DIVIDES = 4U,  /* a factor of what something is divided by */
    OF_A_TAN = 8U, /* a tangent is taken of it */
    NEEDED = 16U,
};

/* What changes its sign at a pole. */
typedef struct divisor {
    int node;
    bool of_a_tan; /* its cosine does */
    double before; /* the step, */
    double now;    /* and behind it */
} divisor;

struct jumped {
    blamed at;
    int components;
    unsigned char *is; /* [nodes] */
    int *order;        /* [ordered] nodes that are needed for those watched, operands first */
    int ordered;
    divisor *divisor; /* [divisors] */
    int divisors;
    double *from; /* [components] angles, then reals: the state before the step, */
    double *to;   /* and behind it */
    uint64_t events;
    uint64_t steps;
    int found; /* a question, or -1 */
    double found_s;
};

/* --- what is watched -----------------------------------------------------------------------------*/

static int operands(const blame_node *n, int of[static 2]) {
    switch (n->code) {
    case BLAME_NUMBER:
    case BLAME_STATE:
    case BLAME_INPUT: return 0;
    case BLAME_SAME:
    case BLAME_NEG: of[0] = n->a; return 1;
    case BLAME_ADD:
    case BLAME_SUB:
    case BLAME_MUL:
    case BLAME_DIV:
    case BLAME_POW:
        of[0] = n->a;
        of[1] = n->b;
        return 2;
    case BLAME_CALL:
        of[0] = n->a;
        of[1] = n->b;
        return n->b < 0 ? 1 : 2;
    }
    return 0;
}

static unsigned moves_of(const image *im, const blame_node *n) {
    if (n->code != BLAME_STATE) {
        return 0;
    }
    const bool known = n->b < im->unknown[n->a].order && image_find_component(im, n->a, n->b) >= 0;
    return known ? MOVES : MOVES | HIDDEN;
}

static void find_what_moves(jumped *j) {
    const image *im = j->at.image;
    for (int i = 0; i < im->blame.nodes; i++) {
        const blame_node *n = &im->blame.node[i];
        int of[2];
        const int count = operands(n, of);
        unsigned is = moves_of(im, n);
        for (int k = 0; k < count; k++) {
            is |= j->is[of[k]] & (MOVES | HIDDEN);
        }
        j->is[i] = (unsigned char)is;
        j->at.value[i] = blamed_node(&j->at, n); /* of what does not move: for good */
    }
}

static void mark(jumped *j, int node, unsigned as) { j->is[node] |= (unsigned char)as; }

static bool is_size_or_root(const blame_node *n) {
    return n->code == BLAME_CALL && (n->function == FN_ABS || n->function == FN_SQRT);
}

/* Divisors down to their factors: from the last node on, for operands stand before what is made of them. */
static void find_factors(jumped *j) {
    const image *im = j->at.image;
    for (int i = im->blame.nodes - 1; i >= 0; i--) {
        const blame_node *n = &im->blame.node[i];
        const unsigned is = j->is[i];
        if (n->code == BLAME_DIV) {
            mark(j, n->b, DIVIDES);
        } else if (n->code == BLAME_POW && (j->is[n->b] & MOVES) == 0 && j->at.value[n->b] < 0.0) {
            mark(j, n->a, DIVIDES);
        } else if (n->code == BLAME_CALL && n->function == FN_TAN) {
            mark(j, n->a, OF_A_TAN);
        }
        if ((is & DIVIDES) == 0) {
            continue;
        }
        const bool has_factors = n->code == BLAME_MUL || n->code == BLAME_DIV ||
                                 n->code == BLAME_NEG || n->code == BLAME_SAME ||
                                 n->code == BLAME_POW || is_size_or_root(n);
        if (has_factors) { /* what a divisor is divided by has been marked above */
            j->is[i] &= (unsigned char)~DIVIDES;
            mark(j, n->a, DIVIDES);
            if (n->code == BLAME_MUL) {
                mark(j, n->b, DIVIDES);
            }
        }
    }
}

static void find_order(jumped *j) {
    const image_blame *b = &j->at.image->blame;
    for (int i = b->nodes - 1; i >= 0; i--) {
        const unsigned as = (j->is[i] & (MOVES | HIDDEN)) == MOVES ? j->is[i] : 0U;
        const bool watched = (as & (DIVIDES | OF_A_TAN)) != 0;
        if ((as & DIVIDES) != 0) {
            j->divisor[j->divisors++] = (divisor){.node = i};
        }
        if ((as & OF_A_TAN) != 0) {
            j->divisor[j->divisors++] = (divisor){.node = i, .of_a_tan = true};
        }
        if (watched || (j->is[i] & NEEDED) != 0) {
            int of[2];
            const int count = operands(&b->node[i], of);
            mark(j, i, NEEDED);
            for (int k = 0; k < count; k++) {
                mark(j, of[k], NEEDED);
            }
        }
    }
    for (int i = 0; i < b->nodes; i++) {
        if ((j->is[i] & (NEEDED | MOVES)) == (NEEDED | MOVES)) {
            j->order[j->ordered++] = i;
        }
    }
}

jumped *jumped_open(const image *im) {
    const int nodes = im->blame.nodes;
    jumped *j = room(1, sizeof *j);
    j->at = blamed_open(im);
    j->components = im->angles + im->reals;
    j->is = room(nodes, sizeof *j->is);
    j->order = room(nodes, sizeof *j->order);
    j->divisor = room(2 * nodes, sizeof *j->divisor);
    j->found = -1;
    find_what_moves(j);
    find_factors(j);
    find_order(j);
    if (j->divisors == 0) {
        jumped_close(j);
        return NULL;
    }
    j->from = room(j->components, sizeof *j->from);
    j->to = room(j->components, sizeof *j->to);
    return j;
}

void jumped_close(jumped *j) {
    if (j != NULL) {
        blamed_close(&j->at);
        free(j->is);
        free(j->order);
        free(j->divisor);
        free(j->from);
        free(j->to);
        free(j);
    }
}

/* --- is there a pole on the way? ---------------------------------------------------------------------*/

static double divisor_value(const jumped *j, const divisor *d) {
    const double value = j->at.value[d->node];
    return d->of_a_tan ? number_cosine(value) : value;
}

/* How far this component goes in the step: turn angles are given within a turn. */
static double way_of(const jumped *j, int i) {
    const double way = j->to[i] - j->from[i];
    return i < j->at.image->angles ? number_centred(way, 6.283185307179586) : way;
}

/* Every expression, so far on the way. */
static void go_to(jumped *j, double share) {
    const image *im = j->at.image;
    double state[3 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < j->components; i++) {
        state[i] = j->from[i] + share * way_of(j, i);
    }
    blamed_place(&j->at, state, state + im->angles);
    for (int i = 0; i < im->blame.nodes; i++) {
        if ((j->is[i] & MOVES) != 0) {
            j->at.value[i] = blamed_node(&j->at, &im->blame.node[i]);
        }
    }
}

/* How far the state goes in the step, as a part of itself; of the components that this node depends on. */
static double relative_way(const jumped *j, int node) {
    const image *im = j->at.image;
    bool *of = room(node + 1, sizeof *of);
    double most = 0.0;
    of[node] = true;
    for (int i = node; i >= 0; i--) {
        const blame_node *n = &im->blame.node[i];
        int operand[2];
        const int count = of[i] ? operands(n, operand) : 0;
        for (int k = 0; k < count; k++) {
            of[operand[k]] = true;
        }
        if (of[i] && n->code == BLAME_STATE) {
            const int c = image_find_component(im, n->a, n->b);
            const double size = number_most(fabs(j->from[c]), fabs(j->to[c]));
            most = size > 0.0 ? number_most(most, fabs(way_of(j, c)) / size) : most;
        }
    }
    free(of);
    return most;
}

typedef struct bracket {
    double low; /* shares of the way, at which the sign is the one before and the one behind */
    double high;
} bracket;

static void halve(jumped *j, const divisor *d, int times, bracket *b) {
    const bool rising = d->before < 0.0;
    for (int i = 0; i < times; i++) {
        const double middle = 0.5 * (b->low + b->high);
        go_to(j, middle);
        if ((divisor_value(j, d) < 0.0) == rising) {
            b->low = middle;
        } else {
            b->high = middle;
        }
    }
}

/* size[terms]: of each expression, the lesser of its sizes on the two sides. */
static void sizes_at(jumped *j, const bracket *b, double *size) {
    const image_blame *all = &j->at.image->blame;
    go_to(j, b->low);
    for (int i = 0; i < all->terms; i++) {
        size[i] = fabs(j->at.value[all->question[i].node]);
    }
    go_to(j, b->high);
    for (int i = 0; i < all->terms; i++) {
        size[i] = number_least(size[i], fabs(j->at.value[all->question[i].node]));
    }
}

/* The first expression with a pole where this node changes its sign; -1: none. What grows twice, one time after the other:
 * once may be a zero that was beside it. */
static int pole_at(jumped *j, const divisor *d) {
    const int terms = j->at.image->blame.terms;
    const double way = relative_way(j, d->node);
    double *size = room(terms, sizeof *size);
    double *nearer = room(terms, sizeof *nearer);
    bool *grew = room(terms, sizeof *grew);
    bracket b = {0.0, 1.0};
    int found = -1;
    halve(j, d, HALVINGS_FIRST, &b);
    sizes_at(j, &b, size);
    while (found < 0 && way * (b.high - b.low) > RESOLVED) {
        halve(j, d, HALVINGS, &b);
        sizes_at(j, &b, nearer);
        for (int i = 0; i < terms && found < 0; i++) {
            const bool grows = size[i] > 0.0 && nearer[i] > GROWS * size[i];
            found = grows && grew[i] ? i : -1;
            grew[i] = grows;
        }
        memcpy(size, nearer, (size_t)terms * sizeof *size);
    }
    free(size);
    free(nearer);
    free(grew);
    return found;
}

/* --- step by step ------------------------------------------------------------------------------------*/

static bool had_events(jumped *j, const engine_kind *kind, const void *run) {
    uint64_t overruns = 0;
    const uint64_t events = kind->events(run, &overruns) + overruns;
    const bool some = events != j->events;
    j->events = events;
    return some;
}

static bool changes_sign(const divisor *d) {
    return (d->before < 0.0 && d->now > 0.0) || (d->before > 0.0 && d->now < 0.0);
}

void jumped_enter(jumped *j, const engine_kind *kind, const void *run) {
    if (j == NULL || j->found >= 0) {
        return;
    }
    const image *im = j->at.image;
    const uint64_t steps = kind->steps(run);
    const bool looks = !had_events(j, kind, run) && steps > 0;
    memcpy(j->from, j->to, (size_t)j->components * sizeof *j->to);
    kind->state(run, j->to, j->to + im->angles);
    blamed_place(&j->at, j->to, j->to + im->angles);
    for (int i = 0; i < j->ordered; i++) {
        j->at.value[j->order[i]] = blamed_node(&j->at, &im->blame.node[j->order[i]]);
    }
    for (int i = 0; i < j->divisors; i++) {
        divisor *d = &j->divisor[i];
        d->before = d->now;
        d->now = divisor_value(j, d);
    }
    for (int i = 0; i < j->divisors && looks && j->found < 0; i++) {
        if (changes_sign(&j->divisor[i])) {
            j->found = pole_at(j, &j->divisor[i]);
            j->found_s = ratio_times(steps - 1, im->step);
        }
    }
}

bool jumped_some(const jumped *j) { return j != NULL && j->found >= 0; }

const blame_question *jumped_over(const jumped *j, double *begin_s) {
    *begin_s = j->found_s;
    return &j->at.image->blame.question[j->found];
}
