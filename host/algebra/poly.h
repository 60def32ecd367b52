/* poly.h: symbolic expressions in one normal form.
 *
 * Every expression is a `poly`: a sum of terms, each a number times a product of atoms with
 * exponents times at most one sine or cosine. Products of sines and cosines are turned into sums
 * (multiple angles), so that what is equal for a planar mechanism also looks equal:
 *
 *     sin(a)*sin(b) = cos(a - b)/2 - cos(a + b)/2        sin(a)^2 + cos(a)^2 = 1
 *
 * Whole powers of sums of positions, from the third on, stay powers, so that (x - b)^3 keeps its digits
 * near x = b. They are equal to each other, whatever the order, sign and scale of the sum; with what is
 * multiplied out they compare equal after poly_expanded() only.
 *
 * All three kinds of object are interned in an `algebra`: equal objects are the same pointer, and
 * results that were asked for before are found again. Nothing is ever changed once made.
 *
 * Coefficients are doubles. Numbers that cancel to less than 1e-14 of what was added count as
 * cancelled, so that decimal parameters (0.1 + 0.2 - 0.3) do not leave ghost terms behind.
 */
#ifndef ALGEBRA_POLY_H
#define ALGEBRA_POLY_H

#include <stdbool.h>
#include <stdint.h>

#include "host/lang/model.h"

typedef struct algebra algebra;
typedef struct atom atom;
typedef struct mono mono;
typedef struct poly poly;

typedef enum atom_kind {
    ATOM_SYMBOL, /* a coordinate, rate, acceleration, parameter or input */
    ATOM_CALL,   /* a function other than sine and cosine, of one or two polys */
    ATOM_POWER,  /* base^exponent with an exponent that is not a number */
    ATOM_GROUP /* a sum kept whole, because it is the base of a power or too large to multiply out */
} atom_kind;

struct atom {
    atom_kind kind;
    unsigned id;          /* for hash tables; orders nothing (order.c does) */
    uint64_t rank;        /* where it stands among others: order.c */
    const symbol *symbol; /* ATOM_SYMBOL */
    int primes;
    function_id function;    /* ATOM_CALL, else FUNCTION_NONE or unused */
    const poly *argument[2]; /* ATOM_CALL; base and exponent of ATOM_POWER; [0] of ATOM_GROUP */
    uint64_t symbols;        /* Bloom set of the symbols inside: see poly_may_contain() */
    bool keeps_powers;       /* a power of a sum is inside that could be multiplied out */
    double size;             /* leaves it would have, written out */
};

typedef enum trig { TRIG_NONE, TRIG_COS, TRIG_SIN } trig;

typedef struct mono_factor {
    const atom *atom;
    double exponent;
} mono_factor;

struct mono {
    unsigned id;
    int count;
    trig trig;
    const poly *angle; /* argument of the sine or cosine, or NULL */
    uint64_t symbols;
    bool keeps_powers;
    double size;
    mono_factor factors[]; /* in atom_order() */
};

typedef struct term_of_poly {
    double coefficient;
    const mono *mono;
} poly_term;

struct poly {
    unsigned id;
    int count;
    uint64_t symbols;
    bool keeps_powers;
    double
        size; /* leaves it would have, written out: what shares is counted as often as it is used */
    poly_term terms[]; /* in mono_order(); none means zero */
};

algebra *algebra_new(void);
void algebra_free(algebra *a);

/* The largest size of an expression: whoever walks through one, shared parts again and again, takes a
 * bounded time. */
#define POLY_SIZE_MAX 1e6

/* Set when an expression grew beyond what the algebra takes on; results are then meaningless. */
bool algebra_overflow(const algebra *a);

const poly *poly_number(algebra *a, double value);
const poly *poly_symbol(algebra *a, const symbol *sym, int primes);
const poly *poly_of_atom(algebra *a, const atom *x, double exponent);
const atom *atom_symbol(algebra *a, const symbol *sym, int primes);

const poly *poly_add(algebra *a, const poly *left, const poly *right);
const poly *poly_sub(algebra *a, const poly *left, const poly *right);
const poly *poly_scale(algebra *a, const poly *p, double scale);
/* p with the number of each term changed: change(number, by). */
const poly *poly_each_number(algebra *a, const poly *p, double (*change)(double number, double by),
                             double by);
const poly *poly_mul(algebra *a, const poly *left, const poly *right);
const poly *poly_pow(algebra *a, const poly *base, double exponent);
const poly *poly_pow_poly(algebra *a, const poly *base, const poly *exponent);
const poly *poly_call(algebra *a, function_id function, const poly *x, const poly *y);
const poly *poly_sin(algebra *a, const poly *angle);
const poly *poly_cos(algebra *a, const poly *angle);

/* The term `coefficient * mono` as a poly. */
const poly *poly_of_term(algebra *a, double coefficient, const mono *m);

bool poly_is_zero(const poly *p);
/* True, and *value set, when p is a number. */
bool poly_is_number(const poly *p, double *value);
/* False only when p surely does not contain the symbol with so many primes. */
bool poly_may_contain(const poly *p, const symbol *sym, int primes);
/* Exactly: does p contain the symbol with so many primes (-1: any number of primes)? */
bool poly_contains(const poly *p, const symbol *sym, int primes);

/* --- calculus.c ---------------------------------------------------------------------------------*/

/* Determinant of the given rows and columns (bit sets, equally many) of the n by n matrix m, n <= 32.
 * For a few rows: it is expanded by cofactors. */
const poly *poly_determinant(algebra *a, const poly *const *m, int n, unsigned rows,
                             unsigned columns);

/* Partial derivative by the symbol with so many primes, all else held. */
const poly *poly_derivative(algebra *a, const poly *p, const symbol *sym, int primes);

/* Rebuild p with every atom that `replace` answers for (non-NULL) replaced by its answer. */
typedef const poly *poly_replacement(void *context, algebra *a, const symbol *sym, int primes);
const poly *poly_substitute(algebra *a, const poly *p, poly_replacement *replace, void *context);

/* p with the powers of sums that were kept multiplied out, where that stays small: for telling whether
 * it is zero. */
const poly *poly_expanded(algebra *a, const poly *p);

/* The value of p, with `value` answering for every symbol. */
typedef double poly_value(void *context, const symbol *sym, int primes);
double poly_evaluate(const poly *p, poly_value *value, void *context);
/* The sum of the sizes of its terms: what the rounding of poly_evaluate() is a part of. Sines and cosines
 * count as one, as their errors do. */
double poly_magnitude(const poly *p, poly_value *value, void *context);
/* Are all numbers in it finite, inside functions too? */
bool poly_is_finite(const poly *p);

/* The poly of a parsed expression; lets are replaced by what they stand for. */
const poly *poly_from_expr(algebra *a, const expr *e);

#endif
