/* lower.h: from polys to operations: which sines are evaluated and which follow from them, what is
 * factored out, what is shared. */
#ifndef DERIVE_LOWER_H
#define DERIVE_LOWER_H

#include "host/algebra/poly.h"
#include "host/image/tape.h"

/* === powers from multiple angles ============================================================== */
/* A poly's terms with powers of sines and cosines put back where the normal form made
 * multiple angles of them. */

/* One term on its way: coefficient * the mono's factors * sin(angle)^sines * cos(angle)^cosines. */
typedef struct piece {
    double coefficient;
    const mono *mono;  /* its factors; its own sine or cosine is replaced by the powers */
    const poly *angle; /* NULL when both powers are 0 */
    int sines;
    int cosines;
} piece;

/* Terms that cancel near x = 0 or x = pi/2, such as c (1 - cos 2x) = 2 c sin(x)^2 and
 * c (3 - 4 cos 2x + cos 4x) = 8 c sin(x)^4 (the poles of spherical coordinates), and their slopes, such
 * as 2 sin 2x - sin 4x = 8 sin(x)^3 cos(x): the sums would lose all digits there, the powers keep them.
 * x itself must be a whole multiple of the coordinates.
 * piece[p->count] receives the pieces; returns their number. */
int pieces_of(algebra *a, const poly *p, piece *pieces);

typedef struct wave wave;

typedef struct lowering {
    algebra *algebra;
    tape *tape;
    /* The operation for a symbol that stands outside sines (a leaf of the tape). */
    int (*leaf)(void *context, tape *t, const symbol *sym, int primes);
    /* Index of the turn angle that the symbol is kept as, or -1. */
    int (*turn)(void *context, const symbol *sym);
    void *context;
    /* Which of the planned angles, by size, is evaluated before all others: 0 the smallest. */
    int lead;
    wave *waves;
    int wave_count;
    int wave_room;
} lowering;

/* Announce everything that will be lowered, before lowering any of it: the choice of which sines to
 * evaluate looks at all of them. */
void lower_plan(lowering *l, const poly *const *polys, int count);

/* The operation that computes p. */
int lower(lowering *l, const poly *p);

void lower_done(lowering *l);

/* A tangent is the one function that may be made of a turn angle's sine and cosine. */
static inline bool lower_is_tangent(const atom *x) {
    return x->kind == ATOM_CALL && x->function == FN_TAN;
}

/* True when every place of the symbol (no primes) in p is inside a sine or cosine, with a whole
 * factor: then it can be kept as a turn angle. */
bool lower_only_in_waves(const poly *p, const symbol *sym);

#endif
