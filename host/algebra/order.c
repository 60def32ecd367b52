/* order.c: the order of the normal form. It looks at what things are, never at when they were made: the same
 * expression has the same form whoever asked for what before, and whichever compiler built the program.
 *
 * Equal things are one object, so two that are not the same pointer differ somewhere: comparing ends at the
 * first difference, and whatever both share in front of it costs one look. */
#include <string.h>

#include "algebra.h"
#include "poly.h"

static int of_ints(int x, int y) { return (x > y) - (x < y); }

/* A number's bits, so that they are in the order of what they say: a total one, zeros of two signs and what is no
 * number included. */
static uint64_t place_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits >> 63 != 0 ? ~bits : bits | UINT64_C(1) << 63;
}

static int of_numbers(double x, double y) {
    const uint64_t left = place_of(x);
    const uint64_t right = place_of(y);
    return (left > right) - (left < right);
}

/* Symbols first: positions, then rates, then accelerations, each as declared; then calls, powers, groups. */
uint64_t atom_rank(const atom *x) {
    uint64_t rank = (uint64_t)x->kind << 60;
    if (x->kind == ATOM_SYMBOL) {
        rank += ((uint64_t)x->primes << 40) + ((uint64_t)x->symbol->kind << 32);
        return rank + (uint64_t)x->symbol->index;
    }
    return rank + (uint64_t)x->function;
}

int atom_order(const atom *x, const atom *y) {
    if (x == y) {
        return 0;
    }
    if (x->rank != y->rank) {
        return x->rank < y->rank ? -1 : 1;
    }
    int order = x->kind == ATOM_SYMBOL ? strcmp(x->symbol->name, y->symbol->name) : 0;
    for (int i = 0; i < 2 && order == 0 && x->argument[i] != NULL; i++) {
        order = poly_order(x->argument[i], y->argument[i]);
    }
    return order;
}

/* The number alone comes first: size_of_sum() in poly.c counts on it. */
int mono_order(const mono *x, const mono *y) {
    if (x == y) {
        return 0;
    }
    if (x->count != y->count) {
        return of_ints(x->count, y->count);
    }
    for (int i = 0; i < x->count; i++) {
        int order = atom_order(x->factors[i].atom, y->factors[i].atom);
        order = order != 0 ? order : of_numbers(x->factors[i].exponent, y->factors[i].exponent);
        if (order != 0) {
            return order;
        }
    }
    if (x->trig != y->trig || x->angle == NULL) {
        return of_ints((int)x->trig, (int)y->trig);
    }
    return poly_order(x->angle, y->angle);
}

int poly_order(const poly *x, const poly *y) {
    for (int i = 0; i < x->count && i < y->count && x != y; i++) {
        int order = mono_order(x->terms[i].mono, y->terms[i].mono);
        order = order != 0 ? order : of_numbers(x->terms[i].coefficient, y->terms[i].coefficient);
        if (order != 0) {
            return order;
        }
    }
    return of_ints(x->count, y->count);
}
