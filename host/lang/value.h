/* value.h: evaluation of constant expressions. */
#ifndef LANG_VALUE_H
#define LANG_VALUE_H

#include "model.h"

/* Parameters with their expressions in one run. Values are computed on demand, since a `set` may name a parameter
 * declared later. */
typedef struct valuation {
    const mechanism *of;
    const expr **parameter_expr;  /* [parameter_count] */
    place *parameter_at;          /* [parameter_count] place of that expression */
    double *parameter;            /* [parameter_count] SI */
    signed char *parameter_state; /* [parameter_count] 0 not yet, 1 in progress, 2 done */
    double *let;                  /* [let_count] */
    bool *let_known;              /* [let_count] */
    const double *input;          /* [input_count] SI; NULL: expressions may contain no input */
    double *const *state; /* [coordinate_count][primes <= primes_most] SI; NULL like input */
    int primes_most;
    int depth; /* total height of the expressions in evaluation */
    diags *diags;
} valuation;

valuation valuation_new(const mechanism *of, struct arena *arena, diags *diags);

/* The SI value. `known` may be NULL if the tree has only numbers and operators. */
double expr_value(const expr *tree, valuation *known);

/* The same; reports at `at` and returns 0 if it is not finite. `what` names it, such as "parameter 'm'". */
double finite_value(const expr *tree, valuation *known, place at, const char *what);

/* The value of parameter `index`. Reports once if it is not finite or depends on itself. */
double parameter_value(valuation *known, int index);

#endif
