/* operators.c: expression nodes, with the dimension rules of each operator and function. */
#include <stdlib.h>
#include <string.h>

#include "host/lang/expression.h"
#include "host/lang/value.h"

expr *expr_new(parser *in, expr_op op, place at) {
    expr *made = arena_alloc(in->arena, sizeof *made);
    made->op = op;
    made->at = at;
    made->height = 1;
    return made;
}

/* Does the expression contain pi? If so, it counts as given in radians. */
static bool has_pi(const expr *tree) {
    return tree != NULL && ((tree->op == EXPR_NUMBER && tree->number == PI) || has_pi(tree->left) ||
                            has_pi(tree->right));
}

static const symbol *angle_of(const expr *tree) {
    const symbol *s = tree->symbol;
    if (s != NULL && s->kind == SYM_LET && tree->primes == 0) {
        return s->value != NULL ? angle_of(s->value) : NULL;
    }
    const bool is_angle = s != NULL && tree->primes == 0 && dim_is_none(s->dim) &&
                          (s->is_angle || unit_is_angle(s->unit, strlen(s->unit)));
    return is_angle && !unit_is_si(s->declared) ? s : tree->angle;
}

static bool is_factor(const expr *tree) { return tree != NULL && tree->uses == 0 && !has_pi(tree); }

static const symbol *angle_in(expr_op op, const expr *left, const expr *right) {
    const symbol *a = angle_of(left);
    const symbol *b = right != NULL ? angle_of(right) : NULL;
    switch (op) {
    case EXPR_MUL: return is_factor(left) ? b : is_factor(right) ? a : NULL;
    case EXPR_DIV: return is_factor(right) ? a : NULL;
    case EXPR_ADD:
    case EXPR_SUB:
    case EXPR_NEG: return a != NULL ? a : b;
    case EXPR_NUMBER:
    case EXPR_SYMBOL:
    case EXPR_POW:
    case EXPR_CALL: break;
    }
    return NULL;
}

static expr *join(parser *in, expr_op op, place at, const expr *left, const expr *right) {
    if (left == NULL) {
        return NULL;
    }
    expr *made = expr_new(in, op, at);
    made->left = left;
    made->right = right;
    made->height = left->height + 1;
    made->order = left->order;
    made->uses = left->uses;
    made->is_condition = left->is_condition;
    made->angle = angle_in(op, left, right);
    if (right != NULL) {
        made->height = right->height >= left->height ? right->height + 1 : made->height;
        made->order = right->order > left->order ? right->order : left->order;
        made->uses |= right->uses;
    }
    if (made->height > EXPR_HEIGHT_MAX) {
        diag_error(in->diags, at, "group its terms in parentheses, or split it with let",
                   "this expression is more than %d operators deep", EXPR_HEIGHT_MAX);
        return NULL;
    }
    return made;
}

bool expr_constant(const expr *tree, double *value) {
    if (tree->uses != 0 || tree->dim.unknown) {
        return false;
    }
    *value = expr_value(tree, NULL);
    return *value - *value == 0.0;
}

static bool is_bare_number(const expr *tree) {
    while (tree->op == EXPR_NEG) {
        tree = tree->left;
    }
    return tree->op == EXPR_NUMBER && tree->uses == 0;
}

const char *dimension_words(const parser *in, dimension dim) {
    return dim_text(dim, arena_alloc(in->arena, DIM_TEXT_SIZE), DIM_TEXT_SIZE);
}

static const char *number_hint(parser *in, const expr *number, dimension wanted) {
    char text[DIM_TEXT_SIZE];
    double value = 0.0;
    expr_constant(number, &value);
    return arena_words(in->arena, "a bare number is dimensionless: write %.15g [%s]", value,
                       dim_unit(wanted, text, sizeof text));
}

bool check_dimension(parser *in, place at, const expr *value, dimension wanted, const char *rule) {
    if (dim_fits(value->dim, wanted)) {
        return true;
    }
    diag_error(in->diags, at, is_bare_number(value) ? number_hint(in, value, wanted) : NULL,
               "%s, but this is %s", rule, dimension_words(in, value->dim));
    return false;
}

bool check_named(parser *in, place at, const expr *value, dimension wanted, const char *subject,
                 const char *verb) {
    return check_dimension(
        in, at, value, wanted,
        arena_words(in->arena, "%s %s %s", subject, verb, dimension_words(in, wanted)));
}

static const char is_declared[] = "'%s' is declared in [%s], and this value has no unit";

/* Reports a number without a unit beside an angle that is not declared in rad. */
static void check_bare(parser *in, const expr *value, const symbol *angle) {
    const symbol *s = value->symbol;
    const expr *is = s != NULL && s->kind == SYM_LET && s->value != NULL ? s->value : value;
    double number = 0.0;
    if (angle == NULL || !expr_constant(is, &number) || number == 0.0 || has_pi(is)) {
        return;
    }
    const char *text = s != NULL ? arena_words(in->arena, "%s*1", s->name)
                                 : arena_words(in->arena, "%.15g", number);
    const char *hint = arena_words(
        in->arena,
        "write %s [%s], or in SI: %s [rad]; formulas take '%s' in radians, without a factor such as 57.3",
        text, angle->unit, text, angle->name);
    diag_error(in->diags, value->at, hint, is_declared, angle->name, angle->unit);
}

