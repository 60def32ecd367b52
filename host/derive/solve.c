/* solve.c: solving for the highest derivatives in the cheapest of several arrangements.
 *
 * Arrangements differ in the scale of the equations, in which coordinates with a constant diagonal
 * are eliminated while still symbolic (a carriage's total mass: what is left comes to its normal
 * form again and may shrink), and in the order of elimination. Two equations that remain are solved
 * by Cramer's rule: one division. The winner is what tape_weight() says, not a belief. */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "eliminate.h"
#include "hinge.h"
#include "host/base/room.h"

/* Elimination orders are tried exhaustively up to so many unknowns. */
#define PERMUTED_MAX 4
/* ... and while the equations have no more leaves than this: large ones take the first order. */
#define PERMUTED_SIZE_MAX 4000.0
/* So many sines are tried as the first to be evaluated, besides the smallest angle's. */
#define LEADS_MAX 5
/* Symbolic elimination stops when an entry would get more terms than this. */
#define SYMBOLIC_TERMS_MAX 60

typedef struct arrangement {
    bool scaled;
    bool rescaled; /* what is left after symbolic elimination */
    bool hinged;   /* what hangs on hinges goes first, in the order: hinge.h */
    int lead;      /* the sine that is evaluated first: lower.h */
    int first;     /* unknown eliminated symbolically; -1 none; -2 every constant diagonal */
    int order[COORDINATES_MAX]; /* of elimination */
} arrangement;

/* --- scaling -------------------------------------------------------------------------------------*/

/* Different numbers that are counted; later ones are not, in what is large beyond any choice. */
#define TALLY_MAX 128

/* Starts as {0}. */
typedef struct tally {
    double size[TALLY_MAX];
    int uses[TALLY_MAX];
    int count;
} tally;

static void tally_add(tally *t, const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const double size = fabs(p->terms[i].coefficient);
        int k = 0;
        while (k < t->count && fabs(t->size[k] - size) > 1e-13 * size) {
            k++;
        }
        if (k == t->count && k < TALLY_MAX) {
            t->size[t->count++] = size;
        }
        if (k < t->count) {
            t->uses[k]++;
        }
    }
}

static double tally_favourite(const tally *t) {
    int best = -1;
    for (int k = 0; k < t->count; k++) {
        if (best < 0 || t->uses[k] > t->uses[best]) {
            best = k;
        }
    }
    return best < 0 ? 1.0 : t->size[best];
}

/* scale[i] for row and column i, and a common divisor, so that most coefficients become one. */
static double choose_scales(const linear_system *s, double *scale) {
    const int n = s->n;
    tally all = {.count = 0};
    bool any_turning = false;
    for (int i = 0; i < n; i++) {
        any_turning = any_turning || s->turning[i];
    }
    for (int i = 0; i < n; i++) {
        scale[i] = 1.0;
        if (any_turning && !s->turning[i]) {
            continue;
        }
        tally_add(&all, s->force[i]);
        for (int j = 0; j < n; j++) {
            if (!any_turning || s->turning[j]) {
                tally_add(&all, s->mass[i * n + j]);
            }
        }
    }
    const double common = tally_favourite(&all);
    for (int i = 0; i < n && any_turning; i++) {
        if (!s->turning[i]) {
            tally row = {.count = 0};
            for (int j = 0; j < n; j++) {
                if (s->turning[j]) {
                    tally_add(&row, s->mass[i * n + j]);
                }
            }
            scale[i] = row.count == 0 ? 1.0 : common / tally_favourite(&row);
        }
    }
    return common;
}

/* c * scale, put onto a simple fraction where it comes out a rounding error beside one: 1.0000000000000002 would
 * cost a product. */
static double scale_number(double c, double scale) {
    const double scaled = c * scale;
    const double nearest = number_floor(scaled * 48.0 + 0.5) / 48.0;
    return nearest != 0.0 && fabs(scaled - nearest) <= 1e-15 * fabs(scaled) ? nearest : scaled;
}

static const poly *scale_simply(algebra *a, const poly *p, double scale) {
    return poly_each_number(a, p, scale_number, scale);
}

/* --- symbolic elimination ------------------------------------------------------------------------*/

static bool number_at(const poly *const *mass, int n, int i, double *value) {
    return poly_is_number(mass[i * n + i], value) && *value != 0.0;
}

