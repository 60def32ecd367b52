/* value.c: values of constant expressions, and the units in which values are shown. */
#include "host/lang/value.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/folding.h"

const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size) {
    if (dim_is_none(dim)) {
        snprintf(text, size, "%s", is_angle ? "rad" : "1");
        return text;
    }
    return dim_recorded_unit(dim, text, size);
}

unit_scale shown_unit(const symbol *s) {
    const unit_scale si = {1.0, 1.0, s->dim, enclosure_of(1.0)};
    return unit_is_si(s->declared) ? si : s->declared;
}

char *shown_si_name(const symbol *s, int primes) {
    char text[DIM_TEXT_SIZE];
    dimension dim = s->dim;
    const bool is_angle =
        s->is_angle || unit_is_angle(s->unit, strlen(s->unit)) || strcmp(s->unit, "mrad") == 0;
    if (is_angle && primes > 0) {
        snprintf(text, sizeof text, primes > 1 ? "rad/s^%d" : "rad/s", primes);
        return alloc_words("%s", text);
    }
    dim.twelfths[DIM_TIME] = (short)(dim.twelfths[DIM_TIME] - DIM_DENOMINATOR * primes);
    dim.any = dim.any && primes == 0;
    return alloc_words("%s", dimension_unit(dim, is_angle, text, sizeof text));
}

char *shown_unit_name(const symbol *s, int primes) {
    if (s->unit[0] == '\0' || (primes > 0 && unit_is_si(s->declared))) {
        return shown_si_name(s, primes);
    }
    char per[16] = "";
    if (primes > 0) {
        snprintf(per, sizeof per, primes > 1 ? "/s^%d" : "/s", primes);
    }
    return alloc_words("%s%s", s->unit, per);
}

char *shown_written(const expr *given) {
    const expr *leaf = given;
    while (leaf != NULL && leaf->left != NULL) {
        leaf = leaf->left;
    }
    if (leaf == NULL || leaf->at.source == NULL || leaf->at.source->text == NULL) {
        return NULL;
    }
    const char *text = leaf->at.source->text;
    size_t at = leaf->at.offset;
    /* go back to the start of the whole value: signs, parentheses or a function's name may precede the leaf */
    while (at > 0 && strchr("=\n", text[at - 1]) == NULL) {
        at--;
    }
    at += strspn(text + at, " \t");
    char *copy = alloc((int64_t)strlen(text + at) + 1, 1);
    size_t length = 0;
    int depth = 0;
    for (; text[at] != '\0'; at++) {
        const bool blank = strchr(" \t\r\n", text[at]) != NULL;
        depth += (text[at] == '(') - (text[at] == ')');
        if (depth <= 0 && strchr("\n#\",;}", text[at]) != NULL) {
            break;
        }
        if (text[at] == '#') { /* a comment inside parentheses */
            at += strcspn(text + at, "\n") - 1;
        } else if (!blank || (length > 0 && copy[length - 1] != ' ')) {
            copy[length++] = blank ? ' ' : text[at];
        }
    }
    length -= length > 0 && copy[length - 1] == ' ';
    copy[length] = '\0';
    return copy;
}

char *shown_formula(const expr *given) {
    const expr *number = given != NULL && given->op == EXPR_NEG ? given->left : given;
    return number == NULL || number->op == EXPR_NUMBER ? NULL : shown_written(given);
}

char *shown_assignment(const symbol *s, int primes, const char *number) {
    char *si = shown_si_name(s, primes);
    char *made = unit_is_si(s->declared)
                     ? alloc_words("%s%.*s=%s", s->name, primes, "'''''''''", number)
                     : alloc_words("%s%.*s=%s [%s]", s->name, primes, "'''''''''", number, si);
    free(si);
    return made;
}

/* === constant expressions ===================================================================== */

enum {
    NAME_BUFFER = 100,
    DEPTH_MAX = 20000 /* upper limit of valuation.depth, because evaluation is recursive */
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
        diag_error(known->diags, at,
                   "set one of the parameters that depend on each other to a number",
                   "'%s' is set to a value that depends on itself", name);
        return 0.0;
    }
    const int height = known->parameter_expr[index]->height;
    if (known->depth + height > DEPTH_MAX) {
        diag_error(known->diags, at, "set some of these values to numbers",
                   "too many values depend on each other in a chain");
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
    if (symbol_moves(named) && known->state != NULL && primes <= known->primes_most) {
        return known->state[named->index][primes];
    }
    if (named->kind == SYM_LET && !known->let_known[named->index]) {
        known->let[named->index] = expr_value(named->value, known);
        known->let_known[named->index] = true;
    }
    return named->kind == SYM_LET ? known->let[named->index] : (double)NAN;
}

double expr_value(const expr *tree, valuation *known) {
    folding *const f = known != NULL ? known->folding : NULL;
    const double a = tree->left == NULL ? 0.0 : expr_value(tree->left, known);
    const double b = tree->right == NULL ? 0.0 : expr_value(tree->right, known);
    switch (tree->op) {
    case EXPR_NUMBER: return tree->number;
    case EXPR_SYMBOL: return symbol_value(tree->symbol, tree->primes, known);
    case EXPR_ADD: return folding_sum(f, a, b);
    case EXPR_SUB: return folding_sum(f, a, -b);
    case EXPR_MUL: return folding_product(f, a, b);
    case EXPR_DIV: return folding_quotient(f, a, b);
    case EXPR_POW: return folding_power(f, a, b);
    case EXPR_NEG: return -a;
    case EXPR_CALL: return folding_call(f, tree->function, a, b);
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
