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
#include "host/base/room.h"

/* Elimination orders are tried exhaustively up to so many unknowns. */
#define PERMUTED_MAX 4
/* ... and while the equations have no more leaves than this: large ones take the first order. */
#define PERMUTED_SIZE_MAX 4000.0
/* Symbolic elimination stops when an entry would get more terms than this. */
#define SYMBOLIC_TERMS_MAX 60

typedef struct arrangement {
    bool scaled;
    bool rescaled; /* what is left after symbolic elimination */
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

/* Entered on `t`; solution[] receives the operations. */
static void enter(const lowering *like, tape *t, const linear_system *s, const arrangement *how,
                  int *solution) {
    const int n = s->n;
    algebra *a = like->algebra;
    lowering l = *like;
    l.tape = t;
    l.waves = NULL;
    l.wave_count = l.wave_room = 0;
    const int64_t entries = (int64_t)n * n;
    const poly **mass = room(entries + n, sizeof *mass);
    int *node = room(entries + n, sizeof *node);
    double *scale = room(n, sizeof *scale);
    bool *gone = room(n, sizeof *gone);
    int *order = room(n, sizeof *order);
    const poly **force = mass + entries;
    double common = 1.0;
    for (int i = 0; i < n; i++) {
        scale[i] = 1.0;
    }
    if (how->scaled) {
        common = choose_scales(s, scale);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double factor_ij = scale[i] * scale[j] / common;
            mass[i * n + j] =
                how->scaled ? scale_simply(a, s->mass[i * n + j], factor_ij) : s->mass[i * n + j];
        }
        force[i] = how->scaled ? scale_simply(a, s->force[i], scale[i] / common) : s->force[i];
    }
    int eliminated = 0;
    for (int i = 0; i < n && how->first != -1; i++) {
        const int k = how->order[i];
        if ((how->first == -2 || how->first == k) &&
            eliminate_symbolic(a, n, mass, force, gone, k)) {
            gone[k] = true;
            order[eliminated++] = k;
        }
    }
    if (how->rescaled && eliminated > 0) {
        scale_what_is_left(a, n, mass, force, gone);
    }
    if (s->sparing) {
        forget_unwanted(a, s, mass, force, order, eliminated);
    }
    int entered = eliminated;
    for (int i = 0; i < n; i++) {
        if (!gone[how->order[i]]) {
            order[entered++] = how->order[i];
        }
    }
    lower_plan(&l, mass, (int)entries + n);
    for (int i = 0; i < (int)entries + n; i++) {
        node[i] = lower(&l, mass[i]);
    }
    lower_done(&l);
    eliminate(t, s->symmetric, n, node, node + entries, order, eliminated, solution);
    for (int i = 0; i < n; i++) {
        solution[i] = tape_mul(t, tape_constant(t, scale[i]), solution[i]);
    }
    free(mass);
    free(node);
    free(scale);
    free(gone);
    free(order);
}

static int weigh(const lowering *l, const linear_system *s, const arrangement *how) {
    tape *t = tape_new(l->tape->angles, s->n);
    enter(l, t, s, how, t->result);
    for (int i = 0; i < s->n; i++) {
        t->result[i] = s->wanted[i] ? t->result[i] : tape_constant(t, 0.0);
    }
    tape_prune(t);
    const int weight = tape_weight(t);
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
    arrangement best = how;
    int best_weight = -1;
    if (s->symmetric) {
        do {
            for (int scaled = 0; scaled < 2; scaled++) {
                for (int first = -2; first < (permuted ? n : 0); first++) {
                    for (int again = 0; again < (first == -1 || !s->sparing ? 1 : 2); again++) {
                        arrangement candidate = how;
                        candidate.scaled = scaled == 1;
                        candidate.rescaled = again == 1;
                        candidate.first = first;
                        const int weight = weigh(l, s, &candidate);
                        if (best_weight < 0 || weight < best_weight) {
                            best = candidate;
                            best_weight = weight;
                        }
                    }
                }
            }
        } while (permuted && next_order(how.order, n));
    }
    enter(l, l->tape, s, &best, solution);
}
