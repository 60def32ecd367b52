/* derivative.c: time derivatives of lets, by the chain rule. The first use of a derivative adds a let for it. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "host/lang/expression.h"
#include "host/lang/statements.h"
#include "host/lang/value.h"

static const expr *number(parser *in, place at, double value) {
    expr *made = expr_new(in, EXPR_NUMBER, at);
    made->number = value;
    made->exact = enclosure_of(value);
    made->dim.any = value == 0.0;
    return made;
}

static const expr *call(parser *in, function_id f, place at, const expr *a) {
    return expr_call(in, f, at, a, NULL);
}

/* Builds a^n; NULL if the nesting is too deep (reported). */
static const expr *power(parser *in, const expr *a, double n) {
    return a == NULL ? NULL : expr_binary(in, EXPR_POW, a->at, a, number(in, a->at, n));
}

static const expr *square(parser *in, const expr *a) { return power(in, a, 2.0); }

/* Builds a + b or a - b. NULL stands for 0. */
static const expr *sum(parser *in, expr_op op, place at, const expr *a, const expr *b) {
    if (b == NULL) {
        return a;
    }
    if (a == NULL) {
        return op == EXPR_SUB ? expr_negate(in, at, b) : b;
    }
    return expr_binary(in, op, at, a, b);
}

/* The derivative of a function f(u) by u. NULL if it is 0, or if the nesting is too deep (reported). */
static const expr *slope(parser *in, const expr *of) {
    const expr *u = of->left;
    const place at = of->at;
    switch (of->function) {
    case FN_SIN: return call(in, FN_COS, at, u);
    case FN_COS: return expr_negate(in, at, call(in, FN_SIN, at, u));
    case FN_TAN: return expr_binary(in, EXPR_ADD, at, number(in, at, 1.0), square(in, of));
    case FN_ASIN:
    case FN_ACOS: {
        const expr *rest = expr_binary(in, EXPR_SUB, at, number(in, at, 1.0), square(in, u));
        const expr *up = power(in, rest, -0.5);
        return of->function == FN_ASIN ? up : expr_negate(in, at, up);
    }
    case FN_ATAN:
        return power(in, expr_binary(in, EXPR_ADD, at, number(in, at, 1.0), square(in, u)), -1.0);
    case FN_SQRT: return expr_binary(in, EXPR_MUL, at, number(in, at, 0.5), power(in, u, -0.5));
    case FN_EXP: return of;
    case FN_LOG: return power(in, u, -1.0);
    case FN_ABS: return call(in, FN_SIGN, at, u);
    case FN_SINH: return call(in, FN_COSH, at, u);
    case FN_COSH: return call(in, FN_SINH, at, u);
    case FN_TANH: return power(in, call(in, FN_COSH, at, u), -2.0);
    case FN_ATAN2: /* of_call() handles functions of two arguments */
    case FN_MIN:
    case FN_MAX:
    case FN_SIGN: break; /* the slope is 0, except at the jump */
    }
    return NULL;
}

static const expr *of_call(parser *in, const expr *of, const expr *du, const expr *dv) {
    const expr *u = of->left;
    const expr *v = of->right;
    const place at = of->at;
    if (of->function == FN_ATAN2) {
        const expr *top = sum(in, EXPR_SUB, at, expr_binary(in, EXPR_MUL, at, du, v),
                              expr_binary(in, EXPR_MUL, at, u, dv));
        const expr *size = expr_binary(in, EXPR_ADD, at, square(in, u), square(in, v));
        return expr_binary(in, EXPR_MUL, at, top, power(in, size, -1.0));
    }
    /* sign(u - v) selects du or dv */
    if (of->function == FN_MIN || of->function == FN_MAX) {
        const expr *lead = call(in, FN_SIGN, at, expr_binary(in, EXPR_SUB, at, u, v));
        const expr *half = number(in, at, of->function == FN_MIN ? -0.5 : 0.5);
        return sum(
            in, EXPR_ADD, at,
            expr_binary(in, EXPR_MUL, at, number(in, at, 0.5), sum(in, EXPR_ADD, at, du, dv)),
            expr_binary(in, EXPR_MUL, at, expr_binary(in, EXPR_MUL, at, half, lead),
                        sum(in, EXPR_SUB, at, du, dv)));
    }
    return expr_binary(in, EXPR_MUL, at, slope(in, of), du);
}

