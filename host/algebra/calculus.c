/* calculus.c: derivatives, substitution, and conversion of parsed expressions to normal form. */
#include <math.h>
#include <stdlib.h>

#include "host/algebra/algebra.h"
#include "host/algebra/poly.h"

/* === derivatives of functions ================================================================= */

static const poly *negative(algebra *a, const poly *p) { return poly_scale(a, p, -1.0); }
static const poly *square(algebra *a, const poly *p) { return poly_mul(a, p, p); }

const poly *function_slope(algebra *a, function_id function, int which, const poly *x,
                           const poly *y) {
    const poly *self = poly_call(a, function, x, y);
    switch (function) {
    case FN_SIN: return poly_cos(a, x);
    case FN_COS: return negative(a, poly_sin(a, x));
    case FN_TAN: return poly_add(a, a->one, square(a, self));
    case FN_ASIN: return poly_pow(a, poly_sub(a, a->one, square(a, x)), -0.5);
    case FN_ACOS: return negative(a, poly_pow(a, poly_sub(a, a->one, square(a, x)), -0.5));
    case FN_ATAN: return poly_pow(a, poly_add(a, a->one, square(a, x)), -1.0);
    case FN_ATAN2: { /* atan2(x, y) is the angle with the tangent x / y */
        const poly *top = which == 0 ? y : negative(a, x);
        return poly_mul(a, top, poly_pow(a, poly_add(a, square(a, x), square(a, y)), -1.0));
    }
    case FN_SQRT: return poly_scale(a, poly_pow(a, x, -0.5), 0.5);
    case FN_EXP: return self;
    case FN_LOG: return poly_pow(a, x, -1.0);
    case FN_ABS: return poly_call(a, FN_SIGN, x, NULL);
    case FN_SINH: return poly_call(a, FN_COSH, x, NULL);
    case FN_COSH: return poly_call(a, FN_SINH, x, NULL);
    case FN_TANH: /* cosh(x)^-2 is precise; 1 - tanh(x)^2 is not if tanh(x) is near 1 */
        return poly_pow(a, poly_call(a, FN_COSH, x, NULL), -2.0);
    case FN_MIN:
    /* the slope is 1 for the selected argument and 0 for the other; 1/2 for both if they are equal */
    case FN_MAX: {
        const poly *lead = poly_call(a, FN_SIGN, poly_sub(a, x, y), NULL);
        const double side = (which == 0) == (function == FN_MAX) ? 0.5 : -0.5;
        return poly_add(a, poly_number(a, 0.5), poly_scale(a, lead, side));
    }
    case FN_SIGN: break; /* 0, except at the jump */
    }
    return a->zero;
}

/* === evaluation =============================================================================== */
/* The value of an atom, for checks and constants. Runs use operation lists instead. */

static double atom_value(const atom *x, poly_value *value, void *context) {
    if (x->kind == ATOM_SYMBOL) {
        return value(context, x->symbol, x->primes);
    }
    const double first = poly_evaluate(x->argument[0], value, context);
    const double second =
        x->argument[1] == NULL ? 0.0 : poly_evaluate(x->argument[1], value, context);
    switch (x->kind) {
    case ATOM_GROUP: return first;
    case ATOM_POWER: return number_power(first, second);
    case ATOM_CALL: return number_call(x->function, first, second);
    case ATOM_SYMBOL: break; /* handled above */
    }
    return 0.0;
}

/* Returns the value of poly_magnitude() (poly.h) if `sizes` is true, otherwise that of poly_evaluate(). */
static double sum_of_terms(const poly *p, poly_value *value, void *context, bool sizes) {
    double sum = 0.0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double product = p->terms[i].coefficient;
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            const double exponent = m->factors[k].exponent;
            double base = atom_value(x, value, context);
            if (sizes && x->kind == ATOM_GROUP && exponent > 0.0) {
                base = number_most(fabs(base), sum_of_terms(x->argument[0], value, context, true));
            }
            product *= exponent == 1.0 ? base : number_power(sizes ? fabs(base) : base, exponent);
        }
        if (m->trig != TRIG_NONE && !sizes) {
            const double angle = poly_evaluate(m->angle, value, context);
            product *= m->trig == TRIG_SIN ? number_sine(angle) : number_cosine(angle);
        }
        sum += sizes ? fabs(product) : product;
    }
    return sum;
}