/* Eliminate unknown k from the others in symbols. False, with nothing changed, if it would grow. */
static bool eliminate_symbolic(algebra *a, int n, const poly **mass, const poly **force,
                               const bool *gone, int k) {
    double diagonal;
    if (!number_at(mass, n, k, &diagonal)) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (mass[i * n + k]->count * mass[k * n + j]->count > SYMBOLIC_TERMS_MAX) {
                return false;
            }
        }
    }
    for (int i = 0; i < n; i++) {
        if (gone[i] || i == k || poly_is_zero(mass[i * n + k])) {
            continue;
        }
        const poly *part = poly_scale(a, mass[i * n + k], 1.0 / diagonal);
        for (int j = 0; j < n; j++) {
            if (!gone[j] && j != k) {
                mass[i * n + j] = poly_sub(a, mass[i * n + j], poly_mul(a, part, mass[k * n + j]));
            }
        }
        force[i] = poly_sub(a, force[i], poly_mul(a, part, force[k]));
    }
    return true;
}

/* Of those that are eliminated, in their order, who is not wanted and whom nobody that is wanted is made from: their
 * equations need not be computed, and what sines stand in no other one need not be taken. */
static void forget_unwanted(algebra *a, const linear_system *s, const poly **mass,
                            const poly **force, const int *order, int eliminated) {
    const int n = s->n;
    for (int e = 0; e < eliminated && !s->wanted[order[e]]; e++) {
        const int k = order[e];
        for (int i = 0; i < n; i++) {
            if (i != k) {
                mass[k * n + i] = mass[i * n + k] = poly_number(a, 0.0);
            }
        }
        force[k] = poly_number(a, 0.0);
    }
}

/* What is left by symbols divided by the size that most of its numbers have: they become one. */
static void scale_what_is_left(algebra *a, int n, const poly **mass, const poly **force,
                               const bool *gone) {
    tally all = {.count = 0};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (!gone[j]) {
                tally_add(&all, mass[i * n + j]);
            }
        }
        if (!gone[i]) {
            tally_add(&all, force[i]);
        }
    }
    const double scale = 1.0 / tally_favourite(&all);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (!gone[j]) {
                mass[i * n + j] = scale_simply(a, mass[i * n + j], scale);
            }
        }
        if (!gone[i]) {
            force[i] = scale_simply(a, force[i], scale);
        }
    }
}

/* --- one arrangement -----------------------------------------------------------------------------*/

/* The equations as an arrangement leaves them: all polys in one piece, for lower_plan(). */
typedef struct arranged {
    int n;
    int polys;
    const poly **mass;    /* [n * n] */
    const poly **force;   /* [n] */
    int hinges;
    const poly **across; /* [hinges * (n + 1)] of hinge.h */
    double *inverse;     /* [hinges] what products of them are multiplied by */
    double *scale;        /* [n] of rows and columns */
    bool *gone;           /* [n] eliminated in symbols */
    int *order;           /* [n] those first */
    int eliminated;
} arranged;

static arranged arranged_room(int n) {
    arranged w = {.n = n, .polys = n * n + n + n * (n + 1)};
    w.mass = room(w.polys, sizeof *w.mass);
    w.force = w.mass + n * n;
    w.across = w.force + n;
    w.inverse = room(n, sizeof *w.inverse);
    w.scale = room(n, sizeof *w.scale);
    w.gone = room(n, sizeof *w.gone);
    w.order = room(n, sizeof *w.order);
    return w;
}

static void arranged_free(arranged *w) {
    free(w->mass);
    free(w->inverse);
    free(w->scale);
    free(w->gone);
    free(w->order);
}

static void scale_all(algebra *a, const linear_system *s, const arrangement *how, arranged *w) {
    const int n = s->n;
    double common = 1.0;
    for (int i = 0; i < n; i++) {
        w->scale[i] = 1.0;
    }
    if (how->scaled) {
        common = choose_scales(s, w->scale);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double factor_ij = w->scale[i] * w->scale[j] / common;
            w->mass[i * n + j] =
                how->scaled ? scale_simply(a, s->mass[i * n + j], factor_ij) : s->mass[i * n + j];
        }
        w->force[i] =
            how->scaled ? scale_simply(a, s->force[i], w->scale[i] / common) : s->force[i];
    }
    for (int i = 0; i < n * (n + 1); i++) {
        w->across[i] = poly_number(a, 0.0);
    }
}

static void put_away(arranged *w, int k) {
    w->gone[k] = true;
    w->order[w->eliminated++] = k;
}

/* Is unknown k on none of the hinges so far? */
static bool off_hinges(const arranged *w, int k) {
    bool off = true;
    for (int h = 0; h < w->hinges; h++) {
        off = off && poly_is_zero(w->across[h * (w->n + 1) + k]);
    }
    return off;
}

