/* folding.h: constant folding in derivations, with a record of the digits that it loses.
 *
 * A folded sum k1 + k2 is one double: the smaller addend loses its digits below the last digit of the larger. Usually
 * that does not matter. But if elimination, or a sum at run time, cancels the larger addend, only the smaller one with
 * its lost digits remains. All users of the folded sum have lost the same digits, so no comparison of two runs shows
 * the loss. Two checks address this:
 *   - A sum records its loss: its round-off, relative to the smallest of the addends and the result. A residue is a
 *     result that is only round-off, such as cos(90 deg) or 0.1 + 0.2 - 0.3, or a product with a residue. A residue is
 *     a loss if it exceeds 1e-12 in SI units, if it is a divisor, or if it is a large part of a sum.
 *   - A derivation can be repeated in another *way*, in which inexact results are moved by one or two doubles, and
 *     nearly equal numbers are not merged. There are several ways, because round-offs may cancel in one by chance
 *     (Vignes, A stochastic arithmetic for reliable scientific computation, 1993, does this at run time).
 *
 * folding_use() sets the `folding` of the whole program, as a processor's rounding mode is set. */
#ifndef NUMBER_FOLDING_H
#define NUMBER_FOLDING_H

#include <stdbool.h>

#include "host/number/functions.h"

/* FOLDING_NEAREST rounds to nearest, as a board does. FOLDING_OTHER rounds sums and functions to the other side of the
 * exact value. FOLDING_APART rounds to nearest, but does not merge nearly equal numbers. From FOLDING_SOME on, a hash
 * of the operands' digits decides whether an inexact result moves up or down. */
enum { FOLDING_NEAREST, FOLDING_OTHER, FOLDING_APART, FOLDING_SOME, FOLDING_WAYS = 7 };

/* Largest number of recorded residues. Further residues are not recognized. */
enum { FOLDING_RESTS = 256 };
typedef struct folding {
    int way;
    double lost;                /* largest relative loss; 1: no digit is correct */
    int rests;                  /* number of residues */
    double rest[FOLDING_RESTS]; /* absolute values of the residues */
} folding;

/* Makes `f` the current folding. Returns the previous one, which the caller must restore before `f` goes out of
 * scope. */
folding *folding_use(folding *f);
int folding_way(void);

/* These functions record losses if the way is FOLDING_NEAREST. */
double folding_sum(double x, double y);
double folding_product(double x, double y);
double folding_quotient(double x, double y);
double folding_power(double base, double exponent);
/* A sine, cosine or tangent is a residue if it is not larger than the round-off of its angle. */
double folding_call(function_id function, double x, double y);
/* Returns true if |left| <= part * size. `left` is a sum or difference of terms that are about as large as `size`.
 * Records a loss if the result is true although |left| exceeds the round-off of a few operations. In ways other than
 * FOLDING_NEAREST, returns true only if `left` is exactly zero. */
bool folding_cancels(double left, double size, double part);
/* folding_cancels() for x - y, with the larger absolute value as `size`. */
bool folding_same(double x, double y, double part);

#endif
