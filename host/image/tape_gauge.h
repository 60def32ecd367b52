/* tape_gauge.h: the gauge freedom of a list: its values may be multiplied by numbers that drop out again, as
 * a numerator and its denominator may, or the equations of a system. Constants of float are better off with some of
 * these numbers than with others: 1.08 - 0.36 s^2 under M is 27 - 9 s^2 under 25 M, and no constant is rounded. */
#ifndef IMAGE_TAPE_GAUGE_H
#define IMAGE_TAPE_GAUGE_H

#include "host/image/tape.h"

/* What float's constants make of the results of a finished list, rounding nothing else: the root of the mean square, over
 * its results and over made-up states with rates of three sizes, of how much they are off, relative to their size.
 * What the list does not depend on again counts little.
 * `like` is the list that says what they are, itself or another one that computes the same. NaN where there
 * is no telling. */
double tape_bias(const tape *t, const tape *like);

/* Most operations that a better list may have more: one, and one for each forty that there are. */
int tape_gauge_price(const tape *t);

/* A list that computes the same, but for double's rounding, whose bias is at most half of that of *t takes the place of
 * *t, if there is one that is found and costs no more than so many operations more. */
void tape_gauge(tape **t, int price);

/* --- parts of it -----------------------------------------------------------------------------------------------*/

/* Can a value be had as it is only, so that multiplying it costs a product? What a leaf, a sine or a function gives. */
bool tape_is_raw(const op *o);

/* Vectors of exponents: what may be multiplied together by x to these, for any x > 0. First one for each operation, then
 * two for each: those of its operands, where these are raw values, which may be taken as they are or multiplied. */
typedef struct tape_freedoms {
    double *exponent; /* [count * length] */
    int count;
    int length; /* 3 * operations of the list */
} tape_freedoms;

/* Those that need no product more, those that multiply one raw value, at all places or at some, and those that multiply two. */
tape_freedoms tape_freedoms_of(const tape *t);
void tape_freedoms_free(tape_freedoms *f);

/* The list whose operations are times[3 * count] > 0 as large, in the same order, where the constants, and products that
 * are put in where these do not do, give the same results. Finished (tape_prune(), tape_order()). */
tape *tape_multiplied(const tape *t, const double *times);

#endif
