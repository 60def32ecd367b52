/* solve.c: solving for the highest derivatives in the cheapest of several arrangements.
 *
 * Arrangements (arrange.h) differ in the scale of the equations, in which coordinates with a constant diagonal
 * are eliminated while still symbolic (a carriage's total mass, a body on a hinge: what is left comes to its normal
 * form again and may shrink), in the order of elimination, and in which sines are evaluated. Two equations that remain
 * are solved by Cramer's rule: one division. The winner is what tape_weight() says, not a belief. */
#include "solve.h"

#include <stdlib.h>

#include "arrange.h"
#include "eliminate.h"
#include "host/base/room.h"

/* Elimination orders are tried exhaustively up to so many unknowns. */
#define PERMUTED_MAX 4
/* ... and while the equations have no more leaves than this: large ones take the first order. */
#define PERMUTED_SIZE_MAX 4000.0
/* So many sines are tried as the first to be evaluated, besides the smallest angle's. */
#define LEADS_MAX 5

/* --- one arrangement -----------------------------------------------------------------------------*/

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
    arranged w;
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

static void try_it(const lowering *l, const linear_system *s, const arrangement *how,
                   choice *best) {
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
        if (s->sparing && !s->precise) {
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
