/* pieces.h: a poly's terms with powers of sines and cosines put back where the normal form made
 * multiple angles of them. */
#ifndef DERIVE_PIECES_H
#define DERIVE_PIECES_H

#include "host/algebra/poly.h"

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

#endif
