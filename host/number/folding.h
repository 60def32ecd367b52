/* folding.h: sums, products and functions of constants, as derivations fold them, and how many digits they lose.
 *
 * k1 + k2 is one double: of the smaller addend it keeps what is above the last digit of the larger. Mostly nobody asks for
 * more. Where equations are eliminated, or run-time sums cancel, so that k1 alone is left, everything that goes by the folded
 * numbers has lost the same digits, and no comparison of two runs shows it. So
 *
 *   - it is noted what part of its smallest addend, or of what is left of it, rounding a sum may have made. What is but the
 *     rounding of other numbers, as cos(90 deg) or 0.1 + 0.2 - 0.3, loses nothing, and neither do products with it, unless
 *     it is no small part of what it is added to, or divides;
 *   - a derivation can be made again in another *way*: what is not exact is moved by a double or two, to the other side of
 *     what is exact, or to either. What is exact stays, and nothing is put onto what is nearly the same. Where several roundings add up, one way may come to the same numbers by chance; hence more
 *     than one (Vignes, A stochastic arithmetic for reliable scientific computation, 1993, has his at run time).
 *
 * Whoever derives has a `folding` of its own: the way, and what was noted. folding_use() puts it in place, as a rounding mode is
 * put in a processor, and whoever folds below takes that. */
#ifndef NUMBER_FOLDING_H
#define NUMBER_FOLDING_H

#include <stdbool.h>

#include "functions.h"

/* To nearest, as everything that runs on a board; sums and functions to the other side; to nearest, but nothing put onto what
 * is nearly the same; and then all, products and quotients too, up or down by their digits. */
enum { FOLDING_NEAREST, FOLDING_OTHER, FOLDING_APART, FOLDING_SOME, FOLDING_WAYS = 7 };

/* Of more rests than there is room for, none is known to be rounding alone. */
enum { FOLDING_RESTS = 256 };
typedef struct folding {
    int way;
    double lost;                /* the largest part of an addend, or of a sum that cancels */
    int rests;                  /* so many numbers are but the rounding of others */
    double rest[FOLDING_RESTS]; /* without their signs */
} folding;

/* Returns what was in place, to be put back before `f` ends. */
folding *folding_use(folding *f);
/* Of what is in place. */
int folding_way(void);

double folding_sum(double x, double y);
double folding_product(double x, double y);
double folding_quotient(double x, double y);
/* number_power() and number_call(): sines and cosines that are no more than what rounding their angle made are rests. */
double folding_power(double base, double exponent);
double folding_call(function_id function, double x, double y);
/* Is `left`, which two numbers of this size leave of each other, nothing? Up to `part` of them it is: a last digit or two are
 * of the decimals that they came from, what is more is noted. In another way nothing but zero is. */
bool folding_cancels(double left, double size, double part);
/* Are two numbers one, but for such a part? */
bool folding_same(double x, double y, double part);

#endif
