#include "value.h"

#include <math.h>
#include <stdio.h>

#include "host/base/arena.h"
#include "host/number/folding.h"

enum {
    NAME_BUFFER = 100,
    DEPTH_MAX = 20000 /* operators in a chain of values that set each other: bounds the recursion */
};

valuation valuation_new(const mechanism *of, struct arena *arena, diags *all) {
    const size_t parameters = (size_t)of->parameter_count;
    const size_t lets = (size_t)of->let_count;
    valuation made = {.of = of, .diags = all};
    made.parameter_expr = arena_alloc(arena, parameters * sizeof *made.parameter_expr);
    made.parameter_at = arena_alloc(arena, parameters * sizeof *made.parameter_at);
    made.parameter = arena_alloc(arena, parameters * sizeof *made.parameter);
    made.parameter_state = arena_alloc(arena, parameters * sizeof *made.parameter_state);
    made.let = arena_alloc(arena, lets * sizeof *made.let);
    made.let_known = arena_alloc(arena, lets * sizeof *made.let_known);
    for (int i = 0; i < of->parameter_count; i++) {
        made.parameter_expr[i] = of->parameters[i]->value;
        made.parameter_at[i] = of->parameters[i]->at;
    }
    return made;
}

double parameter_value(valuation *known, int index) {
    const char *name = known->of->parameters[index]->name;
    const place at = known->parameter_at[index];
    if (known->parameter_state[index] == 2) {
        return known->parameter[index];
    }
    known->parameter[index] = 0.0;
    if (known->parameter_state[index] == 1) {
        diag_error(known->diags, at, "declared values may be used, but not round in a circle",
                   "'%s' is set from itself", name);
        return 0.0;
    }
    const int height = known->parameter_expr[index]->height;
    if (known->depth + height > DEPTH_MAX) {
        diag_error(known->diags, at, "set some of them to numbers",
                   "too long a chain of values set one from the other");
        return 0.0;
    }
    known->parameter_state[index] = 1;
    known->depth += height;
    char what[NAME_BUFFER];
    snprintf(what, sizeof what, "parameter '%s'", name);
    const double value = finite_value(known->parameter_expr[index], known, at, what);
    known->depth -= height;
    known->parameter_state[index] = 2;
    known->parameter[index] = value;
    return value;
}

static double symbol_value(const symbol *named, int primes, valuation *known) {
    if (known == NULL || named == NULL) {
        return (double)NAN;
    }
    if (named->kind == SYM_PARAMETER) {
        return parameter_value(known, named->index);
    }
    if (named->kind == SYM_INPUT && known->input != NULL) {
        return known->input[named->index];
    }
    const bool moves = named->kind == SYM_COORDINATE || named->kind == SYM_STATE;
    if (moves && known->state != NULL && primes <= known->primes_most) {
        return known->state[named->index][primes];
    }
    if (named->kind == SYM_LET && !known->let_known[named->index]) {
        known->let[named->index] = expr_value(named->value, known);
        known->let_known[named->index] = true;
    }
    return named->kind == SYM_LET ? known->let[named->index] : (double)NAN;
}

double expr_value(const expr *tree, valuation *known) {
    const double a = tree->left == NULL ? 0.0 : expr_value(tree->left, known);
    const double b = tree->right == NULL ? 0.0 : expr_value(tree->right, known);
    switch (tree->op) {
    case EXPR_NUMBER: return tree->number;
    case EXPR_SYMBOL: return symbol_value(tree->symbol, tree->primes, known);
    case EXPR_ADD: return folding_sum(a, b);
    case EXPR_SUB: return folding_sum(a, -b);
    case EXPR_MUL: return folding_product(a, b);
    case EXPR_DIV: return folding_quotient(a, b);
    case EXPR_POW: return folding_power(a, b);
    case EXPR_NEG: return -a;
    case EXPR_CALL: return folding_call(tree->function, a, b);
    }
    return (double)NAN;
}

double finite_value(const expr *tree, valuation *known, place at, const char *what) {
    const size_t before = diags_calls(known->diags);
    const double value = expr_value(tree, known);
    if (isfinite(value)) {
        return value;
    }
    if (diags_calls(known->diags) == before) {
        diag_error(known->diags, at, NULL, "%s is not a finite number (%s)", what,
                   isnan(value)  ? "not a number"
                   : value > 0.0 ? "infinity"
                                 : "minus infinity");
    }
    return 0.0;
}
