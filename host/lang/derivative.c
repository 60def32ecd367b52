/* derivative.c: time derivatives of lets, by the chain rule. Each derivative is a let without a statement, made when it
 * is first named. Other code treats it like any let. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "host/lang/expression.h"

/* A derivative that is 0 has no tree: *d is NULL. All functions return false after an error. */
static bool derive(parser *in, const expr *of, const token *name, const expr **d);

static const expr *number(parser *in, place at, double value) {
    expr *made = expr_new(in, EXPR_NUMBER, at);
    made->number = value;
    made->exact = enclosure_of(value);
    made->dim.any = value == 0.0;
    return made;
}

static const expr *binary(parser *in, expr_op op, place at, const expr *a, const expr *b) {
    return a == NULL || b == NULL ? NULL : expr_binary(in, op, at, a, b);
}

static const expr *call(parser *in, function_id f, place at, const expr *a) {
    return a == NULL ? NULL : expr_call(in, f, at, a, NULL);
}

/* a^n. Negative powers keep their base whole; a quotient by a product would not. NULL: too deep (reported). */
static const expr *power(parser *in, const expr *a, double n) {
    return a == NULL ? NULL : binary(in, EXPR_POW, a->at, a, number(in, a->at, n));
}

static const expr *square(parser *in, const expr *a) { return power(in, a, 2.0); }

static const expr *negative(parser *in, const expr *a) {
    return a == NULL ? NULL : expr_negate(in, a->at, a);
}

/* a + b, a - b, with NULL for 0. */
static const expr *sum(parser *in, expr_op op, place at, const expr *a, const expr *b) {
    if (b == NULL) {
        return a;
    }
    if (a == NULL) {
        return op == EXPR_SUB ? expr_negate(in, at, b) : b;
    }
    return expr_binary(in, op, at, a, b);
}

/* The derivative of the function by its argument u; NULL: zero, or too deep. */
static const expr *slope(parser *in, const expr *of) {
    const expr *u = of->left;
    const place at = of->at;
    switch (of->function) {
    case FN_SIN: return call(in, FN_COS, at, u);
    case FN_COS: return negative(in, call(in, FN_SIN, at, u));
    case FN_TAN: return binary(in, EXPR_ADD, at, number(in, at, 1.0), square(in, of));
    case FN_ASIN:
    case FN_ACOS: {
        const expr *rest = binary(in, EXPR_SUB, at, number(in, at, 1.0), square(in, u));
        const expr *up = power(in, rest, -0.5);
        return of->function == FN_ASIN ? up : negative(in, up);
    }
    case FN_ATAN:
        return power(in, binary(in, EXPR_ADD, at, number(in, at, 1.0), square(in, u)), -1.0);
    case FN_SQRT: return binary(in, EXPR_MUL, at, number(in, at, 0.5), power(in, u, -0.5));
    case FN_EXP: return of;
    case FN_LOG: return power(in, u, -1.0);
    case FN_ABS: return call(in, FN_SIGN, at, u);
    case FN_SINH: return call(in, FN_COSH, at, u);
    case FN_COSH: return call(in, FN_SINH, at, u);
    case FN_TANH: return power(in, call(in, FN_COSH, at, u), -2.0);
    case FN_ATAN2: /* with two arguments: below */
    case FN_MIN:
    case FN_MAX:
    case FN_SIGN: break; /* 0, except at its jump */
    }
    return NULL;
}

static const expr *of_call(parser *in, const expr *of, const expr *du, const expr *dv) {
    const expr *u = of->left;
    const expr *v = of->right;
    const place at = of->at;
    if (of->function == FN_ATAN2) {
        const expr *top =
            sum(in, EXPR_SUB, at, binary(in, EXPR_MUL, at, du, v), binary(in, EXPR_MUL, at, u, dv));
        const expr *size = binary(in, EXPR_ADD, at, square(in, u), square(in, v));
        return binary(in, EXPR_MUL, at, top, power(in, size, -1.0));
    }
    if (of->function == FN_MIN || of->function == FN_MAX) { /* half of each at equality */
        const expr *lead = call(in, FN_SIGN, at, binary(in, EXPR_SUB, at, u, v));
        const expr *half = number(in, at, of->function == FN_MIN ? -0.5 : 0.5);
        return sum(in, EXPR_ADD, at,
                   binary(in, EXPR_MUL, at, number(in, at, 0.5), sum(in, EXPR_ADD, at, du, dv)),
                   binary(in, EXPR_MUL, at, binary(in, EXPR_MUL, at, half, lead),
                          sum(in, EXPR_SUB, at, du, dv)));
    }
    return binary(in, EXPR_MUL, at, slope(in, of), du);
}

