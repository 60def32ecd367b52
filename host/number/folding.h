/* folding.h: constant folding in derivations, with a record of the lost digits.
 *
 * A folded sum k1 + k2 is one double, so the smaller addend loses digits. The loss matters if a later sum cancels the
 * larger addend. No comparison of two runs shows the loss, because both runs use the sum. Two checks show the loss:
 *   - Each sum records its round-off, relative to the smallest of the addends and the result. A *residue* is a result
 *     that is only round-off, such as cos(90 deg). A residue is a loss if it exceeds 1e-12 (SI), is a divisor, or is a
 *     large part of a sum.
 *   - A derivation can be repeated in another *way*. The ways differ in the rounding of inexact results, and in the
 *     merging of nearly equal numbers. There are several ways, because round-offs may cancel by chance in one
 *     way (compare Vignes, A stochastic arithmetic for reliable scientific computation, 1993).
 *
 * Every function takes the `folding` of its derivation; NULL rounds to nearest and records nothing. */
#ifndef NUMBER_FOLDING_H
#define NUMBER_FOLDING_H

#include <stdbool.h>

#include "host/number/functions.h"

/* FOLDING_NEAREST rounds to nearest, as a board does. FOLDING_OPPOSITE rounds sums and functions to the other side of the
 * exact value. FOLDING_APART rounds to nearest, but does not merge nearly equal numbers. From FOLDING_SOME on, a hash
 * of the operands' digits decides whether an inexact result moves up or down. */
enum { FOLDING_NEAREST, FOLDING_OPPOSITE, FOLDING_APART, FOLDING_SOME, FOLDING_WAYS = 7 };

/* Largest number of recorded residues. Further residues are not recognized. */
enum { FOLDING_RESTS = 256 };
typedef struct folding {
    int way;
    double lost;                /* largest recorded relative round-off; 1: no digit is correct */
    int rests;                  /* number of residues */
    double rest[FOLDING_RESTS]; /* absolute values of the residues */
} folding;

int folding_way(const folding *f);

/* If folding.way is FOLDING_NEAREST, these functions update folding.lost and folding.rest. */
double folding_sum(folding *f, double x, double y);
double folding_product(folding *f, double x, double y);
double folding_quotient(folding *f, double x, double y);
double folding_power(folding *f, double base, double exponent);
/* A sine, cosine or tangent that is only round-off, such as cos(90 deg), is recorded in folding.rest. */
double folding_call(folding *f, function_id function, double x, double y);
/* `left` is a sum of terms about as large as `size`. If folding.way is FOLDING_NEAREST, returns |left| <= part * size.
 * If not, returns left == 0. A true result with |left| above round-off sets folding.lost to 1. */
bool folding_cancels(folding *f, double left, double size, double part);
/* folding_cancels() for x - y, with the larger absolute value as `size`. */
bool folding_same(folding *f, double x, double y, double part);

#endif