double poly_evaluate(const poly *p, poly_value *value, void *context) {
    return sum_of_terms(p, value, context, false);
}

double poly_magnitude(const poly *p, poly_value *value, void *context) {
    return sum_of_terms(p, value, context, true);
}

bool poly_is_finite(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        if (!isfinite(p->terms[i].coefficient) || (m->angle != NULL && !poly_is_finite(m->angle))) {
            return false;
        }
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            for (int j = 0; j < 2 && x->argument[j] != NULL; j++) {
                if (!poly_is_finite(x->argument[j])) {
                    return false;
                }
            }
        }
    }
    return true;
}

/* === derivatives and substitution ============================================================= */

/* (b^e)' = e b^(e-1) b' + b^e log(b) e' */
static const poly *power_derivative(algebra *a, const atom *x, const symbol *sym, int primes) {
    const poly *base = x->argument[0];
    const poly *exponent = x->argument[1];
    const poly *db = poly_derivative(a, base, sym, primes);
    const poly *de = poly_derivative(a, exponent, sym, primes);
    const poly *sum = a->zero;
    if (!poly_is_zero(db)) {
        const poly *lower = poly_pow_poly(a, base, poly_sub(a, exponent, a->one));
        sum = poly_mul(a, poly_mul(a, exponent, lower), db);
    }
    if (!poly_is_zero(de)) {
        const poly *growth = poly_mul(a, poly_of_atom(a, x, 1.0), poly_call(a, FN_LOG, base, NULL));
        sum = poly_add(a, sum, poly_mul(a, growth, de));
    }
    return sum;
}

static const poly *call_derivative(algebra *a, const atom *x, const symbol *sym, int primes) {
    const poly *sum = a->zero;
    for (int i = 0; i < 2 && x->argument[i] != NULL; i++) {
        const poly *inner = poly_derivative(a, x->argument[i], sym, primes);
        if (!poly_is_zero(inner)) {
            const poly *outer = function_slope(a, x->function, i, x->argument[0], x->argument[1]);
            sum = poly_add(a, sum, poly_mul(a, outer, inner));
        }
    }
    return sum;
}

static const poly *atom_derivative(algebra *a, const atom *x, const symbol *sym, int primes) {
    switch (x->kind) {
    case ATOM_SYMBOL: return x->symbol == sym && x->primes == primes ? a->one : a->zero;
    case ATOM_CALL: return call_derivative(a, x, sym, primes);
    case ATOM_POWER: return power_derivative(a, x, sym, primes);
    case ATOM_GROUP: return poly_derivative(a, x->argument[0], sym, primes);
    }
    abort();
}

