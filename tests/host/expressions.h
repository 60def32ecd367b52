/* expressions.h: for the tests of what is printed: random expressions of the whole language. */
#ifndef TESTS_HOST_EXPRESSIONS_H
#define TESTS_HOST_EXPRESSIONS_H

#include <stddef.h>
#include <stdint.h>

/* What expressions may name: all without a dimension. */
typedef struct expression_names {
    const char *const *coordinates;
    int coordinate_count;
    int rates;                    /* their rates, times 1 [s], as well? */
    const char *const *constants; /* parameters and inputs */
    int constant_count;
} expression_names;

/* Write a random dimensionless expression into text[size], every operation in parentheses of its own:
 * what it means hangs on no rule. All operators and functions, numbers of every look, exponents of every
 * kind; at most `depth` operations deep. With `tame`, mostly in the range of what is real. */
void expression_write(const expression_names *names, int depth, int tame, uint64_t *seed,
                      char *text, size_t size);

/* A random mechanism of two coordinates, theta1 and x, or (one in three) a system of two states, with
 * such expressions in its energies, forces or equations; called m, with parameters a1, n_1, mass_of_it and
 * inputs Omega_, x__2, y1, all dimensionless. */
void expression_mechanism(int depth, uint64_t *seed, char *text, size_t size);

#endif
