/* formula.h: evaluates formulas as `whirl derive` prints them, so that what is printed can be compared
 * with what is meant: + - * / ^, parentheses, the functions, and names such as theta1'' or y(3). */
#ifndef TESTS_HOST_FORMULA_H
#define TESTS_HOST_FORMULA_H

/* The value of a name; NaN when there is none. `name` is not ended by a zero byte. */
typedef double formula_lookup(void *context, const char *name, int length);

/* Evaluate from `text` on; *end is set behind the formula. NaN on a syntax error, with *end at it. A
 * function that is not known here fails the test with its name. */
double formula_value(const char *text, const char **end, formula_lookup *lookup, void *context);

#endif