/* (u^v)' = v u^(v-1) u' + u^v log(u) v' */
static const expr *of_power(parser *in, const expr *of, const expr *du, const expr *dv) {
    const expr *u = of->left;
    const expr *v = of->right;
    const place at = of->at;
    double n = 0.0;
    const expr *less = expr_constant(v, &n) ? number(in, at, n - 1.0)
                                            : expr_binary(in, EXPR_SUB, at, v, number(in, at, 1.0));
    const expr *by_base =
        du == NULL
            ? NULL
            : expr_binary(in, EXPR_MUL, at,
                          expr_binary(in, EXPR_MUL, at, v, expr_binary(in, EXPR_POW, at, u, less)),
                          du);
    const expr *by_exponent =
        dv == NULL ? NULL
                   : expr_binary(in, EXPR_MUL, at,
                                 expr_binary(in, EXPR_MUL, at, of, call(in, FN_LOG, at, u)), dv);
    return sum(in, EXPR_ADD, at, by_base, by_exponent);
}

static bool of_symbol(parser *in, const expr *of, const token *name, const expr **d) {
    expr *made = expr_new(in, EXPR_SYMBOL, of->at);
    *made = *of;
    if (of->symbol->kind == SYM_INPUT) {
        made->symbol = of->symbol->rate;
        made->uses |= USES_UNIT;
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
    }
    if (of->symbol->kind != SYM_LET && !dim_derivative(of->dim, 1, &made->dim)) {
        made->dim.unknown = true;
    }
    *d = made;
    return true;
}