/* All that hang on hinges, in the order. False: none does. */
static bool eliminate_hinged(algebra *a, const linear_system *s, const arrangement *how,
                             arranged *w) {
    const int n = s->n;
    for (int i = 0; i < n; i++) {
        const int k = how->order[i];
        const poly **across = w->across + w->hinges * (n + 1);
        double own;
        if (off_hinges(w, k) && hinge_eliminate(a, n, w->mass, w->force, w->gone, k, s->unknown[k],
                                                &own, across)) {
            w->inverse[w->hinges++] = 1.0 / own;
            put_away(w, k);
        }
    }
    return w->hinges > 0;
}

/* What is left of the equations of unknown i, and of its column, times a number: what else is said of it (across) too. */
static void scale_unknown(algebra *a, arranged *w, int i, double scale) {
    const int n = w->n;
    for (int j = 0; j < n; j++) {
        w->mass[i * n + j] = scale_simply(a, w->mass[i * n + j], scale);
        w->mass[j * n + i] = scale_simply(a, w->mass[j * n + i], scale);
    }
    for (int h = 0; h < w->hinges; h++) {
        const poly **across = &w->across[h * (n + 1) + i];
        *across = scale_simply(a, *across, scale);
    }
    w->force[i] = scale_simply(a, w->force[i], scale);
    w->scale[i] *= scale;
}

/* So that most numbers that the hinges left become one: all equations, then rows and columns of unknowns that are no
 * angles. */
static void scale_beside_hinges(algebra *a, const linear_system *s, arranged *w) {
    const int n = s->n;
    const double common = 1.0 / w->inverse[0];
    for (int h = 0; h < w->hinges; h++) {
        w->inverse[h] = scale_number(w->inverse[h], common);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !w->gone[i]; j++) {
            if (!w->gone[j]) {
                w->mass[i * n + j] = scale_simply(a, w->mass[i * n + j], common);
            }
        }
        if (!w->gone[i]) {
            w->force[i] = scale_simply(a, w->force[i], common);
        }
    }
    for (int i = 0; i < n; i++) {
        if (w->gone[i] || s->turning[i]) {
            continue;
        }
        tally row = {.count = 0};
        for (int h = 0; h < w->hinges; h++) {
            tally_add(&row, w->across[h * (n + 1) + i]);
        }
        tally_add(&row, w->force[i]);
        for (int j = 0; j < n; j++) {
            if (j != i) {
                tally_add(&row, w->mass[i * n + j]);
            }
        }
        scale_unknown(a, w, i, 1.0 / tally_favourite(&row));
    }
}

/* False: it cannot be arranged so. */
static bool arrange(algebra *a, const linear_system *s, const arrangement *how, arranged *w) {
    const int n = s->n;
    scale_all(a, s, how, w);
    if (how->hinged && !eliminate_hinged(a, s, how, w)) {
        return false;
    }
    for (int i = 0; i < n && how->first != -1; i++) {
        const int k = how->order[i];
        if ((how->first == -2 || how->first == k) &&
            eliminate_symbolic(a, n, w->mass, w->force, w->gone, k)) {
            put_away(w, k);
        }
    }
    if (how->hinged && how->rescaled) {
        scale_beside_hinges(a, s, w);
    } else if (how->rescaled && w->eliminated > 0) {
        scale_what_is_left(a, n, w->mass, w->force, w->gone);
    }
    if (s->sparing) {
        forget_unwanted(a, s, w->mass, w->force, w->order, w->eliminated);
    }
    int entered = w->eliminated;
    for (int i = 0; i < n; i++) {
        if (!w->gone[how->order[i]]) {
            w->order[entered++] = how->order[i];
        }
    }
    return true;
}

/* What hinge.h wants added: operations of `across`, for one hinge. */
static void add_across(tape *t, int n, const int *across, double inverse, int *mass, int *force) {
    const int factor = tape_constant(t, inverse);
    for (int i = 0; i < n; i++) {
        const int part = tape_mul(t, factor, across[i]);
        for (int j = 0; j <= i; j++) {
            const int product = tape_mul(t, part, across[j]);
            mass[i * n + j] = tape_add(t, mass[i * n + j], product);
            mass[j * n + i] = mass[i * n + j];
        }
        const int pull = tape_mul(t, part, across[n]);
        force[i] = tape_add(t, force[i], pull);
    }
}

