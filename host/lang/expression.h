/* expression.h: the parser of expressions: grammar and names (expression.c), conditions (contact_statement.c),
 * dimensions of operators (operators.c). NESTING_MAX and EXPR_HEIGHT_MAX bound the recursion. */
#ifndef LANG_EXPRESSION_H
#define LANG_EXPRESSION_H

#include "host/lang/parser.h"
#include "host/lang/words.h"

#define PI 3.14159265358979323846

/* --- grammar (expression.c, contact_statement.c) --- */
const expr *parse_expression(parser *in, expr_context context); /* NULL: gave up */
bool parse_close(parser *in, place open);                       /* the ')' that closes `open` */
/* The current unit token; *text is its text without blanks. */
bool parse_unit(parser *in, unit_scale *result, const char **text);

/* The line of a later statement of the mechanism that declares the name, or 0. */
int name_declared_later(const token *name);
/* Report an unknown coordinate, with the nearest known name as a hint. */
void no_such_coordinate(parser *in, const token *name);
/* As no_such_coordinate(), for a name that a scene or the command line changes. */
void no_such_symbol(parser *in, const mechanism *of, const token *name);

/* The coordinate of that name, or NULL (reported). Messages name the owner with `whose`. */
const symbol *find_coordinate(parser *in, const token *name, const char *whose);

/* --- derivatives (derivative.c) --- */
/* The let that is the time derivative of `let`; NULL if it has no derivative (reported at `name`). */
const symbol *let_rate(parser *in, const symbol *let, const token *name);

/* --- operators (operators.c) --- */
expr *expr_new(parser *in, expr_op op, place at);
const expr *expr_binary(parser *in, expr_op op, place at, const expr *left, const expr *right);
/* Returns left - right of a comparison. Both sides must have the same dimension. */
const expr *expr_difference(parser *in, place at, const expr *left, const expr *right);
const expr *expr_negate(parser *in, place at, const expr *operand);
const expr *expr_call(parser *in, function_id function, place at, const expr *left,
                      const expr *right);
/* The value of an expression of numbers and operators only; false for others. */
bool expr_constant(const expr *tree, double *value);
/* Report at `at` "RULE, but this is ..." if the dimension of `value` is not `wanted`. */
bool check_dimension(parser *in, place at, const expr *value, dimension wanted, const char *rule);
/* Report at `at` a nonzero value without a unit if the declared unit of the symbol (or its derivative) is not SI. The
 * current token is the one after the value. */
bool check_unit(parser *in, place at, const expr *value, const symbol *of, int primes);
/* As above, for the limit in a stop or a crossing, if `of` is a single symbol. */
bool check_limit(parser *in, place at, const expr *value, const expr *of);
/* "SUBJECT is mass [kg]": the rule for a quantity of known dimension. */
enum { RULE_SIZE = 300 };
char *dimension_rule(char *buffer, const char *subject, const char *verb, dimension dim);

#endif