static const poly *mono_derivative(algebra *a, const mono *m, const symbol *sym, int primes) {
    const poly *sum = a->zero;
    for (int i = 0; i < m->count; i++) {
        const mono_factor *f = &m->factors[i];
        const poly *inner = atom_derivative(a, f->atom, sym, primes);
        if (poly_is_zero(inner)) {
            continue;
        }
        mono *rest = mono_scratch(m->count);
        rest->trig = m->trig;
        rest->angle = m->angle;
        for (int j = 0; j < m->count; j++) {
            if (j != i) {
                rest->factors[rest->count++] = m->factors[j];
            }
        }
        const poly *others = poly_of_term(a, f->exponent, mono_intern(a, rest));
        free(rest);
        const poly *power = poly_pow(a, poly_of_atom(a, f->atom, 1.0), f->exponent - 1.0);
        if (f->atom->kind == ATOM_GROUP || f->atom->kind == ATOM_CALL) {
            power = f->exponent == 1.0 ? a->one : poly_of_atom(a, f->atom, f->exponent - 1.0);
        }
        if (f->atom->kind == ATOM_GROUP && f->exponent == 2.0) {
            power = f->atom->argument[0];
        }
        sum = poly_add(a, sum, poly_mul(a, poly_mul(a, others, power), inner));
    }
    if (m->trig != TRIG_NONE) {
        const poly *inner = poly_derivative(a, m->angle, sym, primes);
        if (!poly_is_zero(inner)) {
            const poly *plain =
                poly_of_term(a, 1.0, mono_make(a, m->factors, m->count, TRIG_NONE, NULL));
            const poly *turned = m->trig == TRIG_SIN ? poly_cos(a, m->angle)
                                                     : poly_scale(a, poly_sin(a, m->angle), -1.0);
            sum = poly_add(a, sum, poly_mul(a, poly_mul(a, plain, turned), inner));
        }
    }
    return sum;
}

const poly *poly_derivative(algebra *a, const poly *p, const symbol *sym, int primes) {
    if (!poly_may_contain(p, sym, primes) || a->overflow) {
        return a->zero;
    }
    const atom *by = atom_symbol(a, sym, primes);
    const poly *known = memo_get(&a->derivatives, p, by);
    if (known == NULL) {
        poly_sum sum = {0};
        for (int i = 0; i < p->count && !a->overflow; i++) {
            const poly *d = mono_derivative(a, p->terms[i].mono, sym, primes);
            sum_add(a, &sum, d, p->terms[i].coefficient);
        }
        known = sum_close(a, &sum);
        memo_put(a, &a->derivatives, p, by, known);
    }
    return known;
}

const poly *poly_determinant(algebra *a, const poly *const *m, int n, unsigned rows,
                             unsigned columns) {
    if (rows == 0) {
        return a->one;
    }
    const poly *sum = a->zero;
    const unsigned row = (unsigned)__builtin_ctz(rows);
    double sign = 1.0;
    for (unsigned c = 0; c < (unsigned)n; c++) {
        if ((columns & (1U << c)) != 0) {
            const poly *minor =
                poly_determinant(a, m, n, rows & ~(1U << row), columns & ~(1U << c));
            const poly *product = poly_mul(a, m[row * (unsigned)n + c], minor);
            sum = poly_add(a, sum, poly_scale(a, product, sign));
            sign = -sign;
        }
    }
    return sum;
}

bool poly_contains(const poly *p, const symbol *sym, int primes) {
    if (primes >= 0 && !poly_may_contain(p, sym, primes)) {
        return false;
    }
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        if (m->angle != NULL && poly_contains(m->angle, sym, primes)) {
            return true;
        }
        for (int j = 0; j < m->count; j++) {
            const atom *x = m->factors[j].atom;
            if (x->symbol == sym && (primes < 0 || x->primes == primes)) {
                return true;
            }
            for (int k = 0; k < 2 && x->argument[k] != NULL; k++) {
                if (poly_contains(x->argument[k], sym, primes)) {
                    return true;
                }
            }
        }
    }
    return false;
}

typedef struct substitution {
    poly_replacement *replace; /* NULL: replaces nothing */
    void *context;
    double kept;       /* argument `kept` of poly_power() */
    intern_table done; /* memo_pairs; left is a poly or an atom, right is NULL */
} substitution;

static const poly *substitute(algebra *a, const poly *p, substitution *s);

static const poly *substitute_atom(algebra *a, const atom *x, substitution *s) {
    const poly *known = memo_get(&s->done, x, NULL);
    if (known != NULL) {
        return known;
    }
    const poly *inside[2] = {NULL, NULL};
    for (int i = 0; i < 2 && x->argument[i] != NULL; i++) {
        inside[i] = substitute(a, x->argument[i], s);
    }
    switch (x->kind) {
    case ATOM_SYMBOL:
        known = s->replace != NULL ? s->replace(s->context, a, x->symbol, x->primes) : NULL;
        known = known == NULL ? poly_of_atom(a, x, 1.0) : known;
        break;
    case ATOM_CALL: known = poly_call(a, x->function, inside[0], inside[1]); break;
    case ATOM_POWER: known = poly_pow_poly(a, inside[0], inside[1]); break;
    case ATOM_GROUP: known = inside[0]; break;
    }
    memo_put(a, &s->done, x, NULL, known);
    return known;
}

