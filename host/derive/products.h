/* products.h: a step's list as sums of products of rates, inputs and reals, whose coefficients depend on turn angles
 * and on nothing else. */
#ifndef DERIVE_PRODUCTS_H
#define DERIVE_PRODUCTS_H

#include "host/image/tape.h"

/* Most products of one sum. */
enum { PRODUCTS_MOST = 128 };

/* coefficient * symbol[0]^power[0] * symbol[1]^power[1] ... */
typedef struct term_product {
    const unsigned char *power; /* [symbols] */
    int coefficient;            /* operation of `coefficients` */
} term_product;

typedef struct product_sum {
    term_product *product; /* [count], each with other powers */
    int count;
} product_sum;

typedef struct products {
    tape *coefficients; /* of turn angles: no rate, input or real is in it */
    int *symbol;        /* [symbols] operations of the list: OP_LINEAR, OP_RATE, OP_INPUT */
    int symbols;
    product_sum *result; /* [results of the list] */
    int results;
    struct arena *memory;
} products;

/* Why a list is no such sums, in words behind "the accelerations ", and what to do about it. NULL: it is. */
typedef struct refusal {
    const char *reason;
    const char *hint;
    int angle; /* turn angle that it is about, or -1 */
} refusal;

products products_of(const tape *list, refusal *why);
void products_free(products *p);

#endif