/* Reports a missing unit. `with_name`: the hint may name the symbol. On the command line, `with_name` is ignored. */
static bool has_unit(parser *in, place at, const expr *value, const symbol *of, int primes,
                     bool with_name) {
    enum { SHOWN_MAX = 60 };
    const unsigned known = USES_UNIT | USES_UNKNOWNS | USES_INPUT;
    double number = 1.0;
    if (unit_is_si(of->declared) || (value->uses & known) != 0 || !dim_is_none(value->dim) ||
        value->dim.unknown || (expr_constant(value, &number) && number == 0.0)) {
        return true;
    }
    const char *text = at.source->text + at.offset;
    size_t length =
        (in->token.kind == TOKEN_END ? at.source->length : in->token.at.offset) - at.offset;
    for (size_t i = 1; i < length; i++) { /* "LOW .. HIGH" of a range: keep LOW */
        length = text[i - 1] == '.' && text[i] == '.' ? i - 1 : length;
    }
    while (length > 0 && strchr(" \t\r\n", text[length - 1]) != NULL) {
        length--;
    }
    const bool plain = is_bare_number(value) && text[length - 1] != ')';
    const bool typed = in->builder == NULL; /* the text is from the command line */
    const char *quote = typed ? "\"" : "";
    const bool has_name =
        typed ? memchr(at.source->text, '=', at.offset) != NULL : with_name && in->around == NULL;
    const char *lead = typed || has_name ? "" : "write ";
    const char *before = in->around != NULL ? in->around[0] : "";
    const char *after = in->around != NULL ? in->around[1] : "";
    char *unit = shown_unit_name(of, primes);
    char *si = shown_si_name(of, primes);
    const char *number_text = arena_words(in->arena, plain ? "%.*s" : "(%.*s)*1",
                                          (int)(length > SHOWN_MAX ? SHOWN_MAX : length), text);
    const char *name =
        has_name ? arena_words(in->arena, "%s%.*s = ", of->name, primes, "'''''''''") : "";
    const char *hint = arena_words(in->arena, "%s%s%s%s%s [%s]%s%s, or in SI: %s%s%s%s [%s]%s%s",
                                   lead, quote, name, before, number_text, unit, after, quote,
                                   quote, name, before, number_text, si, after, quote);
    diag_error(in->diags, at, hint, is_declared, of->name, of->unit);
    free(si);
    free(unit);
    return false;
}

bool check_unit(parser *in, place at, const expr *value, const symbol *of, int primes) {
    return has_unit(in, at, value, of, primes, true);
}

bool check_value(parser *in, place at, const expr *value, const symbol *of, const token *name) {
    dimension wanted;
    return dim_derivative(of->dim, name->primes, &wanted) &&
           check_unit(in, at, value, of, name->primes) &&
           check_named(in, at, value, wanted, token_words(in, name), "is");
}

bool check_limit(parser *in, place at, const expr *value, const expr *of) {
    return of->op != EXPR_SYMBOL || of->symbol == NULL || of->symbol->kind == SYM_PARAMETER ||
           has_unit(in, at, value, of->symbol, of->primes, false);
}

/* Returns the common dimension. If the dimensions differ, reports "cannot BEFORE left BETWEEN right". */
static dimension common_dimension(parser *in, place at, const expr *left, const expr *right,
                                  const char *before, const char *between) {
    dimension common = left->dim.any ? right->dim : left->dim;
    common.unknown = left->dim.unknown || right->dim.unknown;
    if (dim_fits(left->dim, right->dim)) {
        check_bare(in, left, angle_of(right));
        check_bare(in, right, angle_of(left));
        return common;
    }
    const char *hint = is_bare_number(right)  ? number_hint(in, right, left->dim)
                       : is_bare_number(left) ? number_hint(in, left, right->dim)
                                              : NULL;
    diag_error(
        in->diags, at, hint, "cannot %s %s %s %s", before,
        dim_is_none(left->dim) ? "a dimensionless number" : dimension_words(in, left->dim), between,
        dim_is_none(right->dim) ? "a dimensionless number" : dimension_words(in, right->dim));
    common.unknown = true;
    return common;
}

static bool range_error(parser *in, place at) {
    diag_error(in->diags, at, NULL, "an exponent of this dimension is outside -99 to 99");
    return false;
}

