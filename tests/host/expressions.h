/* expressions.h: random expressions of the whole language, for tests of printed text. */
#ifndef TESTS_HOST_EXPRESSIONS_H
#define TESTS_HOST_EXPRESSIONS_H

#include "test.h"

/* Names in expressions, all dimensionless. */
typedef struct expression_names {
    const char *const *coordinates;
    int coordinate_count;
    int rates;                    /* true: their rates, times 1 [s], occur, too */
    const char *const *constants; /* parameters and inputs */
    int constant_count;
} expression_names;

/* Writes a random dimensionless expression to text[size], at most `depth` operations deep. Each operation has its own
 * parentheses, so that the meaning depends on no precedence rule. All operators, functions, number formats and kinds of
 * exponent occur. With `tame`, its value is mostly real. */
void expression_write(const expression_names *names, int depth, int tame, uint64_t *seed,
                      char *text, size_t size);

/* A random mechanism m with coordinates theta1 and x, or (one in three) a system of two states. Its energies, forces or
 * equations are such expressions. Parameters a1, n_1, mass_of_it and inputs Omega_, x__2, y1 are dimensionless. */
void expression_mechanism(int depth, uint64_t *seed, char *text, size_t size);

#endif