static const poly *substitute(algebra *a, const poly *p, substitution *s) {
    const poly *known = memo_get(&s->done, p, NULL);
    if (known != NULL) {
        return known;
    }
    poly_sum sum = {0};
    for (int i = 0; i < p->count && !a->overflow; i++) {
        const mono *m = p->terms[i].mono;
        const poly *product = poly_number(a, p->terms[i].coefficient);
        for (int j = 0; j < m->count; j++) {
            const poly *base = substitute_atom(a, m->factors[j].atom, s);
            const double exponent = m->factors[j].exponent;
            product = poly_mul(a, product,
                               m->factors[j].atom->kind == ATOM_GROUP
                                   ? poly_power(a, base, exponent, s->kept)
                                   : poly_pow(a, base, exponent));
        }
        if (m->trig != TRIG_NONE) {
            const poly *angle = substitute(a, m->angle, s);
            product =
                poly_mul(a, product, m->trig == TRIG_SIN ? poly_sin(a, angle) : poly_cos(a, angle));
        }
        sum_add(a, &sum, product, 1.0);
    }
    known = sum_close(a, &sum);
    memo_put(a, &s->done, p, NULL, known);
    return known;
}

const poly *poly_substitute(algebra *a, const poly *p, poly_replacement *replace, void *context) {
    substitution s = {replace, context, 2.0, {0}};
    const poly *result = substitute(a, p, &s);
    free(s.done.slots);
    return result;
}

const poly *poly_expanded(algebra *a, const poly *p) {
    if (!p->keeps_powers) {
        return p;
    }
    substitution s = {NULL, NULL, (double)INFINITY, {0}};
    const poly *result = substitute(a, p, &s);
    free(s.done.slots);
    return result;
}

const poly *poly_from_expr(algebra *a, const expr *e) {
    if (a->overflow) {
        return a->zero;
    }
    switch (e->op) {
    case EXPR_NUMBER: return poly_number(a, e->number);
    case EXPR_SYMBOL: {
        int primes = e->primes;
        if (e->symbol->kind == SYM_LET || e->symbol->kind == SYM_OUTPUT) {
            const poly *known = memo_get(&a->lets, e->symbol, NULL);
            if (known == NULL) {
                known = poly_from_expr(a, e->symbol->value);
                memo_put(a, &a->lets, e->symbol, NULL, known);
            }
            return known;
        }
        const symbol *moving = symbol_moving(e->symbol, &primes);
        return poly_symbol(a, moving, primes);
    }
    case EXPR_NEG: return poly_scale(a, poly_from_expr(a, e->left), -1.0);
    case EXPR_ADD: return poly_add(a, poly_from_expr(a, e->left), poly_from_expr(a, e->right));
    case EXPR_SUB: return poly_sub(a, poly_from_expr(a, e->left), poly_from_expr(a, e->right));
    case EXPR_MUL: return poly_mul(a, poly_from_expr(a, e->left), poly_from_expr(a, e->right));
    case EXPR_DIV:
        return poly_mul(a, poly_from_expr(a, e->left),
                        poly_pow(a, poly_from_expr(a, e->right), -1.0));
    case EXPR_POW: return poly_pow_poly(a, poly_from_expr(a, e->left), poly_from_expr(a, e->right));
    case EXPR_CALL:
        return poly_call(a, e->function, poly_from_expr(a, e->left),
                         e->right == NULL ? NULL : poly_from_expr(a, e->right));
    }
    return a->zero;
}