/* u^v: v u^(v-1) u' + u^v log(u) v' */
static const expr *of_power(parser *in, const expr *of, const expr *du, const expr *dv) {
    const expr *u = of->left;
    const expr *v = of->right;
    const place at = of->at;
    double n = 0.0;
    const expr *less = expr_constant(v, &n) ? number(in, at, n - 1.0)
                                            : binary(in, EXPR_SUB, at, v, number(in, at, 1.0));
    const expr *by_base =
        du == NULL ? NULL
                   : binary(in, EXPR_MUL, at,
                            binary(in, EXPR_MUL, at, v, binary(in, EXPR_POW, at, u, less)), du);
    const expr *by_exponent =
        dv == NULL
            ? NULL
            : binary(in, EXPR_MUL, at, binary(in, EXPR_MUL, at, of, call(in, FN_LOG, at, u)), dv);
    return sum(in, EXPR_ADD, at, by_base, by_exponent);
}

static bool of_symbol(parser *in, const expr *of, const token *name, const expr **d) {
    expr *made = expr_new(in, EXPR_SYMBOL, of->at);
    *made = *of;
    if (of->symbol->kind == SYM_INPUT) {
        made->symbol = of->symbol->rate;
        made->uses |= USES_UNIT;
        if (!dim_divide(of->dim, dim_of(0, 0, 1, 0, 0), &made->dim)) {
            made->dim.unknown = true;
        }
    } else if (of->symbol->kind == SYM_LET) {
        const symbol *rate = let_rate(in, of->symbol, name);
        if (rate == NULL || (rate->value->op == EXPR_NUMBER && rate->value->number == 0.0)) {
            return rate != NULL;
        }
        made->symbol = rate;
        made->dim = rate->dim;
        made->order = rate->value->order;
        made->uses = rate->value->uses | USES_UNIT;
        made->height = rate->value->height + 1;
    } else {
        made->primes++;
        made->order++;
        if (!dim_divide(of->dim, dim_of(0, 0, 1, 0, 0), &made->dim)) {
            made->dim.unknown = true;
        }
    }
    *d = made;
    return true;
}

static bool derive(parser *in, const expr *of, const token *name, const expr **d) {
    const size_t before = diags_calls(in->diags);
    const expr *du = NULL;
    const expr *dv = NULL;
    *d = NULL;
    if ((of->uses & (USES_UNKNOWNS | USES_INPUT)) == 0) {
        return true;
    }
    if (of->op == EXPR_SYMBOL && of->symbol->kind == SYM_INPUT && of->symbol->rate == NULL) {
        char hint[RATE_HINT_SIZE];
        diag_error(in->diags, name->at, input_rate_hint(of->symbol, hint),
                   "%.*s has no derivative: the rate of the input '%s' is not known",
                   (int)name->length, name->text, of->symbol->name);
        return false;
    }
    if (of->op == EXPR_SYMBOL) {
        return of_symbol(in, of, name, d);
    }
    if (!derive(in, of->left, name, &du) ||
        (of->right != NULL && !derive(in, of->right, name, &dv))) {
        return false;
    }
    const expr *u = of->left;
    const expr *v = of->right;
    if (du == NULL && dv == NULL) {
        return true;
    }
    switch (of->op) {
    case EXPR_ADD:
    case EXPR_SUB: *d = sum(in, of->op, of->at, du, dv); break;
    case EXPR_MUL:
        *d = sum(in, EXPR_ADD, of->at, binary(in, EXPR_MUL, of->at, du, v),
                 binary(in, EXPR_MUL, of->at, u, dv));
        break;
    case EXPR_DIV:
        *d = sum(in, EXPR_SUB, of->at, binary(in, EXPR_DIV, of->at, du, v),
                 dv == NULL ? NULL
                            : binary(in, EXPR_MUL, of->at, binary(in, EXPR_MUL, of->at, u, dv),
                                     power(in, v, -2.0)));
        break;
    case EXPR_POW: *d = of_power(in, of, du, dv); break;
    case EXPR_NEG: *d = expr_negate(in, of->at, du); break;
    case EXPR_CALL: *d = of_call(in, of, du, dv); break;
    case EXPR_NUMBER:
    case EXPR_SYMBOL: break;
    }
    return diags_calls(in->diags) == before;
}

const symbol *let_rate(parser *in, const symbol *let, const token *name) {
    named *entry = (named *)(uintptr_t)let; /* a symbol of the current mechanism */
    const expr *d = NULL;
    if (entry->rate != NULL) {
        return &entry->rate->symbol;
    }
    if (in->builder == NULL) {
        diag_error(in->diags, name->at, "give the derivative a name in the file: let NAME = X'",
                   "the file does not use a derivative of the let '%s'", let->name);
        return NULL;
    }
    if (!derive(in, let->value, name, &d)) {
        return NULL;
    }
    mechanism *into = in->builder->made;
    named *made = arena_alloc(in->arena, sizeof *made);
    const symbol **longer = arena_room(in->arena, into->lets, into->let_count, sizeof *longer);
    char *text = arena_alloc(in->arena, strlen(let->name) + 2);
    sprintf(text, "%s'", let->name);
    made->symbol = *let;
    made->symbol.name = text;
    made->symbol.index = into->let_count;
    made->symbol.value = d != NULL ? d : number(in, let->at, 0.0);
    made->symbol.dim = made->symbol.value->dim;
    longer[into->let_count++] = &made->symbol;
    into->lets = longer;
    entry->rate = made;
    return &made->symbol;
}
