/* value.h: values of constant expressions, and the units in which values are shown. */
#ifndef LANG_VALUE_H
#define LANG_VALUE_H

#include "host/lang/model.h"

/* === units of displayed numbers: the declared unit, or SI ===================================== */

/* Returns the display unit of a symbol: the declared unit, or SI if none is declared. A derivative is displayed in this
 * unit per second for each prime: deg/s and deg/s^2 if the unit is deg. */
unit_scale shown_unit(const symbol *s);

/* Returns the name of the display unit, such as "deg/s", "kg*m/s^2", "rad" or "1". The caller frees it. */
char *shown_unit_name(const symbol *s, int primes);

/* Returns the name of the SI unit of the same quantity. The caller frees it. */
char *shown_si_name(const symbol *s, int primes);

/* Returns a value's source text, such as "0.72 [lb]"; NULL if the value has none. The caller frees the text. */
char *shown_written(const expr *given);
/* As shown_written(), for a formula. NULL for a single number, with or without a unit. */
char *shown_formula(const expr *given);

/* Returns an assignment in the form of an option, such as "theta'=3 [rad/s]". `number` is SI. The text has no unit if
 * the declared unit of `s` is SI. The caller frees it. */
char *shown_assignment(const symbol *s, int primes, const char *number);

/* Writes the SI unit of a dimension to text[size], such as "rad", "m/s", "kg*m^2/s^2" or "1". Returns `text`. */
const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size);

/* The parameters of one run. Each is evaluated when it is first used, because a `set` may use a later parameter. */
typedef struct valuation {
    const mechanism *of;
    const expr **parameter_expr;  /* [parameter_count] */
    place *parameter_at;          /* [parameter_count] place of the declaration or assignment */
    double *parameter;            /* [parameter_count] SI */
    signed char *parameter_state; /* [parameter_count] evaluation: 0 not begun, 1 begun, 2 done */
    double *let;                  /* [let_count] */
    bool *let_known;              /* [let_count] */
    const double *input;          /* [input_count] SI; NULL: the value of an input is NaN */
    double *const *state;         /* [coordinate_count][0 .. primes_most] SI, or NULL */
    int primes_most;
    int depth; /* current depth of the recursion through the parameters' expressions */
    diags *diags;
    folding *folding; /* of the sums and functions; may be NULL */
} valuation;

valuation valuation_new(const mechanism *of, struct arena *arena, diags *diags);

/* Returns the SI value. `known` may be NULL if the tree has only numbers and operators. */
double expr_value(const expr *tree, valuation *known);

/* As expr_value(). If the value is not finite, reports this at `at` under the name `what`, and returns 0. */
double finite_value(const expr *tree, valuation *known, place at, const char *what);

/* Returns the value of parameter `index`. If it is not finite, or depends on itself, this is reported once. */
double parameter_value(valuation *known, int index);

#endif
