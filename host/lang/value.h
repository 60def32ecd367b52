/* value.h: the numbers of constant expressions. */
#ifndef LANG_VALUE_H
#define LANG_VALUE_H

#include "model.h"

/* Parameters with the expressions they have in one run. Values are found when asked for, since a
 * `set` may name a parameter declared after the one it sets. */
typedef struct valuation {
    const mechanism *of;
    const expr **parameter_expr;  /* [parameter_count] */
    place *parameter_at;          /* [parameter_count] where that expression was given */
    double *parameter;            /* [parameter_count] SI */
    signed char *parameter_state; /* [parameter_count] 0 not yet, 1 being found, 2 found */
    double *let;                  /* [let_count] */
    bool *let_known;              /* [let_count] */
    const double *input;          /* [input_count] SI; NULL: not known, expressions may have none */
    double *const *state; /* [coordinate_count][primes <= primes_most] SI; NULL like input */
    int primes_most;
    int depth; /* heights of the expressions being evaluated */
    diags *diags;
} valuation;

valuation valuation_new(const mechanism *of, struct arena *arena, diags *diags);

/* The SI value. `known` may be NULL when only numbers and operators are in the tree. */
double expr_value(const expr *tree, valuation *known);

/* The same; reports at `at` and returns 0 when it is not finite. `what` such as "parameter 'm'". */
double finite_value(const expr *tree, valuation *known, place at, const char *what);

/* The value of parameter `index`; reports once when it is not finite or depends on itself. */
double parameter_value(valuation *known, int index);

#endif
