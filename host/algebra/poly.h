/* poly.h: arithmetic with expressions in the normal form of normal_form.h. */
#ifndef ALGEBRA_POLY_H
#define ALGEBRA_POLY_H

#include "host/algebra/normal_form.h"

algebra *algebra_new(void);
void algebra_free(algebra *a); /* `a` may be NULL */
folding *algebra_folding(const algebra *a);
/* Sets the folding of the coefficients, which may be NULL. Returns the previous one. */
folding *algebra_fold(algebra *a, folding *f);
/* Returns `count` zeroed elements, which algebra_free() frees. */
void *algebra_room(algebra *a, int count, size_t size);

/* Largest number of operands in an expression. It limits the time of functions that visit shared parts repeatedly. */
#define POLY_SIZE_MAX 1e6

/* Returns true if an expression has exceeded a limit of the algebra. All results are then meaningless. */
bool algebra_overflow(const algebra *a);
/* The exceeded limit, in words and with its number. The caller frees the text. */
char *algebra_limit(const algebra *a);

const poly *poly_number(algebra *a, double value);
const poly *poly_symbol(algebra *a, const symbol *sym, int primes);
const poly *poly_of_atom(algebra *a, const atom *x, double exponent);
const atom *atom_symbol(algebra *a, const symbol *sym, int primes);

const poly *poly_add(algebra *a, const poly *left, const poly *right);
const poly *poly_sub(algebra *a, const poly *left, const poly *right);
const poly *poly_scale(algebra *a, const poly *p, double scale);
/* p with each coefficient c replaced by change(c, by) */
const poly *poly_each_number(algebra *a, const poly *p,
                             double (*change)(folding *f, double number, double by), double by);
const poly *poly_mul(algebra *a, const poly *left, const poly *right);
const poly *poly_pow(algebra *a, const poly *base, double exponent);
const poly *poly_pow_poly(algebra *a, const poly *base, const poly *exponent);
const poly *poly_call(algebra *a, function_id function, const poly *x, const poly *y);
const poly *poly_sin(algebra *a, const poly *angle);
const poly *poly_cos(algebra *a, const poly *angle);

/* The term `coefficient * mono` as a poly. */
const poly *poly_of_term(algebra *a, double coefficient, const mono *m);

bool poly_is_zero(const poly *p);
/* Returns true if p is a number, and stores it in *value. */
bool poly_is_number(const poly *p, double *value);
/* Quick test: if false, p does not contain the symbol with `primes` primes; if true, p may contain it. */
bool poly_may_contain(const poly *p, const symbol *sym, int primes);
/* Exact test: does p contain the symbol with `primes` primes? For primes = -1, any number of primes counts. */
bool poly_contains(const poly *p, const symbol *sym, int primes);

/* Determinant of the submatrix of m that has the rows and columns in the bit sets `rows` and `columns`. m is n by n,
 * n <= 32. The method, expansion by cofactors, is slow for many rows. */
const poly *poly_determinant(algebra *a, const poly *const *m, int n, unsigned rows,
                             unsigned columns);

/* Partial derivative by the symbol with `primes` primes. */
const poly *poly_derivative(algebra *a, const poly *p, const symbol *sym, int primes);

/* Replaces symbols in p. `replace` returns the replacement of a symbol with `primes` primes, or NULL to keep it. */
typedef const poly *poly_replacement(void *context, algebra *a, const symbol *sym, int primes);
const poly *poly_substitute(algebra *a, const poly *p, poly_replacement *replace, void *context);

/* p with its powers of sums multiplied out, except for large powers. Terms that cancel after this are removed. */
const poly *poly_expanded(algebra *a, const poly *p);

/* `value` returns the value of a symbol. */
typedef double poly_value(void *context, const symbol *sym, int primes);
double poly_evaluate(const poly *p, poly_value *value, void *context);
/* The sum of the absolute values of p's terms: a scale for the round-off in poly_evaluate(). Each sine or cosine is
 * replaced by 1, because its round-off does not shrink with its value. */
double poly_magnitude(const poly *p, poly_value *value, void *context);
/* Are all numbers in p finite, including those inside functions? */
bool poly_is_finite(const poly *p);

/* Converts a parsed expression. Lets are replaced by their expressions. */
const poly *poly_from_expr(algebra *a, const expr *e);

#endif
