/* turning.c: the choice of turn angles: coordinates that occur only inside sines and cosines, with whole factors. */
#include <math.h>

#include "host/derive/lower.h"

static bool whole_in_angle(const poly *angle, const symbol *sym) {
    for (int i = 0; i < angle->count; i++) {
        const poly_term *t = &angle->terms[i];
        const bool alone = t->mono->trig == TRIG_NONE && t->mono->count == 1 &&
                           t->mono->factors[0].exponent == 1.0 &&
                           t->mono->factors[0].atom->kind == ATOM_SYMBOL;
        if (alone && t->mono->factors[0].atom->symbol == sym &&
            t->mono->factors[0].atom->primes == 0) {
            if (t->coefficient != number_floor(t->coefficient) || fabs(t->coefficient) > 1e6) {
                return false;
            }
            continue;
        }
        for (int k = 0; k < t->mono->count; k++) {
            const atom *x = t->mono->factors[k].atom;
            if (x->kind == ATOM_SYMBOL) {
                if (x->symbol == sym && x->primes == 0) {
                    return false;
                }
                continue;
            }
            for (int j = 0; j < 2 && x->argument[j] != NULL; j++) {
                if (!lower_only_in_waves(x->argument[j], sym)) {
                    return false;
                }
            }
        }
        if (t->mono->angle != NULL && !whole_in_angle(t->mono->angle, sym)) {
            return false;
        }
    }
    return true;
}

bool lower_only_in_waves(const poly *p, const symbol *sym) {
    if (!poly_may_contain(p, sym, 0)) {
        return true;
    }
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            if (x->kind == ATOM_SYMBOL && x->symbol == sym && x->primes == 0) {
                return false;
            }
            if (lower_is_tangent(x)) {
                if (!whole_in_angle(x->argument[0], sym)) {
                    return false;
                }
                continue;
            }
            for (int j = 0; j < 2 && x->kind != ATOM_SYMBOL && x->argument[j] != NULL; j++) {
                if (!lower_only_in_waves(x->argument[j], sym)) {
                    return false;
                }
            }
        }
        if (m->angle != NULL && !whole_in_angle(m->angle, sym)) {
            return false;
        }
    }
    return true;
}
