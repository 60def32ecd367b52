/* algebra.h: the tables in which the objects of normal_form.h are interned, and what makes these. For host/algebra only. */
#ifndef ALGEBRA_ALGEBRA_H
#define ALGEBRA_ALGEBRA_H

#include <stddef.h>

#include "host/base/arena.h"
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

/* A result that was worked out before. */
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
    size_t work;              /* terms handled and bytes kept so far: what bounds time and memory */
    bool overflow;
    const poly *zero;
    const poly *one;
};

/* Interning (poly.c). Scratch objects are freed by the caller; what is interned lives in the
 * arena. */
mono *mono_scratch(int factors);
const mono *mono_intern(algebra *a, mono *candidate);
const mono *mono_make(algebra *a, const mono_factor *factors, int count, trig kind,
                      const poly *angle);
/* The bit of a symbol in Bloom sets. */
uint64_t symbol_bit(const symbol *sym, int primes);
poly *poly_scratch(int terms);
const poly *poly_intern(algebra *a, poly *candidate);
const atom *atom_of_polys(algebra *a, atom_kind kind, function_id function, const poly *x,
                          const poly *y);

/* The derivative of a function by x (which = 0) or y (1), of whatever stands in these places; y may be NULL
 * where the function takes one (calculus.c). */
const poly *function_slope(algebra *a, function_id function, int which, const poly *x,
                           const poly *y);

/* --- the order of the normal form (poly.c): negative, 0 for the same, positive -------------------*/

/* What decides between two atoms, but for their arguments. */
uint64_t atom_rank(const atom *x);
int atom_order(const atom *x, const atom *y);
int mono_order(const mono *x, const mono *y);
int poly_order(const poly *x, const poly *y);

/* --- looking (poly.c) ---------------------------------------------------------------------------*/

/* x + y, or zero when what is left is a rounding error of the decimals they came from. */
double coefficient_sum(double x, double y);
bool exponent_is_whole(double x); /* and small enough to count by */
/* Does a power of a sum, from the exponent `kept` on a power if it is one of positions, multiply out? */
bool power_multiplies_out(const poly *base, double exponent, double kept);
/* A sum of positions, parameters and numbers: no rate, no sine, no function? */
bool poly_is_place(const poly *p);

/* --- sums of many polys (poly.c) ------------------------------------------------------------------*/

typedef struct sum_item {
    const mono *mono;
    double coefficient;
    size_t turn; /* the order of entering */
} sum_item;

/* Starts as {0}. */
typedef struct poly_sum {
    sum_item *items;
    size_t count;
    size_t room;
} poly_sum;

/* Count work; sets a->overflow when it is too much. */
void algebra_work(algebra *a, size_t amount);
void sum_add(algebra *a, poly_sum *s, const poly *p, double scale);
/* Add up `row` by itself, then add it to `s`; `row` is empty then, its memory is kept. */
void sum_add_row(poly_sum *s, poly_sum *row);
/* The sum; frees what `s` holds. */
const poly *sum_close(algebra *a, poly_sum *s);

/* base^exponent, where whole powers of such sums stay powers from the exponent `kept` on. */
const poly *poly_power(algebra *a, const poly *base, double exponent, double kept);

/* The poly remembered for the pair, or NULL; and remember it. */
const poly *memo_get(intern_table *table, const void *left, const void *right);
void memo_put(algebra *a, intern_table *table, const void *left, const void *right,
              const poly *result);

#endif