/* *d: the time derivative of `of`, or NULL if it is 0. Returns false after an error. */
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
                   "%.*s has no derivative: the input '%s' has no declared rate", (int)name->length,
                   name->text, of->symbol->name);
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
        *d = sum(in, EXPR_ADD, of->at, expr_binary(in, EXPR_MUL, of->at, du, v),
                 expr_binary(in, EXPR_MUL, of->at, u, dv));
        break;
    case EXPR_DIV:
        *d = sum(in, EXPR_SUB, of->at, expr_binary(in, EXPR_DIV, of->at, du, v),
                 dv == NULL
                     ? NULL
                     : expr_binary(in, EXPR_MUL, of->at, expr_binary(in, EXPR_MUL, of->at, u, dv),
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
    named *entry = (named *)(uintptr_t)let; /* the parser made this symbol, and may change it */
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
    made->symbol = *let;
    made->symbol.name = arena_words(in->arena, "%s'", let->name);
    made->symbol.value = d != NULL ? d : number(in, let->at, 0.0);
    made->symbol.dim = made->symbol.value->dim;
    parser_add_symbol(in, &into->lets, &into->let_count, &made->symbol);
    entry->rate = made;
    return &made->symbol;
}

/* === inputs with a rate ======================================================================= */

const symbol *symbol_moving(const symbol *s, int *primes) {
    if (s->kind != SYM_INPUT || s->driven == NULL) {
        return s;
    }
    *primes = s->driven->driven == s ? 0 : 1;
    return s->driven;
}

const symbol *symbol_acceleration(const symbol *driven) { return driven->driven->rate->rate; }

char *input_rate_hint(const symbol *input, char *buffer) {
    char unit[DIM_TEXT_SIZE];
    dimension dim = input->dim;
    const char *rest = input->at.source->text + input->at.offset + strlen(input->name);
    const int length = (int)strcspn(rest, "#\";\r\n");
    (void)dim_derivative(input->dim, 1, &dim);
    dimension_unit(dim, false, unit, sizeof unit);
    snprintf(buffer, RATE_HINT_SIZE,
             "input %.40s rate %.40s_rate%.*s; input %.40s_rate = 0 [%.40s]", input->name,
             input->name, length < 100 ? length : 0, rest, input->name,
             strcmp(unit, "1") == 0 ? "rad" : unit);
    return buffer;
}

static bool check_rate(parser *in, const mechanism *made, const symbol *s) {
    const named *rate = (const named *)s->rate;
    char unit[DIM_TEXT_SIZE];
    char hint[RATE_HINT_SIZE];
    dimension wanted;
    if (s->dim.unknown || rate->symbol.dim.unknown || !dim_derivative(s->dim, 1, &wanted)) {
        return false;
    }
    dimension_unit(wanted, false, unit, sizeof unit);
    snprintf(hint, sizeof hint, "input %s = 0 [%s]", rate->symbol.name, unit);
    if (rate->is_placeholder) {
        diag_error(in->diags, s->at, hint, "no input is called '%s', the rate of '%s'",
                   rate->symbol.name, s->name);
    } else if (rate->symbol.kind != SYM_INPUT || rate->symbol.effect >= 0) {
        diag_error(in->diags, s->at, hint,
                   "the rate of input '%s' must be another input of the mechanism", s->name);
    } else if (!dim_fits(rate->symbol.dim, wanted)) {
        diag_error(in->diags, rate->symbol.at, hint, "the rate of input '%s' must be in [%s]",
                   s->name, unit);
    } else if (made->is_system) {
        diag_error(
            in->diags, s->at, "replace the input by a state and its equation",
            "an input with a rate is not possible in a mechanism that is given by equations");
    } else if (rate->symbol.rate != NULL && rate->symbol.rate->rate != NULL) {
        diag_error(in->diags, rate->symbol.rate->at, "leave out the rate of the acceleration",
                   "'%s' is the acceleration of '%s', and an acceleration cannot have a rate",
                   rate->symbol.rate->name, s->name);
    } else {
        return true;
    }
    return false;
}

static bool is_rate(const mechanism *made, const symbol *s) {
    bool is = false;
    for (int i = 0; i < made->input_count; i++) {
        is = is || made->inputs[i]->rate == s;
    }
    return is;
}

static void drive(parser *in, mechanism *made, named *input) {
    named *coordinate = arena_alloc(in->arena, sizeof *coordinate);
    named *rate = (named *)input->symbol.rate;
    coordinate->symbol = input->symbol;
    coordinate->symbol.kind = SYM_COORDINATE;
    coordinate->symbol.order = 2;
    coordinate->symbol.value = NULL;
    coordinate->symbol.driven = &input->symbol;
    parser_add_symbol(in, &made->coordinates, &made->coordinate_count, &coordinate->symbol);
    input->symbol.driven = &coordinate->symbol;
    rate->symbol.driven = rate->symbol.driven != NULL ? rate->symbol.driven : &coordinate->symbol;
}

/* Each search needs a new `mark`: find_input() skips a let that has `mark`. */
static const symbol *find_input(const mechanism *made, const expr *tree, bool rates, int mark) {
    if (tree == NULL || (tree->uses & USES_INPUT) == 0) {
        return NULL;
    }
    if (tree->op == EXPR_SYMBOL && tree->symbol->kind == SYM_INPUT) {
        const bool found = rates ? is_rate(made, tree->symbol) : tree->symbol->rate == NULL;
        return found ? tree->symbol : NULL;
    }
    if (tree->op == EXPR_SYMBOL) {
        named *entry = (named *)tree->symbol;
        if (entry->mark == mark) {
            return NULL;
        }
        entry->mark = mark;
        return find_input(made, tree->symbol->value, rates, mark);
    }
    const symbol *found = find_input(made, tree->left, rates, mark);
    return found != NULL ? found : find_input(made, tree->right, rates, mark);
}

static void check_contact(parser *in, const mechanism *made, const contact_statement *each,
                          int mark) {
    char hint[RATE_HINT_SIZE];
    const symbol *rate = find_input(made, each->value, true, mark);
    if (rate != NULL) {
        diag_error(in->diags, each->value->at,
                   "write the position that is to be limited or held, not its rate",
                   "'stop' and 'hold' act on coordinates, not on rates: '%s' is a rate",
                   rate->name);
        return;
    }
    const symbol *input =
        each->kind == CONTACT_HOLD ? find_input(made, each->value, false, mark - 1) : NULL;
    if (input != NULL) {
        diag_error(in->diags, each->value->at, input_rate_hint(input, hint),
                   "the expression of the hold contains the input '%s', which has no declared rate",
                   input->name);
    }
}

void finish_inputs(parser *in, mechanism *made) {
    int mark = -1;
    for (int i = 0; i < made->input_count; i++) {
        const symbol *s = made->inputs[i];
        if (s->rate == NULL || !check_rate(in, made, s) || is_rate(made, s)) {
            continue;
        }
        if (made->coordinate_count == COORDINATES_MAX) {
            diag_error(in->diags, s->at, NULL,
                       "more than %d coordinates and inputs with a rate in one mechanism",
                       COORDINATES_MAX);
            return;
        }
        drive(in, made, (named *)s);
    }
    for (int k = 0; k < made->contact_count; k++, mark -= 2) {
        if (made->contacts[k].kind == CONTACT_STOP || made->contacts[k].kind == CONTACT_HOLD) {
            check_contact(in, made, &made->contacts[k], mark);
        }
    }
}
