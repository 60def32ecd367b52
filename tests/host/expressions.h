/* expressions.h: random expressions of the whole language, for tests of printed text. */
#ifndef TESTS_HOST_EXPRESSIONS_H
#define TESTS_HOST_EXPRESSIONS_H

#include "test.h"

/* The names that may occur in expressions. All are dimensionless. */
typedef struct expression_names {
    const char *const *coordinates;
    int coordinate_count;
    int rates;                    /* if true, rates times 1 [s] occur, too */
    const char *const *constants; /* names of parameters and inputs */
    int constant_count;
} expression_names;

/* Writes a random dimensionless expression to text[size], up to `depth` operations deep. Each operation has its own
 * parentheses, so that the meaning depends on no precedence rule. All operators, functions, number formats and kinds
 * of exponents occur. If `tame`, the value is mostly real. */
void expression_write(const expression_names *names, int depth, int tame, uint64_t *seed,
                      char *text, size_t size);

/* Writes a random mechanism m with coordinates theta1 and x, or (in one case of three) a system of the states theta1
 * and x. Energies, forces and equations are random expressions. The parameters a1, n_1 and mass_of_it and the inputs
 * Omega_, x__2 and y1 are dimensionless. */
void expression_mechanism(int depth, uint64_t *seed, char *text, size_t size);

#endif
