/* formula.h: evaluates formulas in the notation that `whirl derive` prints: + - * / ^, parentheses, functions, and
 * names such as theta1'' or y(3). */
#ifndef TESTS_HOST_FORMULA_H
#define TESTS_HOST_FORMULA_H

/* Returns the value of a name, NaN if the name is unknown. `name` has no terminating zero byte. */
typedef double formula_lookup(void *context, const char *name, int length);

/* Evaluates the formula at `text`. *end: the first character after the formula. After a syntax error the value is
 * NaN and *end points to the error. An unknown function fails the test with its name. */
double formula_value(const char *text, const char **end, formula_lookup *lookup, void *context);

#endif
