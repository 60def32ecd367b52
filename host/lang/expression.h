/* expression.h: reading expressions: the grammar and names (expression.c), conditions (contact_statement.c), and the
 * dimensions of operators (operators.c). Recursion is bounded by NESTING_MAX and EXPR_HEIGHT_MAX. */
#ifndef LANG_EXPRESSION_H
#define LANG_EXPRESSION_H

#include "host/lang/parser.h"
#include "host/lang/words.h"

/* --- grammar (expression.c, contact_statement.c) --- */
const expr *parse_expression(parser *in, expr_context context); /* NULL: gave up */
bool parse_close(parser *in, place open);                       /* the ')' that closes `open` */
/* Comparisons joined by `and`, `or` as one expression: true when above zero. The statement is for hints. */
const expr *parse_condition(parser *in, word_id statement);
/* The unit token in hand; *text is set to what it says, without blanks. */
bool parse_unit(parser *in, unit_scale *result, const char **text);

/* --- names (expression.c) --- */
const expr *expr_name(parser *in, const token *name);
/* The line in which a later statement of the mechanism declares the name, or 0. */
int name_declared_later(const token *name);
/* Report that no coordinate has that name, with the nearest one that there is. */
void no_such_coordinate(parser *in, const token *name);

/* The coordinate of that name, or NULL (reported); `whose` it is to be, for messages. */
const symbol *find_coordinate(parser *in, const token *name, const char *whose);

/* --- derivatives (derivative.c) --- */
/* The let that is the time derivative of this one, named at `name`; NULL: it has none (reported). */
const symbol *let_rate(parser *in, const symbol *let, const token *name);

/* --- operators (operators.c) --- */
expr *expr_new(parser *in, expr_op op, place at);
const expr *expr_binary(parser *in, expr_op op, place at, const expr *left, const expr *right);
/* left - right of a comparison: both must have one dimension. */
const expr *expr_difference(parser *in, place at, const expr *left, const expr *right);
const expr *expr_negate(parser *in, place at, const expr *operand);
const expr *expr_call(parser *in, function_id function, place at, const expr *left,
                      const expr *right);
/* The value when only numbers and operators are in it. */
bool expr_constant(const expr *tree, double *value);
/* Report at `at` "RULE, but this is ..." when `value` has not the dimension `wanted`. */
bool check_dimension(parser *in, place at, const expr *value, dimension wanted, const char *rule);
/* Report at `at` a value without a unit, not 0, for the symbol (or its derivative) where its declared unit is not SI. The
 * token in hand is the one behind the value. */
bool check_unit(parser *in, place at, const expr *value, const symbol *of, int primes);
/* The same of the limit in a stop or a crossing, where `of` is one symbol alone. */
bool check_limit(parser *in, place at, const expr *value, const expr *of);
/* "SUBJECT is mass [kg]", the rule for something that has its dimension already. */
enum { RULE_SIZE = 300 };
char *dimension_rule(char *buffer, const char *subject, const char *verb, dimension dim);

#endif
