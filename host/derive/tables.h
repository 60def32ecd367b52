/* tables.h: a step's list with tables of one angle's functions in place of its sines and divisions. */
#ifndef DERIVE_TABLES_H
#define DERIVE_TABLES_H

#include "host/image/image.h"
#include "host/image/tape.h"

/* === a list as sums of products =============================================================== */
/* A step's list as sums of products of rates, inputs and reals, whose coefficients depend on turn angles
 * and on nothing else. */

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

/* Cells of a table, a turn, where nothing else is asked for. */
enum { TABLES_CELLS_LINEAR = 256, TABLES_CELLS_CUBIC = 64 };

/* The accelerations (or slopes) as sum_k c_k(phase) m_k, m_k products of rates, inputs and reals: `list` with the c_k
 * that are no constants as tables, whose phase is the one turn angle, or the one whole multiple or sum of such, that
 * all are functions of. c_k that differ by a factor share one. *exact is a list of what the tables hold. NULL, with
 * *why filled in: it has not that form. */
tape *tables_make(const tape *list, image_tables form, int cells, tape **exact, refusal *why);

/* As many cells as that form takes by itself. */
int tables_cells(image_tables form);

#endif
