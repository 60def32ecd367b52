/* normal_form.h: the normal form of symbolic expressions.
 *
 * Every expression is a `poly`, a sum of terms. A term is a number times a product of atoms with exponents, times at
 * most one sine or cosine. Products of sines and cosines become sums (multiple angles), so equal expressions of a
 * planar mechanism have equal forms:
 *
 *     sin(a)*sin(b) = cos(a - b)/2 - cos(a + b)/2        sin(a)^2 + cos(a)^2 = 1
 *
 * A sum of positions with a whole exponent of 3 or more is not expanded, so that (x - b)^3 keeps its digits near x = b.
 * Two such powers have the same base if their sums differ only in order, sign and scale. poly_expanded() expands them,
 * for a comparison with sums that are already expanded.
 *
 * Polys, products and atoms are interned in an `algebra`: equal objects are the same pointer, results are memoized, and
 * objects never change.
 *
 * Coefficients are doubles. A sum counts as zero if it is at most 1e-14 of its larger addend, so that decimal
 * parameters (0.1 + 0.2 - 0.3) leave no spurious terms. */
#ifndef ALGEBRA_NORMAL_FORM_H
#define ALGEBRA_NORMAL_FORM_H

#include <stdbool.h>
#include <stdint.h>

#include "host/lang/model.h"

typedef struct algebra algebra;
typedef struct atom atom;
typedef struct mono mono;
typedef struct poly poly;

typedef enum atom_kind {
    ATOM_SYMBOL, /* a coordinate, rate, acceleration, parameter or input */
    ATOM_CALL,   /* a function of one or two polys; not sine, cosine or square root */
    ATOM_POWER,  /* base^exponent with an exponent that is not a number */
    ATOM_GROUP   /* a sum that is not expanded: the base of a power, or too large to multiply out */
} atom_kind;

struct atom {
    atom_kind kind;
    unsigned id;          /* only for hash tables */
    uint64_t rank;        /* rank in the order of atoms: see atom_rank() in poly.c */
    const symbol *symbol; /* for ATOM_SYMBOL only */
    int primes;
    function_id function; /* for ATOM_CALL only */
    /* ATOM_CALL: arguments; ATOM_POWER: base and exponent; ATOM_GROUP: [0] is the sum */
    const poly *argument[2];
    uint64_t symbols;  /* Bloom set of the symbols inside: see poly_may_contain() */
    bool keeps_powers; /* contains a power of a sum that was not multiplied out */
    double size;       /* number of operands when written out */
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
    mono_factor factors[]; /* sorted by atom_order() */
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
    double size;       /* number of operands when written out: a shared part counts at each use */
    poly_term terms[]; /* sorted by mono_order(); zero has no terms */
};

#endif
