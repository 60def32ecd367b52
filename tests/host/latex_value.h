/* latex_value.h: evaluates the LaTeX that the program prints, with error bounds, as a number plus multiples of the
 * highest derivatives. latex.h only checks that it compiles. */
#ifndef TESTS_HOST_LATEX_VALUE_H
#define TESTS_HOST_LATEX_VALUE_H

#include <stdbool.h>

enum { LATEX_UNKNOWNS = 16, LATEX_PLACES = 1 + LATEX_UNKNOWNS };

/* value[0] + sum value[1 + i] * (highest derivative of unknown i). off[] bounds the errors from
 *
 * - printed numbers: show_as_fraction() replaces a number within 1e-13 of a fraction; - sums: the algebra treats a
 * cancellation below 1e-14 of the parts as zero; - round-off, also of libm's functions,
 *
 * carried on by slopes (running error analysis, as in host/engine/rounding.h). Small differences of large terms thus
 * have errors relative to the terms. */
typedef struct latex_number {
    double value[LATEX_PLACES];
    double off[LATEX_PLACES];
} latex_number;

latex_number latex_constant(double value, double off);

/* The symbol with these letters ("theta", "m", "mass"), index ("1", "" without one; "_" for LaTeX's "\_") and number of
 * dots. Returns false if unknown. */
typedef bool latex_lookup(void *context, const char *stem, const char *index, int primes,
                          latex_number *found);

/* Evaluates from `text` up to '&', '\\' or the end of the line; *end points there. For forms that the program never
 * prints, such as a product of two highest derivatives, the value is NaN, *problem the reason and *end its place.
 * Otherwise *problem is NULL. It is valid until the next call. */
latex_number latex_value(const char *text, const char **end, const char **problem,
                         latex_lookup *lookup, void *context);

#endif