/* Entered on `t`; solution[] receives the operations. False, with nothing entered, if it cannot be arranged so. */
static bool enter(const lowering *like, tape *t, const linear_system *s, const arrangement *how,
                  int *solution) {
    const int n = s->n;
    lowering l = *like;
    l.tape = t;
    l.waves = NULL;
    l.wave_count = l.wave_room = 0;
    l.lead = how->lead;
    arranged w = arranged_room(n);
    const bool can = arrange(l.algebra, s, how, &w);
    if (can) {
        int *node = room(w.polys, sizeof *node);
        lower_plan(&l, w.mass, w.polys);
        for (int i = 0; i < w.polys; i++) {
            node[i] = lower(&l, w.mass[i]);
        }
        lower_done(&l);
        for (int h = 0; h < w.hinges; h++) {
            const int *across = node + n * n + n + h * (n + 1);
            add_across(t, n, across, w.inverse[h], node, node + n * n);
        }
        eliminate(t, s->symmetric, n, node, node + n * n, w.order, w.eliminated, solution);
        for (int i = 0; i < n; i++) {
            solution[i] = tape_mul(t, tape_constant(t, w.scale[i]), solution[i]);
        }
        free(node);
    }
    arranged_free(&w);
    return can;
}

/* -1: it cannot be arranged so. */
static int weigh(const lowering *l, const linear_system *s, const arrangement *how) {
    tape *t = tape_new(l->tape->angles, s->n);
    int weight = -1;
    if (enter(l, t, s, how, t->result)) {
        for (int i = 0; i < s->n; i++) {
            t->result[i] = s->wanted[i] ? t->result[i] : tape_constant(t, 0.0);
        }
        tape_prune(t);
        if (s->sparing) {
            tape_share_sums(t);
        }
        weight = tape_weight(t);
    }
    tape_free(t);
    return weight;
}

/* The next permutation in lexical order; false after the last. */
static bool next_order(int *order, int n) {
    int i = n - 2;
    while (i >= 0 && order[i] > order[i + 1]) {
        i--;
    }
    if (i < 0) {
        return false;
    }
    int j = n - 1;
    while (order[j] < order[i]) {
        j--;
    }
    int swap = order[i];
    order[i] = order[j];
    order[j] = swap;
    for (int x = i + 1, y = n - 1; x < y; x++, y--) {
        swap = order[x];
        order[x] = order[y];
        order[y] = swap;
    }
    return true;
}

static bool can_be_permuted(const linear_system *s) {
    double size = 0.0;
    for (int i = 0; i < s->n; i++) {
        size += s->force[i]->size;
        for (int j = 0; j < s->n; j++) {
            size += s->mass[i * s->n + j]->size;
        }
    }
    return s->n <= PERMUTED_MAX && size <= PERMUTED_SIZE_MAX;
}

/* --- the cheapest ---------------------------------------------------------------------------------*/

typedef struct choice {
    arrangement how;
    int weight; /* -1: nothing was tried */
} choice;

static void try_it(const lowering *l, const linear_system *s, const arrangement *how, choice *best) {
    const int weight = weigh(l, s, how);
    if (weight >= 0 && (best->weight < 0 || weight < best->weight)) {
        *best = (choice){*how, weight};
    }
}

/* All ways of eliminating in the order of `like`. */
static void try_order(const lowering *l, const linear_system *s, const arrangement *like,
                      bool permuted, choice *best) {
    for (int scaled = 0; scaled < 2; scaled++) {
        arrangement how = *like;
        how.scaled = scaled == 1;
        for (int first = -2; first < (permuted ? s->n : 0); first++) {
            how.first = first;
            for (int again = 0; again < (first == -1 || !s->sparing ? 1 : 2); again++) {
                how.rescaled = again == 1;
                try_it(l, s, &how, best);
            }
        }
        if (s->sparing) {
            how.first = -1;
            how.hinged = true;
            for (int again = 0; again < 2; again++) {
                how.rescaled = again == 1;
                try_it(l, s, &how, best);
            }
        }
    }
}

/* The best one with other sines evaluated first. */
static void try_leads(const lowering *l, const linear_system *s, choice *best) {
    arrangement how = best->how;
    for (how.lead = 1; how.lead <= LEADS_MAX; how.lead++) {
        try_it(l, s, &how, best);
    }
}

void solve_highest(lowering *l, const linear_system *s, int *solution) {
    const int n = s->n;
    arrangement how = {.first = -1};
    int constants = 0;
    for (int pass = 0; pass < 2; pass++) { /* constant diagonals lead */
        for (int i = 0; i < n; i++) {
            double value;
            const bool constant = poly_is_number(s->mass[i * n + i], &value) && s->symmetric;
            if (constant == (pass == 0)) {
                how.order[constants++] = i;
            }
        }
    }
    const bool permuted = can_be_permuted(s);
    choice best = {how, -1};
    if (s->symmetric) {
        do {
            try_order(l, s, &how, permuted, &best);
        } while (permuted && next_order(how.order, n));
    }
    if (s->sparing) {
        try_leads(l, s, &best);
    }
    enter(l, l->tape, s, &best.how, solution);
}
