/* operands.h: what a scene's operations are given as it begins to move: which of them take a zero, and the like.
 *
 * Software arithmetic takes paths by its operands: what is at rest, or lies where a force has no part, costs less than
 * the rest. No count of operations says that; a short run of the image does. It is run by the interpreter for as many
 * steps as measure.sh of mk/price counts, and looked at a few times between. */
#ifndef PRICE_OPERANDS_H
#define PRICE_OPERANDS_H

#include "cost_board.h"
#include "host/image/image.h"

/* Of one operation, as a part of how often it was looked at. */
typedef struct operand_share {
    double zero;    /* an operand is zero: a sum of these is the other, a product zero */
    double opposed; /* a sum of two with opposite signs */
    double bits;    /* of a sum: mean bits that operands and result are shifted by */
} operand_share;

typedef struct operands {
    operand_share *of; /* [list->count] of IMAGE_STEP, or of IMAGE_MATRIX where a step is one */
    bool is_float;
    /* Of each component, angles first, how often this is zero: */
    double rate[IMAGE_COMPONENTS_MAX];
    double accel[IMAGE_COMPONENTS_MAX]; /* of first order: its slope */
    /* Of each angle, how often it stays where it is, and how often that is at zero. */
    double still[IMAGE_COMPONENTS_MAX];
    double at_zero[IMAGE_COMPONENTS_MAX];
    double real[IMAGE_COMPONENTS_MAX]; /* of each real of the state, how often it is zero */
} operands;

/* Nothing is zero where nothing is known: of a scene with contacts, and behind what has no finite value. */
operands operands_of(const image *im, cost_number number);
void operands_free(operands *o);

#endif
