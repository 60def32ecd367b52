/* shape.c: what can be said of a poly, and of two numbers in one, by looking: nothing is made. */
#include <math.h>

#include "algebra.h"
#include "host/number/folding.h"
#include "poly.h"

/* Sums below this part of what was added are rounding errors of the decimals they came from. */
#define CANCELLED 1e-14
/* A whole power of a sum is multiplied out while it stays below so many terms. */
#define POWER_TERMS_MAX 64

bool poly_is_zero(const poly *p) { return p->count == 0; }

bool poly_is_number(const poly *p, double *value) {
    if (p->count == 0) {
        *value = 0.0;
        return true;
    }
    if (p->count == 1 && p->terms[0].mono->count == 0 && p->terms[0].mono->trig == TRIG_NONE) {
        *value = p->terms[0].coefficient;
        return true;
    }
    return false;
}

double coefficient_sum(double x, double y) {
    if (!isfinite(x + y)) { /* infinity is not small beside itself */
        return x + y;
    }
    return folding_cancels(x + y, number_most(fabs(x), fabs(y)), CANCELLED) ? 0.0
                                                                            : folding_sum(x, y);
}

bool exponent_is_whole(double x) { return x == number_floor(x) && fabs(x) < 1e6; }

bool poly_is_place(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        for (int k = 0; k < m->count; k++) {
            if (m->factors[k].atom->kind != ATOM_SYMBOL || m->factors[k].atom->primes > 0) {
                return false;
            }
        }
        if (m->trig != TRIG_NONE) {
            return false;
        }
    }
    return p->count > 1;
}

bool power_multiplies_out(const poly *base, double exponent, double kept) {
    if (exponent <= 0.0 || !exponent_is_whole(exponent) ||
        (exponent >= kept && poly_is_place(base))) {
        return false;
    }
    int terms = 1; /* asked for each product that holds a power: no pow() for it */
    for (int i = 0; i < (int)exponent && base->count > 1 && terms <= POWER_TERMS_MAX; i++) {
        terms *= base->count;
    }
    return terms <= POWER_TERMS_MAX;
}
