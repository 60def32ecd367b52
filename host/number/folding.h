/* folding.h: constant folding in derivations, with a record of the digits that it loses.
 *
 * k1 + k2 is one double: the smaller addend loses its digits below the last digit of the larger. Usually that does not matter. But
 * elimination, or sums at run time, may cancel k2 and leave k1 alone. Then all users of the folded numbers have lost the same
 * digits, and no comparison of two runs shows it. Two checks address this:
 *   - Each sum records its round-off, relative to its smallest addend and to its result. A residue, such as cos(90 deg) or 0.1 +
 *     0.2 - 0.3, is round-off only and loses nothing, and neither do products with it. A residue counts as a loss if it is a large
 *     part of a sum, or a divisor.
 *   - A derivation can be repeated in another *way*: inexact results move by a double or two, to the other side of the exact value,
 *     or to either side. Exact results stay, and nearly equal numbers are not merged. One way may yield the same numbers by chance
 *     if several round-offs add up, so there are several (Vignes, A stochastic arithmetic for reliable scientific computation,
 *     1993, at run time).
 *
 * Each derivation has its own `folding`: the way, and the record. folding_use() sets the current one, like a processor's rounding
 * mode. */
#ifndef NUMBER_FOLDING_H
#define NUMBER_FOLDING_H

#include <stdbool.h>

#include "host/number/functions.h"

/* FOLDING_NEAREST rounds to nearest, as on a board. FOLDING_OTHER rounds sums and functions to the other side of the
 * exact value. FOLDING_APART rounds to nearest, without merging nearly equal numbers. From FOLDING_SOME on, all results
 * are rounded up or down, as a hash of their digits decides. */
enum { FOLDING_NEAREST, FOLDING_OTHER, FOLDING_APART, FOLDING_SOME, FOLDING_WAYS = 7 };

/* Room for residues; further ones are not recognized. */
enum { FOLDING_RESTS = 256 };
typedef struct folding {
    int way;
    double lost;                /* the largest loss, as a part of an addend or of a result */
    int rests;                  /* number of residues */
    double rest[FOLDING_RESTS]; /* without their signs */
} folding;

/* Returns the previous one, which must be restored before `f` ends. */
folding *folding_use(folding *f);
int folding_way(void);

double folding_sum(double x, double y);
double folding_product(double x, double y);
double folding_quotient(double x, double y);
/* As number_power() and number_call(), with the record. A sine or cosine no larger than the round-off of its angle is a
 * residue. */
double folding_power(double base, double exponent);
double folding_call(function_id function, double x, double y);
/* Does `left`, the difference of two numbers of this size, count as zero? It does up to `part` of their size. It is
 * recorded as a loss if it exceeds the round-off of a few operations. In other ways only an exact zero counts. */
bool folding_cancels(double left, double size, double part);
/* Are two numbers equal, up to this part of their size? */
bool folding_same(double x, double y, double part);

#endif
