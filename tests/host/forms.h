/* forms.h: symbols of every kind and random expressions in normal form, for tests of host/algebra. */
#ifndef TESTS_HOST_FORMS_H
#define TESTS_HOST_FORMS_H

#include "host/algebra/algebra.h"

enum { FORM_SYMBOLS = 7, FORM_PRIMES = 3 };

extern const symbol form_symbols[FORM_SYMBOLS];

int form_place(const symbol *sym);

/* A random expression of finite numbers and at most 12 terms. */
const poly *form_random(algebra *a, uint64_t *seed, int depth);

/* Order of numbers: -1, 0 or 1. */
int form_order(double x, double y);

#endif
