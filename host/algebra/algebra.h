/* algebra.h: the tables that store equal objects of normal_form.h once (interning), for host/algebra only. */
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

/* The stored result of an operation on `left` and `right`. */
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
    intern_table products;    /* memo_pair objects: left and right are polys */
    intern_table derivatives; /* memo_pair objects: left is a poly, right is an atom */
    intern_table lets;        /* memo_pair objects: left is the let's symbol, right is NULL */
    /* bytes of all new objects, plus WORK_OF_TERM for each processed term; the limit is WORK_MAX (poly.c) */
    size_t work;
    folding *folding; /* of the coefficients; may be NULL */
    bool overflow;
    const poly *zero;
    const poly *one;
};

/* The caller frees scratch objects. Interned objects belong to the arena. */
mono *mono_scratch(int factors);
const mono *mono_intern(algebra *a, mono *candidate);
const mono *mono_make(algebra *a, const mono_factor *factors, int count, trig kind,
                      const poly *angle);
/* The bit of a symbol in the Bloom set of an expression's symbols. */
uint64_t symbol_bit(const symbol *sym, int primes);
poly *poly_scratch(int terms);
const poly *poly_intern(algebra *a, poly *candidate);

/* The partial derivative by x (which = 0) or y (which = 1). If the function has one argument, y is NULL. */
const poly *function_slope(algebra *a, function_id function, int which, const poly *x,
                           const poly *y);

/* Negative if x comes before y, 0 if they are equal, else positive. */
int poly_order(const poly *x, const poly *y);

/* x + y, or 0 if the sum is at most 1e-14 of the larger addend, because it is then only round-off. */
double coefficient_sum(folding *f, double x, double y);
/* Is p a sum of at least two terms that contain only numbers, positions, parameters and inputs? */
bool poly_is_place(const poly *p);

typedef struct sum_item {
    const mono *mono;
    double coefficient;
    /* order of entry; the coefficients of equal `mono` are added in this order */
    size_t turn;
} sum_item;

/* A sum that is being built. Its initial value is {0}. */
typedef struct poly_sum {
    sum_item *items;
    size_t count;
    size_t room;
} poly_sum;

/* Adds scale * p to the sum. Counts the work, and sets a->overflow if the work exceeds its limit. */
void sum_add(algebra *a, poly_sum *s, const poly *p, double scale);
/* Returns the sum, and frees the memory of `s`. */
const poly *sum_close(algebra *a, poly_sum *s);

/* base^exponent. It is not expanded if exponent >= kept and poly_is_place(base). */
const poly *poly_power(algebra *a, const poly *base, double exponent, double kept);

/* memo_get() returns the stored result for the pair, or NULL. */
const poly *memo_get(intern_table *table, const void *left, const void *right);
void memo_put(algebra *a, intern_table *table, const void *left, const void *right,
              const poly *result);

#endif
