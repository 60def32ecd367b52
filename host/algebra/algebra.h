/* algebra.h: tables that intern the objects of normal_form.h, and their constructors. For host/algebra only. */
#ifndef ALGEBRA_ALGEBRA_H
#define ALGEBRA_ALGEBRA_H

#include <stddef.h>

#include "host/base/alloc.h"
#include "normal_form.h"

typedef struct intern_slot {
    uint64_t hash;
    const void *object;
} intern_slot;

typedef struct intern_table {
    intern_slot *slots;
    size_t size; /* a power of two, or 0 */
    size_t count;
} intern_table;

/* A memoized result. */
typedef struct memo_pair {
    const void *left;
    const void *right;
    const poly *result;
} memo_pair;

struct algebra {
    struct arena *arena;
    intern_table atoms;
    intern_table monos;
    intern_table polys;
    intern_table products;    /* memo_pair: poly, poly */
    intern_table derivatives; /* memo_pair: poly, atom */
    intern_table lets;        /* memo_pair: symbol, NULL */
    /* terms processed and bytes allocated so far: the limit bounds time and memory */
    size_t work;
    bool overflow;
    const poly *zero;
    const poly *one;
};

/* Interning (poly.c). The caller frees scratch objects; the arena owns interned ones. */
mono *mono_scratch(int factors);
const mono *mono_intern(algebra *a, mono *candidate);
const mono *mono_make(algebra *a, const mono_factor *factors, int count, trig kind,
                      const poly *angle);
/* The bit of a symbol in Bloom sets. */
uint64_t symbol_bit(const symbol *sym, int primes);
poly *poly_scratch(int terms);
const poly *poly_intern(algebra *a, poly *candidate);

/* The derivative of a function by its argument x (which = 0) or y (1), at these arguments (calculus.c). y may be NULL
 * for a function of one argument. */
const poly *function_slope(algebra *a, function_id function, int which, const poly *x,
                           const poly *y);

/* --- the order of the normal form (poly.c): negative, 0 for the same, positive -------------------*/

/* The order of two sums. */
int poly_order(const poly *x, const poly *y);

/* --- questions (poly.c) -------------------------------------------------------------------------*/

/* x + y, or zero if the sum is only a rounding error of decimals. */
double coefficient_sum(double x, double y);
/* Is p a sum of positions, parameters and numbers only, without rates and functions? */
bool poly_is_place(const poly *p);

/* --- sums of many polys (poly.c) ------------------------------------------------------------------*/

typedef struct sum_item {
    const mono *mono;
    double coefficient;
    size_t turn; /* the order of entry */
} sum_item;

/* Starts as {0}. */
typedef struct poly_sum {
    sum_item *items;
    size_t count;
    size_t room;
} poly_sum;

/* Adds scale * p. Counts the work, and sets a->overflow above the limit. */
void sum_add(algebra *a, poly_sum *s, const poly *p, double scale);
/* The sum; frees the memory of `s`. */
const poly *sum_close(algebra *a, poly_sum *s);

/* base^exponent. Whole powers of sums of positions are not expanded if the exponent is `kept` or more. */
const poly *poly_power(algebra *a, const poly *base, double exponent, double kept);

/* memo_get(): the stored result for the pair, or NULL. memo_put(): stores it. */
const poly *memo_get(intern_table *table, const void *left, const void *right);
void memo_put(algebra *a, intern_table *table, const void *left, const void *right,
              const poly *result);

#endif
