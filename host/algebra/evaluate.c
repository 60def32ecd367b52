/* evaluate.c: the number a poly stands for. For checks and for constants; runs use operation lists. */
#include <math.h>

#include "algebra.h"

double call_number(function_id function, double x, double y) {
    switch (function) {
    case FN_SIN: return sin(x);
    case FN_COS: return cos(x);
    case FN_TAN: return tan(x);
    case FN_ASIN: return asin(x);
    case FN_ACOS: return acos(x);
    case FN_ATAN: return atan(x);
    case FN_ATAN2: return atan2(x, y);
    case FN_SQRT: return sqrt(x);
    case FN_EXP: return exp(x);
    case FN_LOG: return log(x);
    case FN_ABS: return fabs(x);
    case FN_SIGN: return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x; /* what is no number stays none */
    case FN_MIN: return y < x || isnan(y) ? y : x;
    case FN_MAX: return y > x || isnan(y) ? y : x;
    case FN_COUNT: break;
    }
    return 0.0;
}

static double atom_value(const atom *x, poly_value *value, void *context) {
    if (x->kind == ATOM_SYMBOL) {
        return value(context, x->symbol, x->primes);
    }
    const double first = poly_evaluate(x->argument[0], value, context);
    const double second =
        x->argument[1] == NULL ? 0.0 : poly_evaluate(x->argument[1], value, context);
    switch (x->kind) {
    case ATOM_GROUP: return first;
    case ATOM_POWER: return pow(first, second);
    default: return call_number(x->function, first, second);
    }
}

double poly_evaluate(const poly *p, poly_value *value, void *context) {
    double sum = 0.0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double product = p->terms[i].coefficient;
        for (int k = 0; k < m->count; k++) {
            const double base = atom_value(m->factors[k].atom, value, context);
            const double exponent = m->factors[k].exponent;
            product *= exponent == 1.0 ? base : pow(base, exponent);
        }
        if (m->trig != TRIG_NONE) {
            const double angle = poly_evaluate(m->angle, value, context);
            product *= m->trig == TRIG_SIN ? sin(angle) : cos(angle);
        }
        sum += product;
    }
    return sum;
}

double poly_magnitude(const poly *p, poly_value *value, void *context) {
    double sum = 0.0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double product = fabs(p->terms[i].coefficient);
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            const double exponent = m->factors[k].exponent;
            double base = fabs(atom_value(x, value, context));
            if (x->kind == ATOM_GROUP && exponent > 0.0) {
                base = fmax(base, poly_magnitude(x->argument[0], value, context));
            }
            product *= pow(base, exponent);
        }
        sum += product;
    }
    return sum;
}

bool poly_is_finite(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        if (!isfinite(p->terms[i].coefficient) || (m->angle != NULL && !poly_is_finite(m->angle))) {
            return false;
        }
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            for (int j = 0; j < 2 && x->kind != ATOM_SYMBOL && x->argument[j] != NULL; j++) {
                if (!poly_is_finite(x->argument[j])) {
                    return false;
                }
            }
        }
    }
    return true;
}
