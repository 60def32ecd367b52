/* pieces.h: a poly's terms with squares of sines and cosines put back where the normal form made
 * double angles of them. */
#ifndef DERIVE_PIECES_H
#define DERIVE_PIECES_H

#include "host/algebra/poly.h"

/* One term on its way: the mono's factors and at most one sine or cosine, perhaps squared. */
typedef struct piece {
    double coefficient;
    const mono *mono; /* its factors; its own sine is replaced by `trig` */
    trig trig;
    const poly *angle;
    bool squared;
} piece;

/* c (1 - cos 2x) = 2 c sin(x)^2 and c (1 + cos 2x) = 2 c cos(x)^2: the normal form's sums would lose
 * all digits near x = 0 (the pole of spherical coordinates), the squares keep them.
 * piece[p->count] receives the pieces; returns their number. */
int pieces_of(algebra *a, const poly *p, piece *pieces);

#endif
