/* folding.h: constant folding in derivations, with a record of the digits that it loses.
 *
 * A folded sum k1 + k2 is one double: the smaller addend loses its digits below the last digit of the larger. Usually
 * that does not matter. But elimination, or a sum at run time, may cancel k2 and keep only k1, with its lost digits.
 * All users of the folded sum have lost the same digits, so no comparison of two runs shows the loss. Two checks
 * address this:
 *   - Each sum records its round-off, relative to its smallest addend and to its result. A residue is a result that is
 *     only round-off, such as cos(90 deg) or 0.1 + 0.2 - 0.3. A residue loses nothing, and neither do products with it.
 *     It counts as a loss if it is a large part of a sum, or a divisor.
 *   - A derivation can be repeated in another *way*, in which inexact results are moved by one or two doubles. Exact
 *     results stay, and nearly equal numbers are not merged. If several round-offs add up, one way may yield the same
 *     numbers by chance. So there are several ways (Vignes, A stochastic arithmetic for reliable scientific
 *     computation, 1993, does this at run time).
 *
 * Each derivation has its own `folding`: the way, and the record. folding_use() sets the current one for the whole
 * program, as a processor's rounding mode is set. */
#ifndef NUMBER_FOLDING_H
#define NUMBER_FOLDING_H

#include <stdbool.h>

#include "host/number/functions.h"

/* FOLDING_NEAREST rounds to nearest, as a board does. FOLDING_OTHER rounds sums and functions to the other side of the
 * exact value. FOLDING_APART rounds to nearest, but does not merge nearly equal numbers. In the ways from FOLDING_SOME
 * on, a hash of the operands' digits decides whether an inexact result moves up or down. */
enum { FOLDING_NEAREST, FOLDING_OTHER, FOLDING_APART, FOLDING_SOME, FOLDING_WAYS = 7 };

/* Largest number of recorded residues. Further residues are not recognized. */
enum { FOLDING_RESTS = 256 };
typedef struct folding {
    int way;
    double lost;                /* largest loss, relative to an addend or a result */
    int rests;                  /* number of residues */
    double rest[FOLDING_RESTS]; /* absolute values of the residues */
} folding;

/* Makes `f` the current folding. Returns the previous one, which the caller must set again before `f` goes out of
 * scope. */
folding *folding_use(folding *f);
int folding_way(void);

double folding_sum(double x, double y);
double folding_product(double x, double y);
double folding_quotient(double x, double y);
/* folding_power() and folding_call() compute as number_power() and number_call() do, and record losses. A sine, cosine
 * or tangent that is no larger than the round-off of its angle is a residue. */
double folding_power(double base, double exponent);
double folding_call(function_id function, double x, double y);
/* `left` is the difference of two numbers whose absolute value is `size`. Returns true if it counts as zero, because
 * it is at most part * size. If it exceeds the round-off of a few operations, it is recorded as a loss. In other ways
 * than FOLDING_NEAREST, only an exact zero counts as zero. */
bool folding_cancels(double left, double size, double part);
/* Returns true if the difference of x and y counts as zero by folding_cancels(), with the larger one as `size`. */
bool folding_same(double x, double y, double part);

#endif
