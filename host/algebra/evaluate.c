/* evaluate.c: the number a poly stands for. For checks and for constants; runs use operation lists. */
#include <math.h>

#include "algebra.h"
#include "poly.h"

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
    case ATOM_SYMBOL: break; /* answered above */
    }
    return 0.0;
}

double poly_evaluate(const poly *p, poly_value *value, void *context) {
    double sum = 0.0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        double product = p->terms[i].coefficient;
        for (int k = 0; k < m->count; k++) {
            const double base = atom_value(m->factors[k].atom, value, context);
            const double exponent = m->factors[k].exponent;
            product *= exponent == 1.0 ? base : number_power(base, exponent);
        }
        if (m->trig != TRIG_NONE) {
            const double angle = poly_evaluate(m->angle, value, context);
            product *= m->trig == TRIG_SIN ? number_sine(angle) : number_cosine(angle);
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
                base = number_most(base, poly_magnitude(x->argument[0], value, context));
            }
            product *= number_power(base, exponent);
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
