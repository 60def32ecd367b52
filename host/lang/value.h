/* value.h: values of constant expressions, and the units in which values are shown. */
#ifndef LANG_VALUE_H
#define LANG_VALUE_H

#include "host/lang/model.h"

/* === the units of displayed numbers: the declared unit, or SI ================================= */

/* The display unit of an output, of a coordinate or state, or of its derivative with `primes` primes. It is the
 * declared unit; a derivative adds per second: [deg] becomes deg/s, deg/s^2. Without a declared unit it is SI. */
unit_scale shown_unit(const symbol *s, int primes);

/* The name of this unit: "deg/s", "kg*m/s^2", "rad", "1". The caller frees it. */
char *shown_unit_name(const symbol *s, int primes);

/* The name of the SI unit of the same quantity. The caller frees it. */
char *shown_si_name(const symbol *s, int primes);

/* The text of a value in the file or on the command line, "0.72 [lb]", with single blanks. NULL without a text. The
 * caller frees it. */
char *shown_written(const expr *given);
/* As above, for a formula; NULL for a single number, with or without a unit. */
char *shown_formula(const expr *given);

/* "theta'=3 [rad/s]" for a number in SI, in the form of an option. The unit is included if the declared unit is not SI.
 * The caller frees it. */
char *shown_assignment(const symbol *s, int primes, const char *number);

/* The SI unit of a dimension into text[size]: "rad", "m/s", "kg*m^2/s^2", "1". Returns text. */
const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size);

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

/* As expr_value(); but a value that is not finite is reported at `at` and becomes 0. `what` names it, such as
 * "parameter 'm'". */
double finite_value(const expr *tree, valuation *known, place at, const char *what);

/* The value of parameter `index`. Reports once if it is not finite or depends on itself. */
double parameter_value(valuation *known, int index);

#endif
