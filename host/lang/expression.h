/* expression.h: the parser of expressions. NESTING_MAX and EXPR_HEIGHT_MAX bound the recursion. */
#ifndef LANG_EXPRESSION_H
#define LANG_EXPRESSION_H

#include "host/lang/parser.h"
#include "host/lang/words.h"

#define PI 3.14159265358979323846

/* --- grammar (expression.c) --- */
const expr *parse_expression(parser *in, expr_context context); /* NULL after an error */
/* Reads the condition of a hold. The expression is above zero if the condition is true. NULL after an error. */
const expr *parse_condition(parser *in);
/* Reads a unit. If the token is a name, the unit extends to the end of the source. *text: the unit without blanks. */
void parse_unit(parser *in, unit_scale *result, const char **text);

/* Returns a hint if a later statement of the same mechanism declares the name, else NULL. */
const char *hint_declared_later(parser *in, const token *name);
/* Reports an unknown coordinate, with the nearest known name as a hint. */
void no_such_coordinate(parser *in, const token *name);
void no_such_symbol(parser *in, const mechanism *of, const token *name);

/* Reads "= EXPR" after `name`. Appends the assignment to *list if `of` is not NULL.
 * `statement`: WORD_SET, WORD_START or WORD_WHEN. */
bool parse_assigned(parser *in, const token *name, const symbol *of, word_id statement,
                    const assignment **list, int *count);

/* Returns the coordinate of that name, or NULL (reported). `whose` names the statement in messages. */
const symbol *find_coordinate(parser *in, const token *name, const char *whose);

/* --- derivatives (derivative.c) --- */
/* Returns the let that is the time derivative of `let`, or NULL if there is no derivative (reported at `name`). */
const symbol *let_rate(parser *in, const symbol *let, const token *name);

/* --- operators (operators.c) --- */
expr *expr_new(parser *in, expr_op op, place at);
/* Returns NULL if an operand is NULL, because of an earlier error. */
const expr *expr_binary(parser *in, expr_op op, place at, const expr *left, const expr *right);
/* Returns left - right of a comparison. Both sides must have the same dimension. */
const expr *expr_difference(parser *in, place at, const expr *left, const expr *right);
const expr *expr_negate(parser *in, place at, const expr *operand);
const expr *expr_call(parser *in, function_id function, place at, const expr *left,
                      const expr *right);
/* *value: the value of an expression that has only numbers and operators. Returns false for other expressions. */
bool expr_constant(const expr *tree, double *value);
const char *dimension_words(const parser *in, dimension dim);
/* Reports "RULE, but this is ..." at `at`, and returns false, if the dimension of `value` is not `wanted`. */
bool check_dimension(parser *in, place at, const expr *value, dimension wanted, const char *rule);
/* As check_dimension(). The rule is "SUBJECT VERB DIMENSION", such as "m is mass [kg]". */
bool check_named(parser *in, place at, const expr *value, dimension wanted, const char *subject,
                 const char *verb);
/* Returns false, and reports an error at `at`, if a nonzero value has no unit and `of` is not declared in SI.
 * `primes`: the number of primes of `of` in the assignment. Call check_unit() just after the value is read. */
bool check_unit(parser *in, place at, const expr *value, const symbol *of, int primes);
/* As check_unit(), with the number of primes of `name`. Also checks the dimension. */
bool check_value(parser *in, place at, const expr *value, const symbol *of, const token *name);
/* If `of` is a symbol and no parameter, checks the limit `value` of this symbol as check_unit(). */
bool check_limit(parser *in, place at, const expr *value, const expr *of);

#endif
