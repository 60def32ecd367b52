/* latex_value.h: evaluates the LaTeX that the program prints, as a sum of a number and multiples of the highest
 * derivatives, with how far off each may be. What latex.h checks to compile is read here for what it says. */
#ifndef TESTS_HOST_LATEX_VALUE_H
#define TESTS_HOST_LATEX_VALUE_H

#include <stdbool.h>

enum { LATEX_UNKNOWNS = 16, LATEX_PLACES = 1 + LATEX_UNKNOWNS };

/* value[0] + sum value[1 + i] * (highest derivative of unknown i). off[]: what is in each at most of
 *
 *   - the printed numbers: show_as_fraction() takes what is within 1e-13 of a fraction for one;
 *   - sums: the algebra counts what cancels to less than 1e-14 of its parts as zero;
 *   - rounding, of libm's functions too,
 *
 * carried on by slopes (running error analysis, as host/engine/rounding.h): small differences of large terms are known to
 * be off by parts of these. */
typedef struct latex_number {
    double value[LATEX_PLACES];
    double off[LATEX_PLACES];
} latex_number;

latex_number latex_constant(double value, double off);

/* The symbol with these letters ("theta", "m", "mass"), this index ("1", "" for none; "_" where LaTeX has "\_") and so
 * many dots; false when there is none. */
typedef bool latex_lookup(void *context, const char *stem, const char *index, int primes,
                          latex_number *found);

/* Evaluate from `text` on, up to a '&', a '\\' or the end of the line: *end is set to what stopped it. On what the
 * program does not print, as a product of two highest derivatives, the value is NaN, *problem says what and *end where;
 * else *problem is NULL; it holds until the next call. */
latex_number latex_value(const char *text, const char **end, const char **problem,
                         latex_lookup *lookup, void *context);

#endif