static bool power_dimension(parser *in, place at, const expr *base, const expr *exponent,
                            dimension *dim) {
    double value = 0.0;
    if (!dim_is_none(exponent->dim)) {
        diag_error(in->diags, at, NULL, "an exponent must be dimensionless, but this is %s",
                   dimension_words(in, exponent->dim));
        return false;
    }
    if (base->dim.unknown || exponent->dim.unknown) {
        return false;
    }
    if (!expr_constant(exponent, &value)) {
        if (!dim_is_none(base->dim)) {
            diag_error(in->diags, at, "make the base dimensionless: (x/L)^n",
                       "%s needs a constant number as its exponent",
                       dimension_words(in, base->dim));
        }
        return dim_is_none(base->dim);
    }
    if (!dim_power(base->dim, value, dim)) {
        diag_error(in->diags, at, NULL, "%s to the power %g is no dimension",
                   dimension_words(in, base->dim), value);
        return false;
    }
    return true;
}

const expr *expr_binary(parser *in, expr_op op, place at, const expr *left, const expr *right) {
    expr *made = right == NULL ? NULL : join(in, op, at, left, right);
    bool known = true;
    if (made == NULL) {
        return NULL;
    }
    switch (op) {
    case EXPR_ADD: made->dim = common_dimension(in, at, left, right, "add", "and"); break;
    case EXPR_SUB: made->dim = common_dimension(in, at, right, left, "subtract", "from"); break;
    case EXPR_MUL:
        known = dim_multiply(left->dim, right->dim, &made->dim) || range_error(in, at);
        break;
    case EXPR_DIV:
        if (right->op == EXPR_NUMBER && right->number == 0.0 && !right->dim.unknown) {
            diag_error(in->diags, at, NULL, "division by zero");
            known = false;
        } else {
            known = dim_divide(left->dim, right->dim, &made->dim) || range_error(in, at);
        }
        break;
    case EXPR_POW: known = power_dimension(in, at, left, right, &made->dim); break;
    case EXPR_NUMBER:
    case EXPR_SYMBOL:
    case EXPR_NEG:
    case EXPR_CALL: break;
    }
    made->dim.unknown |= !known;
    return made;
}

/* Do the two expressions have the same operators and operands in the same order? */
static bool are_same(const expr *a, const expr *b) {
    if (a == NULL || b == NULL) {
        return a == b;
    }
    /* members that an operator does not use are 0 */
    return a->op == b->op && a->number == b->number && a->symbol == b->symbol &&
           a->primes == b->primes && a->function == b->function && are_same(a->left, b->left) &&
           are_same(a->right, b->right);
}

const expr *expr_difference(parser *in, place at, const expr *left, const expr *right) {
    expr *made = join(in, EXPR_SUB, at, left, right);
    if (made != NULL) {
        made->dim = common_dimension(in, at, left, right, "compare", "with");
        if (are_same(left, right)) {
            diag_error(in->diags, at, "compare two quantities whose difference can change its sign",
                       "both sides are the same, so this comparison never changes");
        }
    }
    return made;
}

const expr *expr_negate(parser *in, place at, const expr *operand) {
    expr *made = join(in, EXPR_NEG, at, operand, NULL);
    if (made != NULL) {
        made->dim = operand->dim;
    }
    return made;
}

const expr *expr_call(parser *in, function_id function, place at, const expr *left,
                      const expr *right) {
    expr *made = join(in, EXPR_CALL, at, left, right);
    if (made == NULL) {
        return NULL;
    }
    made->function = function;
    const char *name = function_name(function);
    made->dim.unknown = left->dim.unknown || (right != NULL && right->dim.unknown);
    const char *words = arena_words(in->arena, "compare in %s:", name);
    switch (function_takes(function)) {
    case TAKES_RATIO:
        common_dimension(in, at, left, right, words, "and");
        made->uses |= USES_UNIT;
        break;
    case TAKES_CHOICE:
        made->dim = common_dimension(in, at, left, right, words, "and");
        made->angle = angle_in(EXPR_ADD, left, right);
        break;
    case TAKES_SIZE:
        made->dim = left->dim;
        made->angle = angle_of(left);
        break;
    case TAKES_ANY: break;
    case TAKES_SQUARE:
        if (!dim_power(left->dim, 0.5, &made->dim)) {
            diag_error(in->diags, at, NULL, "the square root of %s is no dimension",
                       dimension_words(in, left->dim));
            made->dim.unknown = true;
        }
        break;
    case TAKES_ANGLE:
        if (!dim_is_none(left->dim)) {
            diag_error(in->diags, at, "write an angle in radians, such as arc/radius",
                       "%s takes an angle, but this is %s", name, dimension_words(in, left->dim));
        }
        break;
    case TAKES_NUMBER:
        if (!dim_is_none(left->dim)) {
            diag_error(in->diags, at, NULL, "%s takes a dimensionless value, but this is %s", name,
                       dimension_words(in, left->dim));
        }
        if (function == FN_ASIN || function == FN_ACOS || function == FN_ATAN) {
            made->uses |= USES_UNIT;
        }
        break;
    }
    return made;
}
